"""Whole curves: a shift is found at its depth and nowhere else, and equal codes are told apart 1 time in 20 at most."""

import numpy as np
import pandas as pd
import pytest
from paired_tables import DEPTHS_M, PAIR, RESISTANCE_N, curves, table
from scipy import stats

from crossdem.compare import opinion_tables, pairing
from crossdem.compare.curves import band, compare_curves, energy_test, margin_N
from crossdem.compare.ensemble import Ensemble
from crossdem.compare.margins import Check
from crossdem.compare.quantities import QUANTITIES

TRIALS = 200
# Of 200 trials at 5 %, 10 raise a false alarm on average; more than 20 with a chance of 1 in 1000.
MOST_ALARMS = 20


def check(kind="relative", margin=0.10):
    return Check(QUANTITIES["mean_resistance_N"], kind, margin, margin, "a reason")


def at(depth_m, value):
    """`value` at one depth, else 0."""
    return np.where(np.isclose(DEPTHS_M, depth_m), value, 0.0)


def energy_distance(first, second):
    """By its definition."""

    def mean(a, b):
        return np.mean([np.linalg.norm(one - other) for one in a for other in b])

    return 2 * mean(first, second) - mean(first, first) - mean(second, second)


def test_the_p_value_counts_the_swaps_that_look_at_least_as_unlike():
    """Against the definition, by all 2^7 swaps."""
    rng = np.random.default_rng(3)
    first, second = rng.normal(size=(7, 4)) + 0.5, rng.normal(size=(7, 4))
    observed, at_least = energy_distance(first, second), 0
    for number in range(2**7):
        swapped = (number >> np.arange(7) & 1).astype(bool)[:, np.newaxis]
        ways = np.where(swapped, second, first), np.where(swapped, first, second)
        at_least += energy_distance(*ways) >= observed - 1e-12
    assert 0.02 < at_least / 2**7 < 0.98
    assert energy_test(first, second) == pytest.approx(at_least / 2**7)


def test_the_p_value_has_no_unit():
    """SciPy counts what is within 1e-14 as equal, whatever it is."""
    rng = np.random.default_rng(3)
    first, second = rng.normal(size=(7, 4)) + 0.5, rng.normal(size=(7, 4))
    assert energy_test(1e-13 * first, 1e-13 * second) == energy_test(first, second) < 1


@pytest.mark.parametrize("packings", [pairing.FEWEST_PACKINGS - 1, pairing.FEWEST_PACKINGS])
def test_the_least_p_of_the_fewest_packings_is_below_5_percent_and_of_one_less_above(packings):
    """Only the runs as they are, and all of them swapped, look as unlike as two groups far apart."""
    rng = np.random.default_rng(1)
    p = energy_test(rng.normal(size=(packings, 3)) + 100, rng.normal(size=(packings, 3)))
    assert p == 2 / 2**packings
    assert (p <= pairing.ALPHA) == (packings == pairing.FEWEST_PACKINGS)


def test_a_shift_is_found_at_its_depth_and_only_there():
    found = compare_curves(curves(np.random.default_rng(1), 16, at(0.045, 0.5)), PAIR, check())
    assert list(found.table.index[found.table["differs"]]) == [DEPTHS_M[4]]
    assert found.table["difference_N"].iloc[4] > 0.4
    assert found.p < 0.01
    back = compare_curves(curves(np.random.default_rng(1), 16, at(0.045, -0.5)), PAIR, check())
    assert list(back.table.index[back.table["differs"]]) == [DEPTHS_M[4]]


def test_equal_codes_are_told_apart_1_time_in_20_at_most():
    """Energy distance, and the band as a whole: not each depth by itself, of which there are nine."""
    rng = np.random.default_rng(1)
    by_energy = by_band = 0
    for _ in range(TRIALS):
        sample = curves(rng, 12)
        first, second = (sample.loc[engine].to_numpy() for engine in PAIR)
        by_energy += energy_test(first, second) <= pairing.ALPHA
        limits = band(first - second)
        by_band += ((limits["low_N"] > 0) | (limits["high_N"] < 0)).any()
    assert 2 <= by_energy <= MOST_ALARMS
    assert by_band <= MOST_ALARMS // 2  # 2 % were measured: of few packings it is wide


def test_the_band_is_wider_than_the_interval_of_one_depth_and_no_wider_than_bonferronis():
    differences = np.random.default_rng(2).normal(size=(40, 9))
    limits = band(differences)
    half = (limits["high_N"] - limits["low_N"]) / 2
    units = half / (differences.std(axis=0, ddof=1) / np.sqrt(40))
    assert np.allclose(units, units[0])
    assert stats.t.ppf(0.975, 39) + 0.2 < units[0] < stats.t.ppf(1 - 0.025 / 9, 39) + 0.1


