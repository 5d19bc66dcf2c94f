"""Checks: what each kind means, and that each outcome comes about when it should and only then."""

import math

import numpy as np
import pandas as pd
import pytest
import synthetic

from crossdem.compare import checks, quantities
from crossdem.compare.checks import AGREES, DIFFERS, INCONCLUSIVE, NOT_COMPARABLE, Check, evaluate

PAIR = ("liggghts", "native")
RESISTANCE = quantities.QUANTITIES["mean_resistance_N"]


def relative(margin=0.10, seed_scatter=0.08):
    return Check(RESISTANCE, "relative", margin, seed_scatter, "a reason")


def endpoints(liggghts, native, quantity="mean_resistance_N"):
    """A table of endpoints; the seeds are 1, 2, 3 …"""
    rows = {
        (engine, seed): value
        for engine, values in (("liggghts", liggghts), ("native", native))
        for seed, value in enumerate(values, start=1)
    }
    index = pd.MultiIndex.from_tuples(rows, names=["engine", "seed"])
    return pd.DataFrame({quantity: list(rows.values())}, index=index, dtype=float)


def outcome(liggghts, native, check=None):
    return evaluate(check or relative(), PAIR, endpoints(liggghts, native)).outcome


def test_identical_runs_agree():
    assert outcome([1.0, 1.1, 0.9], [1.0, 1.1, 0.9]) == AGREES


def test_what_the_packing_does_to_both_engines_cancels():
    assert outcome([0.5, 1.01, 2.01], [0.5, 1.0, 2.0]) == AGREES


def test_a_shift_beyond_the_alarm_band_differs_at_any_number_of_seeds():
    assert outcome([1.5], [1.0]) == DIFFERS
    assert outcome([1.0], [1.5]) == DIFFERS
    assert outcome([1.5, 1.6], [1.0, 1.1]) == DIFFERS


def test_the_alarm_band_is_four_seed_to_seed_scatters():
    just_inside, just_outside = 1 + 0.31, 1 + 0.33
    for value, expected in ((just_inside, INCONCLUSIVE), (just_outside, DIFFERS)):
        b = 1.0
        a = b * (2 + (value - 1)) / (2 - (value - 1))  # (a - b) / mean = value - 1
        assert outcome([a], [b]) == expected


def test_runs_that_scatter_more_than_the_case_states_widen_the_alarm_band():
    wild = [
        1.0,
        1.6,
        1.0,
        1.6,
    ]  # a scatter of 0.35 / 1.3 in one engine and 0.35 / 1.8 in the other; 0.08 is stated
    result = evaluate(relative(), PAIR, endpoints([value + 0.5 for value in wild], wild))
    calmer = math.sqrt(4 * 0.3**2 / 3) / 1.8
    assert result.scatter == pytest.approx(calmer)
    assert not result.alarmed and result.alarm == pytest.approx(4 * calmer)


def test_an_engine_that_scatters_wildly_does_not_excuse_itself():
    assert outcome([0.95, 0.1], [0.95, 1.0]) == DIFFERS
    assert outcome([0.5, 0.15], [0.95, 1.0]) == DIFFERS


def test_runs_that_scatter_less_than_the_case_states_leave_the_alarm_band_as_it_is():
    assert evaluate(relative(), PAIR, endpoints([1.0, 1.01], [1.0, 1.02])).scatter == 0.08


def test_an_interval_wholly_outside_the_margin_differs_from_five_seeds_on():
    shifted = [1.20, 1.21, 1.19, 1.20, 1.21]
    assert outcome(shifted, [1.0] * 5) == DIFFERS
    assert outcome(shifted[:4], [1.0] * 4) == INCONCLUSIVE


def test_two_noisy_seeds_are_inconclusive():
    assert outcome([1.05, 0.97], [0.95, 1.02]) == INCONCLUSIVE


def test_one_seed_is_inconclusive_as_it_gives_no_interval():
    result = evaluate(relative(), PAIR, endpoints([1.0], [1.0]))
    assert (result.outcome, result.interval) == (INCONCLUSIVE, None)


def test_the_interval_is_students_90_percent_interval_of_the_paired_differences():
    result = evaluate(
        Check(RESISTANCE, "absolute", 0.1, 0.08, ""), PAIR, endpoints([1.1, 1.3], [1.0, 1.0])
    )
    half_width = 6.313751515 * 0.1  # t(0.95, 1 degree of freedom) times scatter / sqrt(2)
    assert result.difference == pytest.approx(0.2)
    assert result.interval == pytest.approx((0.2 - half_width, 0.2 + half_width))


