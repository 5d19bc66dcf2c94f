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
    "paper without a bar": {"bar": None},
    "paper with spheres by velocity Verlet": {
        "scheme": {"integrator": "velocity_verlet", "inertia": "sphere"}
    },
    "liggghts": {"scheme": {"name": "liggghts"}},
    "liggghts with rolling resistance": {"scheme": {"name": "liggghts"}, "contact": ROLLING},
    "liggghts_averaged": {"scheme": {"name": "liggghts_averaged"}},
    "yade": {"scheme": {"name": "yade"}},
    "yade_averaged": {"scheme": {"name": "yade_averaged"}},
}
KILLS = 8  # of each way, at random moments
DEPTHS = (0.1, 0.5, 0.9)  # shares of the penetration at which each way is killed in turn
WRITTEN = {"motion.h5", "resistance.csv", "ledger.csv", "run.json"}


def merged(values, changes):
    both = dict(values)
    for key, change in changes.items():
        both[key] = merged(both.get(key, {}), change) if isinstance(change, dict) else change
    return {key: value for key, value in both.items() if value is not None}


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
        process = subprocess.Popen(self.command(output, "--checkpoint-every", "0.005", *more))
        try:
            assert process.wait(seconds) == 0
            return False
        except subprocess.TimeoutExpired:
            process.kill()
            return process.wait() != 0

    def killed_at(self, row, output, *more):
        """Kills it once so many rows of resistance are there; returns the folder."""
        rows = self.folder / output / "resistance.csv"
        process = subprocess.Popen(self.command(output, "--checkpoint-every", "0", *more))
        while not (rows.exists() and rows.read_bytes().count(b"\n") > row):
            assert process.poll() is None
            time.sleep(0.001)
        process.kill()
        assert process.wait() != 0
        return self.folder / output


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


@pytest.mark.parametrize("way", WAYS)
def test_a_run_that_is_killed_on_the_way_ends_with_the_same_bits(way, tmp_path):
    """By other instructions each time, which the bits do not depend on."""
    runs = Runs(tmp_path, WAYS[way])
    assert runs.whole("in one go").returncode == 0
    rows = len((tmp_path / "in one go" / "resistance.csv").read_bytes().splitlines())
    instructions = ["--instructions", "SCALAR"], [], ["--instructions", "SCALAR"]
    for share, others in zip(DEPTHS, instructions):
        runs.killed_at(int(share * rows), "cut short", *others)
    assert runs.whole("cut short", "--checkpoint-every", "1e9").returncode == 0
    found, expected = (contents(tmp_path / name) for name in ("cut short", "in one go"))
    for changed in (found, expected):
        del changed["run.json"]  # it names the instructions of its end
    assert found == expected


@pytest.fixture(scope="module")
def runs(tmp_path_factory):
    return Runs(tmp_path_factory.mktemp("runs"), {})


@pytest.fixture
def cut_short(runs, request):
    """The folder of a run that was killed while the bar moved."""
    folder = runs.killed_at(8, request.node.name)
    (folder / "checkpoint.part").unlink(missing_ok=True)
    return folder


def state_of(folder):
    return {path.name: path.read_bytes() for path in folder.iterdir()}


def refused(runs, folder, why, **others):
    before = state_of(folder)
    ended = runs.whole(folder.name, "--checkpoint-every", "0", **others)
    assert (ended.returncode, ended.stderr.count("\n")) == (2, 1), ended
    assert why in ended.stderr and f"choose another folder, or remove {folder}\n" in ended.stderr
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


def other_build(folder):
    """A program that does the same, and differs in a byte."""
    program = folder / "crossdem-solver"
    program.write_bytes(find_solver().read_bytes() + b" ")
    program.chmod(0o755)
    return program


def test_a_checkpoint_or_an_end_of_another_build_is_refused(runs, cut_short, monkeypatch):
    with monkeypatch.context() as patched:
        patched.setenv("CROSSDEM_SOLVER", str(other_build(runs.folder)))
        refused(runs, cut_short, "checkpoint: was written by another build")
    assert runs.whole(cut_short.name, "--checkpoint-every", "0").returncode == 0
    monkeypatch.setenv("CROSSDEM_SOLVER", str(runs.folder / "crossdem-solver"))
    refused(runs, cut_short, "run.json: is of a run of another case, packing or build")


@pytest.mark.parametrize("damage", ["cut off", "changed", "missing"])
@pytest.mark.parametrize("name", ["resistance.csv", "ledger.csv", "frames.f64"])
def test_output_that_is_not_as_it_was_is_told_by_name(runs, cut_short, name, damage):
    whole = (cut_short / name).read_bytes()
    if damage == "missing":
        (cut_short / name).unlink()
    else:
        (cut_short / name).write_bytes(
            whole[:100] + (whole[101:] if damage == "cut off" else b"!" + whole[101:])
        )
    refused(runs, cut_short, f"{name}: is not as the checkpoint says")


