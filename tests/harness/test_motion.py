"""Quantities of the motion, on beds of few particles whose answers are worked out by hand."""

import numpy as np
import pandas as pd
import pytest
import synthetic

from crossdem.compare import motion

RADIUS_M = 0.002
TIPS_M = 0.1 - 0.01 * np.linspace(0, 9, 91)  # the bar: 7 to 8 cm in x, its tip from 10 cm to 1 cm


def bed(start_m, end_m):
    """A bed of particles that go straight from `start_m` to `end_m`."""
    start_m, end_m = np.asarray(start_m, float), np.asarray(end_m, float)
    way = np.linspace(0, 1, 91)[:, np.newaxis, np.newaxis]
    particles = {**synthetic.case().resolved["particles"], "count": len(start_m)}
    run_case = synthetic.case(particles=particles)
    positions_m = start_m + way * (end_m - start_m)
    return synthetic.bed_of(run_case, positions_m, np.full(len(start_m), RADIUS_M), TIPS_M)


def test_a_cell_of_the_field_holds_the_mean_of_the_particles_that_started_in_it():
    run = bed(
        [[0.011, 0.021], [0.019, 0.029], [0.105, 0.005]],
        [[0.012, 0.021], [0.022, 0.025], [0.095, 0.005]],
    )
    field = motion.displacement_field(run)
    assert len(field) == 2
    first = field.iloc[0]
    assert field.index[0] == pytest.approx((0.015, 0.025))
    assert first["displacement_x_m"] == pytest.approx(0.002)
    assert first["displacement_y_m"] == pytest.approx(-0.002)
    assert first["particles"] == 2
    assert field.iloc[1]["displacement_x_m"] == pytest.approx(-0.01)


def test_the_field_over_seeds_weighs_particles_not_runs():
    index = pd.MultiIndex.from_tuples([(0.005, 0.005)], names=["x_m", "y_m"])

    def field(displacement_m: float, particles: int):
        values = {
            "displacement_x_m": displacement_m,
            "displacement_y_m": 0.0,
            "particles": particles,
        }
        return pd.DataFrame(values, index=index)

    both = motion.field_over_seeds([field(0.001, 1), field(0.004, 2)])
    assert both["displacement_x_m"].iloc[0] == pytest.approx(0.003)
    assert both["particles"].iloc[0] == 3


def test_near_the_bar_is_beside_it_within_1_cm_and_above_its_final_tip():
    beside, far, below_tip = [0.065, 0.05], [0.055, 0.05], [0.065, 0.005]
    under_bar, pushed_aside = [0.0715, 0.05], [0.065, 0.05]
    run = bed([beside, far, below_tip, under_bar], [beside, far, below_tip, pushed_aside])
    assert list(motion.near_bar(run)) == [True, False, False, False]


def test_movement_near_the_bar_is_downwards_and_of_those_particles_alone():
    run = bed(
        [[0.065, 0.05], [0.085, 0.06], [0.03, 0.05]],
        [[0.064, 0.04], [0.085, 0.04], [0.03, 0.02]],
    )
    assert motion.near_bar_movement_m(run) == pytest.approx(0.015)
    history = motion.near_bar_history(run)
    assert history["downward_m"].iloc[0] == 0
    assert history.index[-1] == 9.0
    assert history["sideways_m"].iloc[-1] == pytest.approx(-0.0005)


def test_without_particles_near_the_bar_there_is_no_movement_to_tell():
    run = bed([[0.03, 0.05]], [[0.03, 0.04]])
    assert np.isnan(motion.near_bar_movement_m(run))


def level_bed(rise_left_m=0.0, rise_right_m=0.0):
    """Two discs in each column, at rest but for those in the columns from 3 and from 11 cm on, which rise."""
    x_m = np.arange(0.0025, 0.15, 0.005)
    start_m = np.column_stack([x_m, np.full(len(x_m), 0.01)])
    end_m = start_m.copy()
    end_m[np.abs(x_m - 0.035) < 0.005, 1] += rise_left_m
    end_m[np.abs(x_m - 0.115) < 0.005, 1] += rise_right_m
    aside = np.abs(x_m - 0.075) > 0.005
    return bed(start_m[aside], end_m[aside])


def test_the_surface_is_the_mean_height_of_the_discs_rims():
    surface_m = motion.surface_profile(level_bed(), 0)
    mean_rim_m = 0.01 + RADIUS_M * np.pi / 4
    assert surface_m.loc[[0.005, 0.145]].to_numpy() == pytest.approx(mean_rim_m, abs=1e-4)
    assert np.isnan(surface_m.to_numpy()[7])  # inside the bar


def test_the_outline_is_the_highest_rim_of_all_discs_at_each_point_to_the_last_bit():
    """Discs of two sizes, also across the walls, and a gap without any."""
    random = np.random.default_rng(1)
    centre_m = random.uniform([-0.003, 0], [0.153, 0.1], (50, 2))
    centre_m = centre_m[np.abs(centre_m[:, 0] - 0.04) > 0.006]
    radius_m = random.choice([0.002, 0.0025], len(centre_m))
    x_m = (np.arange(600) + 0.5) * 0.15 / 600
    with np.errstate(invalid="ignore"):
        rims_m = np.sqrt(radius_m**2 - (x_m[:, np.newaxis] - centre_m[:, 0]) ** 2)
    rims_m = np.where(np.isnan(rims_m), -np.inf, centre_m[:, 1] + rims_m).max(axis=1)
    expected_m = np.where(np.isinf(rims_m), np.nan, rims_m)
    assert 50 < np.isnan(expected_m).sum() < 300
    np.testing.assert_array_equal(motion._outline_m(centre_m, radius_m, x_m), expected_m)


def test_the_bump_is_the_mean_of_the_largest_rise_on_either_side():
    assert motion.surface_bump_m(level_bed()) == 0
    bump_m = motion.surface_bump_m(level_bed(rise_left_m=0.004, rise_right_m=0.002))
    assert bump_m == pytest.approx(0.003)


def test_the_heave_is_the_mean_rise_of_all_columns_beside_the_bar():
    assert motion.surface_heave_m(level_bed()) == 0
    heave_m = motion.surface_heave_m(level_bed(rise_left_m=0.004, rise_right_m=0.003))
    assert heave_m == pytest.approx(0.007 / 14)  # of 15 columns, one lies within the bar


def test_layers_are_counted_from_the_floor_and_stay_with_the_particle():
    run = bed(
        [[0.01, 0.029], [0.01, 0.031], [0.01, 0.1]], [[0.01, 0.05], [0.01, 0.02], [0.01, 0.02]]
    )
    assert list(motion.layers(run)) == [0, 1, 3]
