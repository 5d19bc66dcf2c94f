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
from crossdem.compare.twin_schemes import native_twin


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


def lammps_run(code, case, run_dir):
    return subprocess.run(
        timed_command(code, case, run_dir),
        cwd=run_dir,
        env=os.environ | code.environment(),
        capture_output=True,
        text=True,
    )


def lammps_end(code, case, packing, run_dir):
    """The discs (id, x, y, vx, vy, spin) [SI] and the force on the bar [N] after the last step."""
    prepare(case, packing, code, run_dir)
    ended = lammps_run(code, case, run_dir)
    assert ended.returncode == 0, ended.stdout
    steps, count = code.schedule(case).steps, len(packing.particles)
    [bar_y_N] = re.findall(rf"^ +{steps} +{count} +(\S+)", ended.stdout, re.MULTILINE)
    return np.loadtxt(run_dir / "output" / "end.txt", skiprows=9), float(bar_y_N)


RADIUS_M = 0.0025
WIDTH_M = 0.02705  # the discs at both ends of the piles reach into the side walls
# Two discs on a third, twice, from wall to wall; the bar lies on the pile on the right from the start.
PILES = [
    *((0.00245, RADIUS_M), (0.00745, RADIUS_M), (0.00495, 0.00685)),
    *((0.0194, RADIUS_M), (0.0246, RADIUS_M), (0.0220, 0.00678)),
]
# Onto the floor, alone and in a column, and under the bar: nothing turns.
HEAD_ON = [(0.004, 0.0029), (0.010, 0.0026), (0.010, 0.0078), (0.022, 0.0027)]
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


@pytest.mark.parametrize(
    "discs, bar_tip_m, numbers, share",
    [
        pytest.param(HEAD_ON, 0.0051, STICK, 1e-9, id="head-on"),
        # LAMMPS takes the speeds of the surfaces at the full radii, LIGGGHTS where the discs meet.
        pytest.param(PILES, 0.0092, STICK, 2e-3, id="stick"),
        pytest.param(PILES, 0.0092, SLIP, 2e-3, id="slip"),
    ],
)
def test_lammps_computes_law_walls_and_bar_of_the_case(
    discs, bar_tip_m, numbers, share, required, tmp_path
):
    """As the native scheme that does what LIGGGHTS does; `share` of the longest way."""
    overrides = f"container.width_m={WIDTH_M}", f"particles.count={len(discs)}", *numbers
    case = small_case("time.rest_s=0.02", "time.penetration_s=0.02", *overrides)
    packing = packing_of(discs, bar_tip_m, tmp_path / "packing")
    [result] = run_all(
        [RunRequest(native_twin(case, "liggghts"), packing, "native")], tmp_path / "out", 1
    )
    other = Dataset.read(result.dataset_folder)
    end, bar_y_N = lammps_end(required("lammps"), case, packing, tmp_path / "lammps")

    way_m = np.abs(other.motion.position_m[-1] - discs).max()
    assert np.abs(end[:, 1:3] - other.motion.position_m[-1]).max() < share * way_m
    assert bar_y_N == pytest.approx(other.resistance["force_y_N"].iloc[-1], rel=share)


def test_under_lammps_a_bed_at_rest_stays_at_rest(required, tmp_path):
    """It gives way a little, as the shear springs of its contacts start anew, and lies still."""
    case = small_case("time.rest_s=0.2", "time.penetration_s=0.2", "bar.tip_m=0.055")
    packing = make_packing(case, 1, tmp_path / "packing")
    end, bar_y_N = lammps_end(required("lammps"), case, packing, tmp_path / "lammps")
    way_m = end[:, 1:3] - packing.particles[["x_m", "y_m"]].to_numpy()
    assert np.abs(way_m).max() < 0.05 * RADIUS_M
    assert np.abs(end[:, 3:5]).max() < 1e-9 and bar_y_N == 0.0


def test_lammps_loses_no_disc_in_silence(required, tmp_path):
    case, code = small_case("time.rest_s=0.02", "time.penetration_s=0.02"), required("lammps")
    prepare(case, make_packing(case, 1, tmp_path / "packing"), code, tmp_path / "run")
    discs = tmp_path / "run" / "inputs" / "particles.data"
    text, _ = discs.read_text().rsplit("\n40 ", 1)
    discs.write_text(f"{text}\n40 0 1e5 0 0 0 0\n")
    ended = lammps_run(code, case, tmp_path / "run")
    assert ended.returncode != 0 and "ost atoms" in code.complaint(ended.stdout)
