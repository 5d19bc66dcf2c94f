"""Checks: what each kind means, and that each outcome comes about when it should and only then."""

import math

import numpy as np
import pandas as pd
import pytest
import synthetic

from crossdem.compare import checks, equivalence, quantities, wording
from crossdem.compare.checks import (
    DIFFERENT,
    EQUIVALENT,
    INCONCLUSIVE,
    NOT_COMPARABLE,
    Check,
    evaluate,
)
from crossdem.compare.ensemble import packing_means

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


def judged(liggghts, native, check=None, obstacles=(), pair=PAIR):
    """The result of one check, the only one of its family."""
    (result,) = evaluate([check or relative()], pair, endpoints(liggghts, native), obstacles)
    return result


def outcome(liggghts, native, check=None):
    return judged(liggghts, native, check).outcome


def test_identical_runs_are_equivalent():
    values = [1.0, 1.1, 0.9, 1.2, 1.0]
    assert outcome(values, values) == EQUIVALENT


def test_what_the_packing_does_to_both_engines_cancels():
    beds = [0.5, 1.0, 2.0, 1.5, 0.8]
    assert outcome([0.5, 1.01, 2.01, 1.5, 0.8], beds) == EQUIVALENT


def test_runs_are_paired_by_seed_not_by_their_place_in_the_table():
    beds = [0.5, 1.0, 2.0, 1.5, 0.8]
    table = endpoints(beds, beds)
    shuffled = table.iloc[[4, 0, 3, 1, 2, 5, 6, 7, 8, 9]]
    (result,) = evaluate([relative()], PAIR, shuffled)
    assert (result.outcome, result.interval) == (EQUIVALENT, (0.0, 0.0))


def test_only_packings_that_both_ran_are_compared():
    table = endpoints([1.0] * 5 + [9.0], [1.0] * 5)
    (result,) = evaluate([relative()], PAIR, table)
    assert (result.outcome, result.seeds) == (EQUIVALENT, (1, 2, 3, 4, 5))


def test_three_twins_of_a_packing_count_once_however_many_the_other_engine_has():
    """Differences by packing 0.1, 0.2, 0.3, 0.2, 0.2; as 15 runs the interval would be half as wide."""
    shifts = [0.1, 0.2, 0.3, 0.2, 0.2]
    rows = {
        (engine, seed, twin): 1.0 + (shift + (twin - 1) * 0.05 if engine == "liggghts" else 0)
        for seed, shift in enumerate(shifts, start=1)
        for engine, twins in (("liggghts", 3), ("native", 1))
        for twin in range(twins)
    }
    index = pd.MultiIndex.from_tuples(rows, names=["engine", "seed", "twin"])
    runs = pd.DataFrame({"mean_resistance_N": list(rows.values())}, index=index)
    check = Check(RESISTANCE, "absolute", 0.15, 0.08, "")
    (result,) = evaluate([check], PAIR, packing_means(runs))
    half_width = 2.131846786 * math.sqrt(0.02 / 4 / 5)  # t(0.95, 4 degrees of freedom)
    assert len(result.seeds) == 5
    assert result.interval == pytest.approx((0.2 - half_width, 0.2 + half_width))


@pytest.mark.parametrize("seeds", [1, 2, 4])
def test_fewer_than_five_packings_only_raise_alarms(seeds):
    assert outcome([1.0] * seeds, [1.0] * seeds) == INCONCLUSIVE
    assert outcome([1.2] * seeds, [1.0] * seeds) == INCONCLUSIVE
    assert outcome([2.0] * seeds, [1.0] * seeds) == DIFFERENT


def test_a_difference_that_is_not_significant_is_no_equivalence():
    """p = 0.9 of no difference, and an interval that reaches far beyond the margin."""
    result = judged([1.3, 0.7, 1.25, 0.8, 1.0], [1.0] * 5)
    assert abs(result.difference) < 0.02 and result.outcome == INCONCLUSIVE


def test_a_difference_within_the_margin_is_no_alarm_however_little_the_runs_scatter():
    quiet = relative(margin=0.10, seed_scatter=0.001)
    assert outcome([1.05] * 5, [1.0] * 5, quiet) == EQUIVALENT
    assert outcome([1.05], [1.0], quiet) == INCONCLUSIVE
    assert outcome([1.12], [1.0], quiet) == DIFFERENT


@pytest.mark.parametrize("shift", [0.1, -0.1])
def test_an_interval_that_touches_the_margin_is_inconclusive(shift):
    noise = np.array([-0.01, 0.01, -0.02, 0.02, 0.0])
    differences = shift / 2 + noise
    end = max(map(abs, judged(1 + differences, [1.0] * 5, absolute(1.0)).interval))
    for share, expected in ((1, INCONCLUSIVE), (1 + 1e-6, EQUIVALENT), (1 - 1e-6, INCONCLUSIVE)):
        assert outcome(1 + differences, [1.0] * 5, absolute(share * end)) == expected
    near = min(map(abs, judged(1 + 2 * differences, [1.0] * 5, absolute(1.0)).interval))
    for share, expected in ((1 + 1e-6, INCONCLUSIVE), (0.99, DIFFERENT)):
        assert outcome(1 + 2 * differences, [1.0] * 5, absolute(share * near)) == expected