def test_equal_curves_that_scatter_little_lie_within_the_margin():
    rng = np.random.default_rng(1)
    rows = {
        (engine, seed, 0): RESISTANCE_N * (1 + 0.01 * rng.normal(size=len(DEPTHS_M)))
        for engine in PAIR
        for seed in range(12)
    }
    found = compare_curves(table(rows, DEPTHS_M), PAIR, check())
    assert found.table["within"].all() and not found.table["beyond"].any()
    assert found.table["margin_N"].to_numpy() == pytest.approx(0.1 * RESISTANCE_N, rel=0.02)


def test_a_significant_difference_within_the_margin_is_both():
    rng = np.random.default_rng(1)
    rows = {
        (engine, seed, 0): RESISTANCE_N
        * (1 + 0.003 * rng.normal(size=len(DEPTHS_M)) + 0.03 * (engine == PAIR[0]))
        for engine in PAIR
        for seed in range(12)
    }
    found = compare_curves(table(rows, DEPTHS_M), PAIR, check())
    assert found.table["differs"].all() and found.table["within"].all()
    sentence = opinion_tables.curve_sentence(found, "±10 %")
    assert sentence == "Differ at all depths. Equal to within ±10 % at all depths."


@pytest.mark.parametrize("by_N", [0.5, -0.5])
def test_a_difference_beyond_the_margin_is_said_with_its_depths(by_N):
    """Half a newton of 0.72 is beyond 10 %, either way; without scatter nothing is open."""
    rows = {
        (engine, seed, 0): RESISTANCE_N * (1 + 0.01 * seed) + at(0.045, by_N * (engine == PAIR[0]))
        for engine in PAIR
        for seed in range(8)
    }
    found = compare_curves(table(rows, DEPTHS_M), PAIR, check())
    assert opinion_tables.curve_sentence(found, "±10 %") == (
        "Differ at 4–5 cm; elsewhere no difference is shown. "
        "Equal to within ±10 % at 0–4 and 5–9 cm; unlike by more than ±10 % at 4–5 cm."
    )


def test_noisy_equal_curves_are_never_called_equal():
    found = compare_curves(curves(np.random.default_rng(5), 6), PAIR, check())
    sentence = opinion_tables.curve_sentence(found, "±10 %")
    assert sentence == "No difference is shown at any depth. Open at all depths."
    without = compare_curves(curves(np.random.default_rng(5), 6), PAIR)
    assert "qual" not in opinion_tables.curve_sentence(without, None)


@pytest.mark.parametrize(
    "kind, margin, expected_N",
    [("absolute", 0.3, 0.3), ("relative", 0.1, 0.2), ("ratio", 1.5, 0.8)],
)
def test_the_margin_of_each_kind_in_newtons_where_the_mean_is_2_N(kind, margin, expected_N):
    """1.5 times as much, about a mean of 2 N: 2.4 against 1.6 N."""
    assert margin_N(check(kind, margin), np.array([2.0])) == pytest.approx([expected_N])


def test_few_packings_and_identical_runs_are_said_and_not_tested():
    few = compare_curves(curves(np.random.default_rng(1), 5), PAIR, check())
    assert (few.p, few.table) == (None, None)
    assert "too few" in opinion_tables.curve_sentence(few, "±10 %")
    sample = curves(np.random.default_rng(1), 8)
    same = pd.concat({engine: sample.loc[PAIR[0]] for engine in PAIR}, names=["engine"])
    found = compare_curves(same, PAIR, check())
    assert found.identical and found.p == 1 and not found.table["differs"].any()
    assert opinion_tables.curve_sentence(found, "±10 %") == "The same curves to the last bit."


def test_only_the_twins_that_both_ran_are_compared():
    """Three twins of one code against one of the other would scatter less, and be told apart by that."""
    sample = curves(np.random.default_rng(1), 8, twins=3)
    of_one = sample.drop([(PAIR[0], seed, twin) for seed in range(1, 9) for twin in (1, 2)])
    of_one = of_one.drop([(PAIR[1], 8, 0)])  # no twin in common: no such packing
    means = pairing.shared_means(of_one, PAIR)
    assert list(means[PAIR[0]].index) == list(means[PAIR[1]].index) == list(range(1, 8))
    pd.testing.assert_frame_equal(
        means[PAIR[1]], sample.loc[PAIR[1]].xs(0, level="twin").iloc[:7], check_names=False
    )


def test_runs_with_a_failed_gate_and_beds_that_are_not_the_same_take_no_part():
    sample = curves(np.random.default_rng(1), 3)
    gates = [{"passed": True}]
    about = {run: {"packing_hash": str(run[1]), "gates": gates} for run in sample.index}
    about[PAIR[0], 1, 0] = {"packing_hash": "1", "gates": [*gates, {"passed": False}]}
    about[PAIR[1], 2, 0] = {"packing_hash": "another", "gates": gates}
    left = pairing.sound(Ensemble(sample, sample, sample, about))
    assert list(left.manifests) == [(PAIR[0], 3, 0), (PAIR[1], 1, 0), (PAIR[1], 3, 0)]
    assert list(left.profiles.index) == list(left.manifests)
