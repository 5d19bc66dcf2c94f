"""A whole `crossdem check`, cut short by kill -9 at any moment, by a full disk, or led astray by its clock: the same command
then ends as if nothing had been, with the same bits and what was finished kept.
"""

import hashlib
import json
import os
import random
import shutil
import signal
import subprocess
import time
from pathlib import Path

import h5py
import pytest
from command_line import ROOT, crossdem
from small_case import small_file
from test_own_engine import DESCRIPTION

from crossdem.adapters.solver import find_solver

HERE = Path(__file__).parent
KILLS = 8
DAY_S = 86400


@pytest.fixture(scope="module")
def place(tmp_path_factory):
    """A folder with a small case, and a user's code behind which stands the native solver."""
    folder = tmp_path_factory.mktemp("cut short")
    small_file(folder)
    shutil.copy(HERE / "door_engine.py", folder)
    (folder / "door.toml").write_text(DESCRIPTION)
    return folder


def command(place, out):
    what = ["small.toml", "--engines", "native", "--engine", "door.toml", "--seeds", "3"]
    return [ROOT / "crossdem", "check", *what, "--out", out]


def environment(**more):
    return os.environ | {"CROSSDEM_SOLVER": str(find_solver())} | more


def check(place, out, **more):
    return subprocess.run(
        command(place, out),
        cwd=place,
        env=environment(**more),
        capture_output=True,
        text=True,
        timeout=300,
    )


@pytest.fixture(scope="module")
def in_one_go(place):
    begun = time.monotonic()
    ended = check(place, "one go")
    assert ended.returncode in (0, 1, 4), ended.stderr
    return ended.returncode, results(place / "one go"), time.monotonic() - begun


def results(out):
    """The numbers of every run, and the verdict."""
    found = {}
    for run in (out / "runs").iterdir():
        found[run.name, "resistance"] = (run / "resistance.csv").read_bytes()
        with h5py.File(run / "motion.h5") as motion:
            names = []
            motion.visit(names.append)
            for name in names:
                if isinstance(motion[name], h5py.Dataset):
                    found[run.name, name] = hashlib.sha256(motion[name][()].tobytes()).hexdigest()
    report = json.loads((out / "report.json").read_text())
    found["verdict"] = report["verdict"]
    assert "</html>" in (out / "report.html").read_text()
    return found


def finished(out):
    """The runs that are there, each with what only making it again would change: gates may be set anew in its manifest."""
    return {run.name: (run / "motion.h5").stat().st_ino for run in (out / "runs").glob("[!.]*")}


def test_killed_at_any_moment_it_goes_on_and_ends_the_same(place, in_one_go):
    code, wanted, took_s = in_one_go
    moments = random.Random(7)
    kept = 0
    for kill in range(KILLS):
        out = place / f"killed {kill}"
        begun = subprocess.Popen(
            command(place, out.name),
            cwd=place,
            env=environment(),
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            start_new_session=True,
        )
        try:
            begun.wait(moments.uniform(0.0, took_s))
        except subprocess.TimeoutExpired:
            os.killpg(begun.pid, signal.SIGKILL)
            begun.wait()
        before = finished(out) if out.exists() else {}
        ended = check(place, out.name)
        assert ended.returncode == code, ended.stderr
        assert results(out) == wanted
        after = finished(out)
        assert all(after[name] == then for name, then in before.items()), "a run was made again"
        kept += len(before)
        assert not list((out / "runs").glob(".*")) and not list((out / "packings").glob(".*"))
    assert kept > 0, "every kill came before the first run"


FULL_DISK = """\
mount -t tmpfs -o size=$FIRST none full
"$@"
echo "status $?"
find full -name '*.partial'
mount -o remount,size=200m none full
"$@" && echo "status 0" || echo "status $?"
cp -r full/out kept
"""


@pytest.mark.parametrize("first", ["256k", "700k", "1m"])
def test_a_full_disk_is_said_and_with_room_the_same_command_ends_well(place, in_one_go, first):
    code, wanted, _ = in_one_go
    (place / "full").mkdir(exist_ok=True)
    shutil.rmtree(place / "kept", ignore_errors=True)
    said = subprocess.run(
        ["unshare", "--mount", "--map-root-user", "sh", "-c", FULL_DISK, "sh"]
        + command(place, "full/out"),
        cwd=place,
        env=environment(FIRST=first),
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        timeout=300,
    ).stdout
    statuses = [line.split()[1] for line in said.splitlines() if line.startswith("status ")]
    assert statuses[0] in ("3", "74") and statuses[1] == str(code), said
    assert "No space left on device" in said or "the disk is full" in said, said
    assert "Traceback" not in said and ".partial" not in said, said
    assert results(place / "kept") == wanted


def test_a_clock_that_jumps_changes_nothing(place, in_one_go, tmp_path):
    """Two days back, then more than a year ahead, while packings settle and codes run."""
    code, wanted, took_s = in_one_go
    clock, library = tmp_path / "clock", tmp_path / "jumping_clock.so"
    build = ["cc", "-O2", "-Wall", "-Werror", "-shared", "-fPIC", HERE / "jumping_clock.c"]
    subprocess.run([*build, "-o", library, "-ldl"], check=True)
    jumping = environment(LD_PRELOAD=str(library), JUMPING_CLOCK=str(clock))
    clock.write_text(str(-2 * DAY_S))
    told = subprocess.run(["date", "+%s"], env=jumping, capture_output=True, text=True, check=True)
    assert abs(time.time() - 2 * DAY_S - int(told.stdout)) < 10, "the clock does not jump"
    clock.write_text("0")
    begun = subprocess.Popen(
        command(place, "jumps"), cwd=place, env=jumping, stderr=subprocess.PIPE, text=True
    )
    for days in (-2, 400, -30):
        time.sleep(took_s / 4)
        clock.write_text(str(days * DAY_S))
    _, said = begun.communicate(timeout=300)
    assert begun.returncode == code, said
    assert results(place / "jumps") == wanted
    again = check(place, "jumps")
    assert again.returncode == code and results(place / "jumps") == wanted


def test_a_package_that_is_killed_while_it_is_written_is_whole_or_not_there(place):
    def build(out, package):
        what = ["small.toml", "--engines", "native", "--seeds", "2", "--out", out, "-o", package]
        return [ROOT / "crossdem", "dataset", "build", *what]

    subprocess.run(build("work", "whole"), cwd=place, env=environment(), check=True)
    begun = time.monotonic()  # once more, now that the runs are there
    subprocess.run(build("work", "again"), cwd=place, env=environment(), check=True)
    took_s = time.monotonic() - begun
    moments = random.Random(3)
    for kill in range(4):
        package = place / f"package {kill}"
        process = subprocess.Popen(
            build("work", package.name), cwd=place, env=environment(), start_new_session=True
        )
        try:
            process.wait(moments.uniform(0.3 * took_s, took_s))
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()
        if not package.exists():
            subprocess.run(build("work", package.name), cwd=place, env=environment(), check=True)
        verified = crossdem("dataset", "verify", package)
        assert verified.returncode == 0, verified.stdout
