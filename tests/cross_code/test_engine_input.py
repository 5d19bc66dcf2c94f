"""That the case's own numbers act in every engine: known forces and motions of very few discs."""

import json
import math

import pytest
from few_particles import Disc, few_particles
from small_case import small_case

from crossdem.adapters.dataset import Dataset
from crossdem.adapters.packing import COLUMNS, Packing, make_packing
from crossdem.adapters.run import RunRequest, run_all

RADIUS_M = 0.0025
MASS_KG = 1530 * math.pi * RADIUS_M**2 * 0.01
WEIGHT_N = MASS_KG * 9.80665


def packing_of(discs, bar_tip_m, folder):
    """A packing of these discs (x, y), all of one radius."""
    folder.mkdir()
    rows = [f"{i},{x!r},{y!r},{RADIUS_M!r},0,0,0\n" for i, (x, y) in enumerate(discs)]
    (folder / "packing.csv").write_text("\n".join([",".join(COLUMNS), "".join(rows)]))
    about = {
        "seed": 1,
        "particles": len(discs),
        "bar_tip_m": bar_tip_m,
        "contacts": 0,
        "kinetic_energy_J": 0.0,
        "bed_height_m": 0.01,
        "settling_s": 0.0,
    }
    (folder / "packing.json").write_text(json.dumps(about))
    return Packing.read(folder)


def run_discs(engine, discs, tmp_path, *overrides, bar_tip_m=0.03):
    case = small_case(f"particles.count={len(discs)}", *overrides)
    packing = packing_of(discs, bar_tip_m, tmp_path / "packing")
    [result] = run_all([RunRequest(case, packing, engine.name)], tmp_path / "out", 1)
    assert result.status == "done", result.failure
    return Dataset.read(result.dataset_folder)


def test_a_disc_on_the_floor_sinks_in_by_its_weight_over_the_walls_stiffness(engine, tmp_path):
    stiffness = "contact.particle_wall.normal_stiffness_N_m=400.0"
    run = run_discs(engine, [(0.008, RADIUS_M)], tmp_path, stiffness)
    sunk_m = RADIUS_M - run.motion.position_m[-1, 0, 1]
    assert sunk_m == pytest.approx(WEIGHT_N / 400, rel=1e-6)


def test_a_disc_on_another_sinks_in_by_its_weight_over_the_pairs_stiffness(engine, tmp_path):
    discs = [(RADIUS_M, RADIUS_M), (RADIUS_M, 3 * RADIUS_M)]
    stiffness = "contact.particle_particle.normal_stiffness_N_m=700.0"
    run = run_discs(engine, discs, tmp_path, stiffness)
    lower_m, upper_m = run.motion.position_m[-1, :, 1]
    assert 2 * RADIUS_M - (upper_m - lower_m) == pytest.approx(WEIGHT_N / 700, rel=1e-6)
    assert RADIUS_M - lower_m == pytest.approx(2 * WEIGHT_N / 1000, rel=1e-6)


def test_a_disc_falls_with_g_until_it_lands(engine, tmp_path):
    run = run_discs(
        engine, [(0.008, 0.05)], tmp_path, "time.rest_s=0.04", "time.penetration_s=0.02"
    )
    assert run.motion.velocity_m_s[0, 0, 1] == pytest.approx(-9.80665 * 0.04, rel=2e-3)
    assert run.motion.position_m[0, 0, 1] == pytest.approx(
        0.05 - 0.5 * 9.80665 * 0.04**2, rel=1e-3
    )


def test_the_bars_force_is_that_of_the_overlap_and_counts_to_the_tip(engine, tmp_path):
    # The bar presses a disc, at rest on the floor, by the two springs in series: 1000 and 1000 N/m.
    run = run_discs(engine, [(0.02, RADIUS_M)], tmp_path, bar_tip_m=2 * RADIUS_M)
    pressed_N = 500 * 0.01 * 0.1 - WEIGHT_N / 2  # it had sunk in by its weight, away from the bar
    last = run.resistance.iloc[-1]
    assert last["force_y_N"] == pytest.approx(
        pressed_N, rel=0.02
    )  # the dashpots of a steady push add little
    assert last["tip_force_y_N"] == last["force_y_N"]
    assert last["shaft_force_y_N"] == 0