@pytest.mark.parametrize(
    "shift, within, beyond",
    [
        (0.0, True, False),
        (0.1, False, False),
        (-0.1, False, False),
        (0.3, False, True),
        (-0.3, False, True),
    ],
)
def test_where_the_interval_lies(shift, within, beyond):
    noisy = [1.0 + shift + d for d in (-0.02, 0.02, 0, 0.01, -0.01)]
    result = judged(noisy, [1.0] * 5, absolute(0.1))
    assert (result.within, result.beyond) == (within, beyond)


def absolute(margin):
    return Check(RESISTANCE, "absolute", margin, 0.08, "")


def test_differences_without_scatter_at_the_margin_are_inconclusive():
    margin = 1.5 - 1.0
    assert outcome([1.5] * 5, [1.0] * 5, absolute(margin)) == INCONCLUSIVE
    assert outcome([1.5] * 5, [1.0] * 5, absolute(margin + 0.01)) == EQUIVALENT
    assert outcome([1.5] * 5, [1.0] * 5, absolute(margin - 0.01)) == DIFFERENT


@pytest.mark.parametrize(
    "seeds, errors", [(1, 4.604), (2, 3.707 * (4 / 6) ** 0.5), (4, 3.169 * (4 / 10) ** 0.5)]
)
@pytest.mark.parametrize("sign", [1, -1])
def test_the_alarm_band_is_students_t_of_standard_errors_wider_than_the_margin(seeds, errors, sign):
    """0.08 is stated, worth 4 degrees of freedom, and each engine's runs, which do not scatter, are worth n - 1.

    t(0.995) of 4, 6 and 10 degrees; 0.08 sqrt(2 / n) is the standard error of the mean difference of n packings.
    """
    check = absolute(0.1)
    half_width = pytest.approx(0.1 + errors * 0.08 * math.sqrt(2 / seeds), rel=2e-4)
    for share, expected in ((0.999, INCONCLUSIVE), (1.001, DIFFERENT)):
        result = judged([1 + sign * share * half_width.expected] * seeds, [1.0] * seeds, check)
        assert (result.outcome, result.alarm) == (expected, half_width)
        assert ("outside" in wording.explanation(result)) == (expected == DIFFERENT)
        assert wording.band(check, result.alarm) in wording.explanation(result)


def test_from_five_packings_on_nothing_differs_that_the_interval_does_not_show():
    """A mean far outside any alarm band, of differences that scatter as much."""
    shifts = np.array([1.5, 0.5, 1.4, 0.6, 1.0])
    quiet = Check(RESISTANCE, "absolute", 0.1, 0.001, "")
    result = judged(1 + shifts, [1.0] * 5, quiet)
    assert result.difference == pytest.approx(1.0) and result.interval[0] < 0.6
    assert (result.outcome, result.alarm) == (DIFFERENT, None)
    wide = Check(RESISTANCE, "absolute", 0.7, 0.001, "")
    assert judged(1 + shifts, [1.0] * 5, wide).outcome == INCONCLUSIVE
    assert judged(1 + shifts[:4], [1.0] * 4, wide).outcome == DIFFERENT


def test_the_scatter_of_the_alarm_band_is_pooled_from_the_stated_one_and_both_engines():
    """Squares 4 x 0.08^2 as stated, and of each engine 4 x 0.3^2, over the square of its mean of 1.8 and 1.3."""
    wild = [1.0, 1.6, 1.0, 1.6]
    result = judged([value + 0.5 for value in wild], wild)
    squares = 4 * 0.08**2 + 4 * 0.3**2 / 1.8**2 + 4 * 0.3**2 / 1.3**2
    assert result.scatter == pytest.approx(math.sqrt(squares / 10))
    assert result.scatter_degrees == 10 and not result.alarmed


def test_an_engine_that_scatters_wildly_does_not_excuse_itself():
    """It counts as three times the other one, or three times what is stated."""
    assert outcome([0.95, 0.1], [0.95, 1.0]) == DIFFERENT
    assert outcome([0.5, 0.15], [0.95, 1.0]) == DIFFERENT
    wild = judged([1.0, 3.0], [1.0, 1.0], absolute(0.1))
    assert wild.scatter == pytest.approx(math.sqrt((4 * 0.08**2 + 0.24**2) / 6))
    both = judged([1.0, 3.0], [1.0, 1.4], absolute(0.1))
    assert both.scatter == pytest.approx(math.sqrt((4 * 0.08**2 + 9 * 0.08 + 0.08) / 6))