def test_a_run_that_has_ended_has_nothing_left_to_do(runs, cut_short):
    """Also where the kill came between its end and that of its process."""
    left = {name: (cut_short / name).read_bytes() for name in ("checkpoint", "frames.f64")}
    assert runs.whole(cut_short.name, "--checkpoint-every", "0").returncode == 0
    folder, before = cut_short, state_of(cut_short)
    for names in ((), ("checkpoint",), ("checkpoint", "frames.f64")):
        for name in names:
            (folder / name).write_bytes(left[name])
        again = runs.whole(folder.name, "--checkpoint-every", "0")
        assert (again.returncode, state_of(folder)) == (0, before), again.stderr
    subprocess.run(
        [find_solver(), "pack", SMALL_BED, "--seed", "3", "--output", runs.folder / "third"],
        check=True,
    )
    other = runs.whole(folder.name, "--checkpoint-every", "0", packing="third")
    assert other.returncode == 2 and "is of a run of another case, packing" in other.stderr
    assert state_of(folder) == before
    (folder / "motion.h5").unlink()
    refused(runs, folder, "motion.h5: is missing")


def test_a_second_process_on_the_folder_is_refused_and_the_first_goes_on(runs):
    first = subprocess.Popen(runs.command("shared", "--checkpoint-every", "0"))
    while not (runs.folder / "shared" / "checkpoint").exists():
        time.sleep(0.001)
    for options in (["--checkpoint-every", "0"], []):
        second = runs.whole("shared", *options)
        assert second.returncode == 2
        assert "another crossdem-solver is writing into it" in second.stderr
    assert first.wait() == 0
    assert runs.whole("alone").returncode == 0
    assert contents(runs.folder / "shared") == contents(runs.folder / "alone")


def test_a_run_that_ends_beyond_reason_says_so_again_and_again(runs):
    """Also where it was killed before its files were cleared away."""
    sound = runs.case.read_text()
    stiff = {"step_s": 1e-3, "rest_s": 0.0, "allow_above_eq32": True}
    try:
        runs.case.write_text(json.dumps(merged(json.loads(sound), {"time": stiff})))
        first = runs.whole("exploded", "--checkpoint-every", "0")
        again = runs.whole("exploded", "--checkpoint-every", "0")
    finally:
        runs.case.write_text(sound)
    assert first.returncode == again.returncode == 3
    assert first.stderr == again.stderr and "crossdem-solver: " in first.stderr
    told = json.loads((runs.folder / "exploded" / "run.json").read_bytes())
    assert told["completed"] is False and told["error"] in first.stderr
    assert {path.name for path in (runs.folder / "exploded").iterdir()} == WRITTEN


def test_a_checkpoint_that_was_cut_short_itself_is_begun_afresh(runs, cut_short):
    """And what only has its name is left alone."""
    head = (cut_short / "checkpoint").read_bytes()[:100]
    for number, begun in enumerate((b"", head[:5], head)):
        folder = runs.folder / f"begun {number}"
        folder.mkdir()
        (folder / "checkpoint.part").write_bytes(begun)
        assert runs.whole(folder.name, "--checkpoint-every", "1e9").returncode == 0
        assert {path.name for path in folder.iterdir()} == WRITTEN
    for others in ({"checkpoint.part": b"mine"}, {"checkpoint.part": head, "notes": b"mine"}):
        folder = runs.folder / f"of {len(others)} others"
        folder.mkdir()
        for name, content in others.items():
            (folder / name).write_bytes(content)
        ended = runs.whole(folder.name, "--checkpoint-every", "1e9")
        assert ended.returncode == 2 and "is not an empty folder" in ended.stderr
        assert state_of(folder) == others


def test_a_run_that_was_cut_short_is_not_begun_afresh_without_the_option(runs, cut_short):
    before = state_of(cut_short)
    ended = runs.whole(cut_short.name)
    assert (
        ended.returncode == 2 and "give --checkpoint-every, with which it goes on" in ended.stderr
    )
    assert state_of(cut_short) == before


@pytest.mark.parametrize("seconds", ["-1", "nan", "inf", "soon"])
def test_an_interval_that_is_none_is_refused(runs, seconds):
    ended = runs.whole("none", "--checkpoint-every", seconds)
    assert ended.returncode == 2 and f"{seconds} is no number of seconds" in ended.stderr
    assert not (runs.folder / "none").exists()


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