def wedged(engine, tmp_path, *overrides):
    """A disc in the air, squeezed between the left wall, which stands still, and the bar's side, which moves down."""
    squeezed_m = 1e-4
    bar = f"bar.centre_x_m={2 * RADIUS_M - squeezed_m + 0.005}"
    discs = [(RADIUS_M - squeezed_m / 2, 0.03)]
    return run_discs(engine, discs, tmp_path, bar, "time.rest_s=0.05", *overrides, bar_tip_m=0.01)


def test_the_walls_friction_turns_a_disc_though_particles_have_none(engine, tmp_path):
    run = wedged(engine, tmp_path, "contact.particle_particle.friction=0.0")
    assert run.motion.velocity_m_s[-1, 0, 1] == pytest.approx(
        -0.005, rel=0.05
    )  # half the bar's speed
    assert abs(run.motion.angular_velocity_rad_s[-1, 0]) == pytest.approx(0.005 / RADIUS_M, rel=0.1)
    assert run.resistance["tip_force_y_N"].abs().max() == 0


def test_a_frictionless_wall_and_bar_let_a_disc_fall(engine, tmp_path):
    run = wedged(engine, tmp_path, "contact.particle_wall.friction=0.0", "time.penetration_s=0.02")
    assert run.motion.velocity_m_s[0, 0, 1] == pytest.approx(-9.80665 * 0.05, rel=2e-3)
    assert run.motion.angular_velocity_rad_s[-1, 0] == pytest.approx(0, abs=1e-9)
    assert run.resistance["force_y_N"].abs().max() < 1e-12


def run_few(engine, discs, tmp_path, *overrides, **options):
    """A run of particles that the case itself names, from their first moment on."""
    case = few_particles(discs, tmp_path, *overrides, **options)
    packing = make_packing(case, 1, tmp_path / "packing")
    [result] = run_all([RunRequest(case, packing, engine.name)], tmp_path / "out", 1)
    assert result.status == "done", result.failure
    return Dataset.read(result.dataset_folder)


def test_a_disc_starts_with_its_velocity_and_spin(engine, tmp_path):
    disc = Disc(0.01, 0.03, velocity_x=0.1, velocity_y=0.05, spin=7.0)
    run = run_few(
        engine, [disc], tmp_path, "gravity_m_s2=0.0", "time.penetration_s=0.02", "time.rest_s=0.0"
    )
    assert list(run.motion.position_m[0, 0]) == [0.01, 0.03]
    assert list(run.motion.velocity_m_s[0, 0]) == [0.1, 0.05]
    assert run.motion.position_m[-1, 0] == pytest.approx([0.012, 0.031], rel=1e-12)
    assert run.motion.angular_velocity_rad_s[:, 0] == pytest.approx([7.0] * 3, rel=1e-12)
    assert run.resistance["kinetic_energy_J"].iloc[0] == pytest.approx(
        0.5 * MASS_KG * (0.1**2 + 0.05**2 + 0.5 * RADIUS_M**2 * 7.0**2), rel=1e-12
    )


def test_without_a_bar_its_forces_are_none_and_the_floor_carries_the_weight(engine, tmp_path):
    sunk_m = WEIGHT_N / 1000
    resting = [Disc(0.005, RADIUS_M - sunk_m), Disc(0.015, RADIUS_M - sunk_m)]
    run = run_few(engine, resting, tmp_path, "time.penetration_s=0.3")
    assert run.motion.bar_tip_m is None
    table = run.resistance
    assert not table[["depth_m", "force_x_N", "force_y_N", "tip_force_y_N"]].to_numpy().any()
    assert table["floor_force_y_N"].to_numpy() == pytest.approx(-2 * WEIGHT_N, rel=1e-6)
    assert run.motion.position_m[-1, :, 1] == pytest.approx(RADIUS_M - sunk_m, rel=1e-9)
