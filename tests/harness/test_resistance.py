"""Quantities of the resistance, on tables whose answers are worked out by hand."""

import numpy as np
import pytest
import synthetic

from crossdem.compare import resistance

DEPTH_M = np.linspace(0, 0.09, 901)


def linear(slope_N_m: float = 16.0, start_N: float = 0.0):
    return synthetic.resistance_table(start_N + slope_N_m * DEPTH_M, DEPTH_M)


def test_a_profile_gives_each_centimetre_its_own_samples():
    table = synthetic.resistance_table([1, 1, 3, 3, 5, 7], [0, 0.005, 0.01, 0.015, 0.02, 0.025])
    profile = resistance.resistance_profile(table)
    assert list(profile.index) == pytest.approx([0.005, 0.015, 0.025])
    assert list(profile["mean_N"]) == [1, 3, 6]
    assert list(profile["count"]) == [2, 2, 2]
    assert profile["scatter_N"].iloc[2] == pytest.approx(2**0.5)


def test_a_depth_at_the_border_of_two_bins_belongs_to_the_deeper_despite_round_off():
    profile = resistance.resistance_profile(linear())
    assert list(profile["count"]) == [100] * 8 + [101]


def test_the_mean_resistance_of_a_straight_line_is_that_at_the_middle_of_3_to_9_cm():
    assert resistance.mean_resistance_N(linear()) == pytest.approx(16 * 0.06)


def test_the_mean_resistance_leaves_out_the_first_third():
    force_N = np.where(DEPTH_M < 0.03 - 1e-9, 1e6, 2.0)
    assert resistance.mean_resistance_N(synthetic.resistance_table(force_N, DEPTH_M)) == 2.0


def test_the_work_is_the_area_under_the_curve():
    assert resistance.work_J(linear()) == pytest.approx(0.5 * 16 * 0.09**2)
    assert resistance.work_J(linear(slope_N_m=0, start_N=2)) == pytest.approx(0.18)


def test_the_slope_is_found_above_any_offset():
    assert resistance.resistance_slope_N_m(linear(16, start_N=0.5)) == pytest.approx(16)


def test_the_fluctuation_is_about_the_trend_not_about_the_mean():
    assert resistance.fluctuation_N(linear()) == pytest.approx(0, abs=1e-12)
    wave_N = 0.1 * np.sin(2 * np.pi * DEPTH_M / 0.001)
    table = synthetic.resistance_table(16 * DEPTH_M + wave_N, DEPTH_M)
    assert resistance.fluctuation_N(table) == pytest.approx(0.1 / 2**0.5, rel=0.02)


def test_tip_and_shaft_share_are_of_the_force_and_sum_up_to_one():
    table = synthetic.resistance_table(16 * DEPTH_M, DEPTH_M, shaft_share=0.3)
    assert resistance.shaft_share(table) == pytest.approx(0.3)
    assert resistance.tip_share(table) == pytest.approx(0.7)


@pytest.mark.parametrize("exponent", [0.8, 1.0, 1.3])
def test_the_exponent_is_that_of_a_power_law_as_far_as_means_over_a_cm_show_it(exponent):
    table = synthetic.resistance_table(50 * DEPTH_M**exponent, DEPTH_M)
    assert resistance.resistance_exponent(table) == pytest.approx(exponent, abs=0.02)


def test_a_resistance_that_is_not_above_zero_has_no_exponent():
    assert np.isnan(resistance.resistance_exponent(linear(16, start_N=-0.5)))


def test_the_kinetic_energy_is_its_mean_over_the_deep_third_and_on():
    table = synthetic.resistance_table(16 * DEPTH_M, DEPTH_M)
    table["kinetic_energy_J"] = np.where(DEPTH_M < 0.03 - 1e-9, 1.0, 3e-6)
    assert resistance.kinetic_energy_J(table) == pytest.approx(3e-6)


def test_contacts_per_particle_counts_each_pair_once():
    run = synthetic.dataset(synthetic.case())
    assert resistance.contacts_per_particle(run) == pytest.approx(1700 / 944)


def test_the_unit_weight_counts_the_voids_in():
    """Two discs whose centre of mass is at 2 mm: a bed 4 mm high in a container of 15 cm."""
    count = {**synthetic.case().resolved["particles"], "count": 2}
    run_case = synthetic.case(particles=count)
    positions_m = np.tile([[0.01, 0.002], [0.02, 0.002]], (91, 1, 1))
    tips_m = 0.1 - 0.01 * np.linspace(0, 9, 91)
    run = synthetic.bed_of(run_case, positions_m, [0.002, 0.002], tips_m)
    solid_share = 2 * np.pi * 0.002**2 / (0.15 * 0.004)
    assert resistance.bulk_unit_weight_N_m3(run) == pytest.approx(1530 * 9.80665 * solid_share)
    expected = 16 / (1530 * 9.80665 * solid_share * 0.01 * 0.01)
    assert resistance.bearing_factor(run) == pytest.approx(expected)
