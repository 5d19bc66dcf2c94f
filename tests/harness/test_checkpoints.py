"""crossdem-solver run --checkpoint-every: killed at any moment, a run goes on to the same bits; a checkpoint that is damaged, or
of something else, is refused.
"""

import json
import random
import subprocess
import time
from pathlib import Path

import h5py
import pytest

from crossdem.adapters.solver import find_solver

SMALL_BED = Path(__file__).parents[1] / "solver" / "small_bed.json"
OPTIONS = {
    "contact": {
        "particle_particle": {"tensile_strength_N": 0.02, "rolling_friction": 0.1},
        "particle_wall": {"rolling_friction": 0.1},
    }
}
ROLLING = {pair: {"rolling_friction": 0.1} for pair in ("particle_particle", "particle_wall")}
LONG = {"time": {"penetration_s": 1.0}}
WAYS = {
    "paper": {},
    "paper with joints and rolling resistance": OPTIONS,
    "paper by leap-frog, in turn": {
        "scheme": {"integrator": "leap_frog", "update_order": "in_turn"},
        "time": {"step_s": 2.5e-5},
    },
    "liggghts": {"scheme": {"name": "liggghts"}},
    "liggghts with rolling resistance": {"scheme": {"name": "liggghts"}, "contact": ROLLING},
    "liggghts_averaged": {"scheme": {"name": "liggghts_averaged"}},
    "yade": {"scheme": {"name": "yade"}},
    "yade_averaged": {"scheme": {"name": "yade_averaged"}},
}
KILLS = 8  # of each way
WRITTEN = {"motion.h5", "resistance.csv", "ledger.csv", "run.json"}


def merged(values, changes):
    both = dict(values)
    for key, change in changes.items():
        both[key] = merged(both.get(key, {}), change) if isinstance(change, dict) else change
    return both


class Runs:
    """Runs of the small bed in one way, in folders below `folder`."""

    def __init__(self, folder, changes):
        self.folder = folder
        self.case, self.packing = folder / "case.json", folder / "packing"
        self.case.write_text(
            json.dumps(merged(merged(json.loads(SMALL_BED.read_text()), LONG), changes))
        )
        subprocess.run([find_solver(), "pack", SMALL_BED, "--output", self.packing], check=True)

    def command(self, output, *more, packing="packing"):
        packing_csv = self.folder / packing / "packing.csv"
        options = ["--packing", packing_csv, "--output", self.folder / output]
        return [find_solver(), "run", self.case, *options, *more]

    def whole(self, output, *more, **others):
        return subprocess.run(
            self.command(output, *more, **others), capture_output=True, text=True, timeout=120
        )

    def killed(self, output, seconds, *more):
        """Whether it was killed after so many seconds, and not done before."""
        process = subprocess.Popen(self.command(output, "--checkpoint-every", "0", *more))
        try:
            assert process.wait(seconds) == 0
            return False
        except subprocess.TimeoutExpired:
            process.kill()
            return process.wait() != 0


def contents(folder):
    """All that a run has written, the numbers of motion.h5 as bytes."""
    assert {path.name for path in folder.iterdir()} == WRITTEN
    found = {path.name: path.read_bytes() for path in folder.iterdir() if path.suffix != ".h5"}

    def take(name, item):
        if isinstance(item, h5py.Dataset):
            found[name] = item[()].tobytes()

    with h5py.File(folder / "motion.h5") as motion:
        motion.visititems(take)
    return found


@pytest.mark.parametrize("way", WAYS)
def test_a_run_that_is_killed_again_and_again_ends_with_the_same_bits(way, tmp_path):
    runs = Runs(tmp_path, WAYS[way])
    begun = time.monotonic()
    assert runs.whole("in one go").returncode == 0
    in_one_go_s = time.monotonic() - begun
    moments, kills, attempt = random.Random(way), 0, 0
    while kills < KILLS:
        attempt += 1
        output = f"attempt {attempt}"
        while runs.killed(output, in_one_go_s * moments.uniform(0.0, 0.6 + 0.1 * kills)):
            kills += 1  # with ever more time, as a machine may be busy
        assert contents(tmp_path / output) == contents(tmp_path / "in one go")


@pytest.fixture(scope="module")
def runs(tmp_path_factory):
    return Runs(tmp_path_factory.mktemp("runs"), {})


@pytest.fixture
def cut_short(runs, request):
    """The folder of a run that was killed while the bar moved."""
    folder = runs.folder / request.node.name
    process = subprocess.Popen(runs.command(folder.name, "--checkpoint-every", "0"))
    rows = folder / "resistance.csv"
    while not (rows.exists() and rows.read_bytes().count(b"\n") > 8):
        assert process.poll() is None
        time.sleep(0.001)
    process.kill()
    process.wait()
    (folder / "checkpoint.part").unlink(missing_ok=True)
    return folder