def test_packings_without_a_value_tell_nothing_of_the_scatter():
    ratio = Check(RESISTANCE, "ratio", 1.33, 1.15, "")
    result = judged([1.0, np.nan], [0.0, 2.0], ratio)
    assert (result.scatter, result.scatter_degrees) == (pytest.approx(math.log(1.15)), 4)


def alarms(seeds, scatter, difference, trials=400):
    """Share of checks that call two engines DIFFERENT which truly differ by that much.

    `scatter` is the true one, in units of the 0.08 that the checks state beside a margin of 0.1.
    """
    random = np.random.default_rng([1, seeds])
    names = sorted(quantities.QUANTITIES)
    family = [Check(quantities.QUANTITIES[name], "absolute", 0.1, 0.08, "") for name in names]
    index = pd.MultiIndex.from_product([PAIR, range(seeds)], names=["engine", "seed"])
    shift = np.where(index.get_level_values("engine") == PAIR[0], difference, 0.0)
    found = [
        result.outcome == DIFFERENT
        for _ in range(trials)
        for result in evaluate(
            family,
            PAIR,
            pd.DataFrame(
                10 + shift[:, None] + scatter * 0.08 * random.normal(size=(len(index), len(names))),
                index=index,
                columns=names,
            ),
        )
    ]
    return np.mean(found)


@pytest.mark.parametrize("seeds", [1, 2, 3, 4])
def test_alarms_are_as_rare_as_said_even_if_runs_scatter_twice_as_much_as_stated(seeds):
    assert alarms(seeds, scatter=1, difference=0.1) <= 0.005
    assert alarms(seeds, scatter=2, difference=0.1) <= 0.02
    assert alarms(seeds, scatter=2, difference=0.0) <= 0.01


@pytest.mark.parametrize("seeds, errors", [(2, 4.7), (3, 4.4), (4, 4.2)])
def test_four_of_five_large_differences_raise_an_alarm_where_runs_scatter_as_stated(seeds, errors):
    """0.08 sqrt(2 / n) is the standard error of the mean difference of n packings."""
    difference = 0.1 + errors * 0.08 * math.sqrt(2 / seeds)
    assert alarms(seeds, scatter=1, difference=difference, trials=100) >= 0.8


def test_an_interval_wholly_outside_the_margin_differs_from_five_seeds_on():
    shifted = [1.20, 1.21, 1.19, 1.20, 1.21]
    assert outcome(shifted, [1.0] * 5) == DIFFERENT
    assert outcome(shifted[:4], [1.0] * 4) == INCONCLUSIVE


def test_two_noisy_seeds_are_inconclusive():
    assert outcome([1.05, 0.97], [0.95, 1.02]) == INCONCLUSIVE


def test_one_seed_gives_no_interval():
    result = judged([1.0], [1.0])
    assert (result.outcome, result.interval) == (INCONCLUSIVE, None)


def test_the_interval_is_students_90_percent_interval_of_the_paired_differences():
    result = judged([1.1, 1.3], [1.0, 1.0], absolute(0.1))
    half_width = 6.313751515 * 0.1  # t(0.95, 1 degree of freedom) times scatter / sqrt(2)
    assert result.difference == pytest.approx(0.2)
    assert result.interval == pytest.approx((0.2 - half_width, 0.2 + half_width))


def test_relative_differences_are_over_the_mean_of_both_engines():
    result = judged([1.1, 1.1], [0.9, 0.9])
    assert result.difference == pytest.approx(0.2)
    assert result.means == pytest.approx((1.1, 0.9))


def test_a_ratio_is_compared_as_a_factor_either_way():
    ratio = Check(RESISTANCE, "ratio", 1.33, 1.15, "")
    up = judged([2.1, 2.1], [1.0, 1.0], ratio)
    down = judged([1.0, 1.0], [2.1, 2.1], ratio)
    assert up.difference == pytest.approx(math.log(2.1))
    assert down.difference == pytest.approx(-math.log(2.1))
    assert up.outcome == down.outcome == DIFFERENT  # 2.1 > 1.33 x 1.15^3 = 2.02
    assert outcome([1.3] * 5, [1.0] * 5, ratio) == EQUIVALENT
    assert outcome([1.0] * 5, [1.3] * 5, ratio) == EQUIVALENT


def test_a_ratio_of_nothing_is_not_comparable():
    ratio = Check(RESISTANCE, "ratio", 1.33, 1.15, "")
    assert outcome([0.0, 1.0], [1.0, 1.0], ratio) == NOT_COMPARABLE


def test_an_obstacle_makes_even_identical_runs_not_comparable():
    result = judged([1.0, 1.1], [1.0, 1.1], obstacles=["native, seed 1: the bed does not rest"])
    assert result.outcome == NOT_COMPARABLE
    assert result.difference == 0  # still told