def test_relative_differences_are_over_the_mean_of_both_engines():
    result = evaluate(relative(), PAIR, endpoints([1.1, 1.1], [0.9, 0.9]))
    assert result.difference == pytest.approx(0.2)
    assert result.means == pytest.approx((1.1, 0.9))


def test_a_ratio_is_compared_as_a_factor_either_way():
    ratio = Check(RESISTANCE, "ratio", 1.33, 1.15, "")
    up = evaluate(ratio, PAIR, endpoints([2.0, 2.0], [1.0, 1.0]))
    down = evaluate(ratio, PAIR, endpoints([1.0, 1.0], [2.0, 2.0]))
    assert up.difference == pytest.approx(math.log(2))
    assert down.difference == pytest.approx(-math.log(2))
    assert up.outcome == down.outcome == DIFFERS  # 2 > 1.15^4 = 1.75
    assert outcome([1.3, 1.3], [1.0, 1.0], ratio) == AGREES
    assert outcome([1.0, 1.0], [1.3, 1.3], ratio) == AGREES


def test_a_ratio_of_nothing_is_not_comparable():
    ratio = Check(RESISTANCE, "ratio", 1.33, 1.15, "")
    assert outcome([0.0, 1.0], [1.0, 1.0], ratio) == NOT_COMPARABLE


def test_an_obstacle_makes_even_identical_runs_not_comparable():
    table = endpoints([1.0, 1.1], [1.0, 1.1])
    result = evaluate(relative(), PAIR, table, ("native, seed 1: the bed does not rest",))
    assert result.outcome == NOT_COMPARABLE
    assert result.difference == 0  # still told


def test_an_engine_without_runs_is_not_comparable():
    result = evaluate(relative(), ("yade", "native"), endpoints([1.0], [1.0]))
    assert (result.outcome, result.seeds) == (NOT_COMPARABLE, ())


def test_a_quantity_that_is_not_a_number_is_not_comparable():
    assert outcome([np.nan, 1.0], [1.0, 1.0]) == NOT_COMPARABLE


def test_the_seeds_needed_give_the_power_that_they_promise():
    """Two equal engines, simulated: about 9 of 10 comparisons end in agreement."""
    margin, scatter = 0.10, 0.08 * math.sqrt(2)
    seeds = checks.seeds_needed(margin, scatter)
    assert seeds == 16
    rng = np.random.default_rng(1)
    agreed = [
        outcome(1 + rng.normal(0, 0.08, seeds), 1 + rng.normal(0, 0.08, seeds)) == AGREES
        for _ in range(400)
    ]
    assert 0.86 < np.mean(agreed) < 0.95


@pytest.mark.parametrize(
    "margin, scatter, seeds", [(0.01, 0.0057, 6), (1.0, 0.0, 2), (1.0, 1e-9, 2), (1e-6, 1.0, None)]
)
def test_the_seeds_needed_at_and_between_the_ends(margin, scatter, seeds):
    assert checks.seeds_needed(margin, scatter) == seeds


def test_from_ten_seeds_on_the_seeds_needed_follow_the_measured_scatter():
    rng = np.random.default_rng(1)
    quiet = 1 + rng.normal(0, 0.001, 10)
    few = evaluate(relative(), PAIR, endpoints(quiet[:9], np.ones(9)))
    many = evaluate(relative(), PAIR, endpoints(quiet, np.ones(10)))
    assert few.seeds_needed == 16
    assert many.seeds_needed < 5


def test_a_check_of_an_unknown_quantity_is_a_fault_with_its_key_path():
    check = synthetic.MEAN_RESISTANCE
    case = {"check": [check, check, {**check, "quantity": "mean_resistence_N"}]}
    (fault,) = quantities.unknown_quantities(case)
    assert fault.startswith("check[2].quantity: unknown quantity 'mean_resistence_N'")
    assert "did you mean 'mean_resistance_N'?" in fault
    assert all(name in fault for name in quantities.QUANTITIES)
    assert quantities.unknown_quantities({"check": [check]}) == []
    assert quantities.unknown_quantities({}) == []


def test_a_ratio_needs_factors_above_one():
    check = {**synthetic.MEAN_RESISTANCE, "kind": "ratio", "margin": 1.33, "seed_scatter": 0.15}
    (fault,) = checks.check_faults({"check": [check]})
    assert fault.startswith("check[0].seed_scatter: 0.15 is not a factor above 1")


def test_every_quantity_has_a_definition_a_title_and_a_name_that_ends_in_its_unit():
    for name, quantity in quantities.QUANTITIES.items():
        assert quantity.definition and quantity.title
        assert name.endswith(quantity.unit.replace("/", "_"))


def test_a_relative_difference_of_nothing_is_not_comparable():
    assert outcome([0.0, 0.0], [0.0, 0.0]) == NOT_COMPARABLE
