"""The clocks of the real engines: they tell of the steps of a run, and change nothing of it."""

import json
import os
import re
import subprocess

import numpy as np
import pytest
from command_line import crossdem
from small_case import small_case, small_file
from test_engine_input import packing_of

from crossdem.adapters.case import load_case
from crossdem.adapters.dataset import Dataset
from crossdem.adapters.packing import make_packing
from crossdem.adapters.run import RunRequest, run_all
from crossdem.adapters.run_folder import prepare
from crossdem.compare.bench_clocks import CLOCKS, timed_command, told


@pytest.fixture(scope="module")
def found(required, tmp_path_factory):
    """What `crossdem bench --quick` wrote of a small case."""
    for name in CLOCKS:
        required(name)
    folder = tmp_path_factory.mktemp("bench")
    options = ["--quick", "--workloads", "bar,time-to-solution", "--case", small_file(folder)]
    ended = crossdem("bench", *options, "--out", folder / "out")
    assert ended.returncode == 0, ended.stderr
    return json.loads((folder / "out" / "bench.json").read_text())


def test_every_engine_is_timed_in_turn(found):
    ran = [(t["round"], t["workload"], t["engine"]) for t in found["timings"]]
    workloads = ("bar", "time-to-solution")
    assert ran == [(k, w, engine) for k in range(2) for w in workloads for engine in CLOCKS]
    assert not found["failures"] and not found["left_out"]


def test_all_make_the_same_steps_but_for_the_time_to_solution(found):
    steps = {(row["workload"], row["engine"]): row["steps"] for row in found["rows"]}
    assert {steps["bar", engine] for engine in CLOCKS} == {40}
    assert [steps["time-to-solution", engine] for engine in CLOCKS] == [*(2000, 4000, 4000, 4000)]


def test_only_the_steps_are_timed(found):
    """Not half a second of Python's start, of which YADE's process mostly consists here."""
    for timing in found["timings"]:
        assert 0 < timing["wall_s"] < timing["process_wall_s"]
        if timing["engine"] == "yade" and timing["workload"] == "bar":
            assert timing["wall_s"] < 0.2 * timing["process_wall_s"]


def test_the_clock_changes_nothing_of_what_yade_does(required, tmp_path):
    engine = required("yade")
    case = load_case(small_file(tmp_path))
    packing = make_packing(case, 1, tmp_path / "packing")
    outputs = []
    for name in ("plain", "timed"):
        prepare(case, packing, engine, tmp_path / name)
        plain = engine.command(case, tmp_path / name)
        command = plain if name == "plain" else timed_command(engine, case, tmp_path / name)
        ended = subprocess.run(
            command,
            cwd=tmp_path / name,
            env=os.environ | engine.environment(),
            capture_output=True,
            text=True,
        )
        assert ended.returncode == 0, ended.stderr
        files = sorted((tmp_path / name / "output").iterdir())
        outputs.append({file.name: file.read_bytes() for file in files})
    assert outputs[0] == outputs[1] and len(outputs[0]) == 2
    assert told(engine, case, ended.stdout).steps == 4000


def lammps_ended(code, case, run_dir):
    return subprocess.run(
        timed_command(code, case, run_dir),
        cwd=run_dir,
        env=os.environ | code.environment(),
        capture_output=True,
        text=True,
    )


RADIUS_M = 0.0025
# On the floor, and on two of these; the bar lies on the pile on the right from the start.
DISCS = [
    *((0.0026, RADIUS_M), (0.0076, RADIUS_M), (0.0051, 0.00685)),
    *((0.0194, RADIUS_M), (0.0246, RADIUS_M), (0.0220, 0.00678)),
]
# Not one number of the walls is that of the discs, so that none stands for another in silence.
STICK = (
    "contact.particle_wall.normal_stiffness_N_m=800.0",
    "contact.particle_wall.shear_stiffness_N_m=300.0",
    "contact.particle_wall.normal_damping_N_s_m=0.6",
    "contact.particle_wall.shear_damping_N_s_m=0.2",
    "contact.particle_wall.friction=50.0",
    "contact.particle_particle.friction=40.0",
)
# Where it slips LAMMPS caps spring and dashpot together, LIGGGHTS the spring alone.
SLIP = (
    "contact.particle_wall.friction=0.2",
    "contact.particle_wall.shear_damping_N_s_m=0.0",
    "contact.particle_particle.shear_damping_N_s_m=0.0",
)


@pytest.mark.parametrize("numbers", [STICK, SLIP], ids=["stick", "slip"])
def test_lammps_moves_the_discs_and_the_bar_as_liggghts_does(numbers, required, tmp_path):
    count = f"particles.count={len(DISCS)}"
    case = small_case("time.rest_s=0.02", "time.penetration_s=0.02", count, *numbers)
    packing = packing_of(DISCS, 0.0092, tmp_path / "packing")
    [result] = run_all([RunRequest(case, packing, required("liggghts").name)], tmp_path / "out", 1)
    other = Dataset.read(result.dataset_folder)
    prepare(case, packing, required("lammps"), tmp_path / "lammps")
    log = lammps_ended(required("lammps"), case, tmp_path / "lammps").stdout

    end = np.loadtxt(tmp_path / "lammps" / "output" / "end.txt", skiprows=9)
    way_m = np.abs(other.motion.position_m[-1] - DISCS).max()
    assert np.abs(end[:, 1:3] - other.motion.position_m[-1]).max() < 0.001 * way_m
    [bar_y_N] = re.findall(r"^ +800 +6 +(\S+)", log, re.MULTILINE)
    assert float(bar_y_N) == pytest.approx(other.resistance["force_y_N"].iloc[-1], rel=0.1)


def test_lammps_loses_no_disc_in_silence(required, tmp_path):
    case, code = small_case("time.rest_s=0.02", "time.penetration_s=0.02"), required("lammps")
    prepare(case, make_packing(case, 1, tmp_path / "packing"), code, tmp_path / "run")
    discs = tmp_path / "run" / "inputs" / "particles.data"
    text, _ = discs.read_text().rsplit("\n40 ", 1)
    discs.write_text(f"{text}\n40 0 1e5 0 0 0 0\n")
    ended = lammps_ended(code, case, tmp_path / "run")
    assert ended.returncode != 0 and "ost atoms" in code.complaint(ended.stdout)