def test_an_engine_without_runs_is_not_comparable():
    result = judged([1.0], [1.0], pair=("yade", "native"))
    assert (result.outcome, result.seeds) == (NOT_COMPARABLE, ())


def test_a_ratio_of_negative_values_is_not_comparable():
    ratio = Check(RESISTANCE, "ratio", 1.33, 1.15, "")
    assert outcome([-1.0] * 5, [-1.0] * 5, ratio) == NOT_COMPARABLE


def test_a_quantity_that_is_not_a_number_is_not_comparable():
    assert outcome([np.nan, 1.0], [1.0, 1.0]) == NOT_COMPARABLE


def test_the_seeds_needed_give_the_power_that_they_promise():
    """Two equal engines, simulated: about 9 of 10 comparisons end in agreement."""
    margin, scatter = 0.10, 0.08 * math.sqrt(2)
    seeds = equivalence.seeds_needed(margin, scatter)
    assert seeds == 16
    rng = np.random.default_rng(1)
    agreed = [
        outcome(1 + rng.normal(0, 0.08, seeds), 1 + rng.normal(0, 0.08, seeds)) == EQUIVALENT
        for _ in range(400)
    ]
    assert 0.86 < np.mean(agreed) < 0.95


@pytest.mark.parametrize(
    "margin, scatter, seeds", [(0.01, 0.0057, 6), (1.0, 0.0, 2), (1.0, 1e-9, 2), (1e-6, 1.0, None)]
)
def test_the_seeds_needed_at_and_between_the_ends(margin, scatter, seeds):
    assert equivalence.seeds_needed(margin, scatter) == seeds


def test_from_ten_seeds_on_the_seeds_needed_follow_the_measured_scatter():
    rng = np.random.default_rng(1)
    quiet = 1 + rng.normal(0, 0.001, 10)
    few = judged(quiet[:9], np.ones(9))
    many = judged(quiet, np.ones(10))
    assert few.seeds_needed == 16
    assert many.seeds_needed == checks.SEEDS_FOR_INTERVAL


def test_a_check_without_a_value_leaves_the_others_theirs_and_stays_in_their_family():
    table = endpoints([1.0, 1.1, 0.95, 1.0, 1.0], [1.0] * 5)
    table["work_J"] = np.nan
    empty = Check(quantities.QUANTITIES["work_J"], "relative", 0.1, 0.08, "")
    found, lost = evaluate([relative(), empty], PAIR, table)
    alone = judged([1.0, 1.1, 0.95, 1.0, 1.0], [1.0] * 5)
    assert lost.outcome == NOT_COMPARABLE and found.outcome != NOT_COMPARABLE
    assert found.p_equivalent == pytest.approx(2 * alone.p_equivalent)


def test_each_check_reads_its_own_column_and_holds_it_against_its_own_margin():
    table = endpoints([1.2] * 5, [1.0] * 5)
    table["work_J"] = [3.0] * 10
    work = Check(quantities.QUANTITIES["work_J"], "relative", 0.1, 0.08, "")
    wide = Check(RESISTANCE, "relative", 0.3, 0.08, "")
    outcomes = [result.outcome for result in evaluate([relative(), work, wide], PAIR, table)]
    assert outcomes == [DIFFERENT, EQUIVALENT, EQUIVALENT]


def test_an_interval_within_the_margin_is_not_enough_among_many_checks():
    noisy = [1.12, 0.95, 1.05, 0.93, 1.02, 1.01]
    family = [relative()] * 10
    alone = judged(noisy, [1.0] * 6)
    (among, *_) = evaluate(family, PAIR, endpoints(noisy, [1.0] * 6))
    assert (alone.outcome, among.outcome) == (EQUIVALENT, INCONCLUSIVE)
    assert among.within and among.p_equivalent == pytest.approx(10 * alone.p_equivalent)
    said = wording.explanation(among)
    assert "lies within the margin ±10 %, but among 10 checks that can be chance" in said
    assert among.seeds_needed > alone.seeds_needed == 16


def test_planning_holds_the_easiest_check_against_the_level_that_holm_leaves_it():
    hard, easy = relative(margin=0.10), relative(margin=0.40)
    results = evaluate([hard, easy], PAIR, endpoints([1.0] * 5, [1.0] * 5))
    assert [result.level for result in results] == pytest.approx([0.05, 0.025])


def test_what_it_takes_to_settle_a_difference_as_measured_is_more_the_nearer_the_margin():
    near, far = (
        judged([1 + s + d for d in (-0.02, 0.02, 0, 0.01, -0.01)], [1.0] * 5) for s in (0.09, 0.01)
    )
    assert near.seeds_to_settle > far.seeds_to_settle >= far.seeds_needed == 16


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