def state_of(folder):
    return {path.name: path.read_bytes() for path in folder.iterdir()}


def refused(runs, folder, why, **others):
    before = state_of(folder)
    ended = runs.whole(folder.name, "--checkpoint-every", "0", **others)
    assert (ended.returncode, ended.stderr.count("\n")) == (2, 1), ended
    assert why in ended.stderr and "choose another folder or remove this one" in ended.stderr
    assert state_of(folder) == before


def test_a_checkpoint_with_any_byte_changed_or_missing_is_refused(runs, cut_short):
    checkpoint = cut_short / "checkpoint"
    sound = checkpoint.read_bytes()
    places = random.Random(1)
    for place in [0, 15, 16, 24, 32, 40, 48, 56, *places.sample(range(57, len(sound)), 12)]:
        checkpoint.write_bytes(sound[:place] + bytes([sound[place] ^ 1]) + sound[place + 1 :])
        why = "of another" if 24 <= place < 40 else "by another build" if 16 <= place < 24 else ""
        refused(runs, cut_short, why or "is damaged")
    for length in (0, 10, 56, len(sound) // 2, len(sound) - 1):
        checkpoint.write_bytes(sound[:length])
        refused(runs, cut_short, "is damaged")
    checkpoint.write_bytes(sound)
    assert runs.whole(cut_short.name, "--checkpoint-every", "0").returncode == 0


def test_a_checkpoint_of_another_packing_is_refused(runs, cut_short):
    other = runs.folder / "other packing"
    subprocess.run([find_solver(), "pack", SMALL_BED, "--seed", "2", "--output", other], check=True)
    refused(runs, cut_short, "is of another packing", packing=other.name)


def test_a_checkpoint_of_another_case_is_refused(runs, cut_short):
    case = json.loads(runs.case.read_text())
    try:
        runs.case.write_text(json.dumps(merged(case, {"gravity_m_s2": 1.6})))
        refused(runs, cut_short, "is of another case")
    finally:
        runs.case.write_text(json.dumps(case))


@pytest.mark.parametrize("name", ["resistance.csv", "ledger.csv", "frames.f64"])
def test_output_that_has_lost_its_end_is_told_by_name(runs, cut_short, name):
    (cut_short / name).write_bytes((cut_short / name).read_bytes()[:100])
    ended = runs.whole(cut_short.name, "--checkpoint-every", "0")
    assert ended.returncode == 2
    assert f"{name}: is not there as far as the checkpoint says" in ended.stderr


def test_a_run_that_has_ended_has_nothing_left_to_do(runs):
    """Also where the kill came between its end and that of its process."""
    for kept in ("", "frames.f64"):
        assert runs.whole(f"ended {kept}", "--checkpoint-every", "0").returncode == 0
        folder = runs.folder / f"ended {kept}"
        before = state_of(folder)
        if kept:
            (folder / kept).write_bytes(b"")
        again = runs.whole(folder.name, "--checkpoint-every", "0")
        assert (again.returncode, state_of(folder)) == (0, before), again.stderr
    subprocess.run(
        [find_solver(), "pack", SMALL_BED, "--seed", "3", "--output", runs.folder / "third"],
        check=True,
    )
    other = runs.whole(folder.name, "--checkpoint-every", "0", packing="third")
    assert other.returncode == 2 and "holds a run of another case or packing" in other.stderr
    assert state_of(folder) == before


def test_a_folder_without_a_checkpoint_is_left_alone(runs, tmp_path):
    (runs.folder / "full").mkdir()
    (runs.folder / "full" / "notes.txt").write_text("mine")
    ended = runs.whole("full", "--checkpoint-every", "0")
    assert ended.returncode == 2
    assert "is not an empty folder; nothing was written" in ended.stderr
    assert [path.name for path in (runs.folder / "full").iterdir()] == ["notes.txt"]


def test_a_run_whose_disk_was_full_goes_on_when_there_is_room(runs):
    command = " ".join(f"'{part}'" for part in runs.command("full disk", "--checkpoint-every", "0"))
    full = subprocess.run(
        ["bash", "-c", f"trap '' XFSZ; ulimit -f 60; exec {command}"],
        capture_output=True,
        text=True,
        env={"LSAN_OPTIONS": "detect_leaks=0"},
    )
    assert full.returncode == 1
    assert "is the disk full?" in full.stderr
    assert runs.whole("full disk", "--checkpoint-every", "0").returncode == 0
    assert runs.whole("room enough").returncode == 0
    assert contents(runs.folder / "full disk") == contents(runs.folder / "room enough")
