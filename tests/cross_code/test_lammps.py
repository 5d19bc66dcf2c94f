"""LAMMPS by the door for users' codes: its deck holds the law, walls and bar of the case."""

import os
import subprocess

import numpy as np
import pytest
from small_case import small_case
from test_engine_input import WEIGHT_N, packing_of

from crossdem.adapters.dataset import RESISTANCE_COLUMNS, Dataset
from crossdem.adapters.packing import make_packing
from crossdem.adapters.run import RunRequest, run_all
from crossdem.compare.twin_schemes import native_twin

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
    other, run = runs(
        [(native_twin(case, "liggghts"), "native"), (case, required("lammps").name)],
        packing,
        tmp_path,
    )

    way_m = np.abs(other.motion.position_m - discs).max()
    assert np.abs(run.motion.position_m - other.motion.position_m).max() < share * way_m
    # At the end, where nothing hits any more: while it does, the two codes see the bar half a step apart.
    found, expected = run.resistance.iloc[-1], other.resistance.iloc[-1]
    compared = (
        RESISTANCE_COLUMNS[2:7] if share < 1e-6 else ["force_y_N"]
    )  # what rubs walls is left there otherwise
    for name in compared:
        assert found[name] == pytest.approx(expected[name], rel=share, abs=share * WEIGHT_N), name
    assert found["contacts"] == expected["contacts"]


def runs(wanted, packing, tmp_path):
    """Datasets of (case, engine) on the packing."""
    requests = [RunRequest(case, packing, engine) for case, engine in wanted]
    results = run_all(requests, tmp_path / "out", 2)
    assert not [result.failure for result in results if result.failure]
    return [Dataset.read(result.dataset_folder) for result in results]


def test_under_lammps_a_bed_at_rest_stays_at_rest(required, tmp_path):
    """It gives way a little, as the shear springs of its contacts start anew, and lies still."""
    case = small_case("time.rest_s=0.2", "time.penetration_s=0.2", "bar.tip_m=0.055")
    packing = make_packing(case, 1, tmp_path / "packing")
    [run] = runs([(case, required("lammps").name)], packing, tmp_path)
    way_m = run.motion.position_m[-1] - packing.particles[["x_m", "y_m"]].to_numpy()
    assert np.abs(way_m).max() < 0.05 * RADIUS_M
    assert np.abs(run.motion.velocity_m_s[-1]).max() < 1e-9
    assert (run.resistance["force_y_N"] == 0.0).all()


def test_lammps_loses_no_disc_in_silence(required, tmp_path):
    """Of a finished run, its deck again with a disc put outside the domain, as people would start it by hand."""
    case = small_case("time.rest_s=0.02", "time.penetration_s=0.02")
    runs([(case, required("lammps").name)], make_packing(case, 1, tmp_path / "packing"), tmp_path)
    [folder] = (tmp_path / "out/runs").iterdir()
    discs = folder / "inputs" / "particles.data"
    text, _ = discs.read_text().rsplit("\n40 ", 1)
    discs.write_text(f"{text}\n40 0 1e5 0 0 0 0\n")
    (folder / "output").mkdir()
    settings = {
        "OMPI_MCA_ess_singleton_isolated": "1",
        "OMPI_MCA_btl": "self",
        "OMPI_MCA_pml": "ob1",
    }
    command = ["lmp", "-log", "none", "-in", "inputs/lammps_case.in"]
    ended = subprocess.run(
        command, cwd=folder, env=os.environ | settings, capture_output=True, text=True
    )
    assert ended.returncode != 0 and "ost atoms" in ended.stdout
