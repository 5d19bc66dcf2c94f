"""Each code against the others: the one that is shifted stands apart, by the checks' own statistics."""

import numpy as np
import pandas as pd
import pytest
from paired_tables import table

from crossdem.compare.checks import DIFFERENT, EQUIVALENT, NOT_COMPARABLE, evaluate
from crossdem.compare.consensus import OTHERS, apart, leave_one_out
from crossdem.compare.margins import Check
from crossdem.compare.quantities import QUANTITIES

ENGINES = ("native", "liggghts", "yade")
CHECK = Check(QUANTITIES["mean_resistance_N"], "relative", 0.10, 0.06, "a reason")


def endpoints(factors=(1.0, 1.0, 1.0), engines=ENGINES, packings=12):
    rng = np.random.default_rng(1)
    beds = 1 + 0.05 * rng.normal(size=packings)
    rows = {
        (engine, seed, 0): [factor * beds[seed] * (1 + 0.02 * rng.normal())]
        for engine, factor in zip(engines, factors)
        for seed in range(packings)
    }
    return table(rows, ["mean_resistance_N"])


def test_two_codes_have_no_consensus():
    assert leave_one_out([CHECK], endpoints(engines=ENGINES[:2]), ENGINES[:2]) == []
    assert leave_one_out([], endpoints(), ENGINES) == []


def test_each_engine_is_held_against_the_mean_of_the_others():
    sample = endpoints((1.0, 1.0, 1.3))
    results = leave_one_out([CHECK], sample, ENGINES)
    assert [one.pair for one in results] == [(engine, OTHERS) for engine in ENGINES]
    means = [sample.loc[[engine], "mean_resistance_N"].mean() for engine in ENGINES]
    yade = results[-1]
    assert yade.means == pytest.approx((means[2], (means[0] + means[1]) / 2))
    assert yade.difference == pytest.approx((yade.means[0] - yade.means[1]) / (sum(yade.means) / 2))
    assert yade.outcome == DIFFERENT


@pytest.mark.parametrize("off", ENGINES)
@pytest.mark.parametrize("factor", [0.75, 1.3])
def test_an_outlier_shifts_the_others_by_half_its_distance_and_is_the_one_that_stands_apart(
    off, factor
):
    factors = [factor if engine == off else 1.0 for engine in ENGINES]
    results = leave_one_out([CHECK], endpoints(factors), ENGINES)
    assert {one.outcome for one in results} == {DIFFERENT}
    shifts = {one.pair[0]: one.means[0] - one.means[1] for one in results}
    for engine in set(ENGINES) - {off}:
        assert shifts[engine] == pytest.approx(-shifts[off] / 2, abs=0.03)
    assert apart(results) == off


def test_equal_codes_are_equivalent_to_the_others_and_none_stands_apart():
    results = leave_one_out([CHECK], endpoints(), ENGINES)
    assert {one.outcome for one in results} == {EQUIVALENT}
    assert apart(results) is None


def test_an_obstacle_of_one_code_forbids_the_consensus_of_all():
    results = leave_one_out([CHECK], endpoints(), ENGINES, ["yade, seed 1: it does not rest"])
    assert {one.outcome for one in results} == {NOT_COMPARABLE}


def test_of_two_codes_the_others_would_be_the_other_one():
    """With a third code that is the mean of both, each stands against 3/4 of the other and 1/4 of itself."""
    sample = endpoints(engines=ENGINES[:2])
    first, second = (sample.loc[[engine]].droplevel("engine") for engine in ENGINES[:2])
    mean = pd.concat({"yade": (first + second) / 2}, names=["engine"])
    results = leave_one_out([CHECK], pd.concat([sample, mean]), ENGINES)
    assert results[-1].difference == pytest.approx(0.0, abs=1e-12)
    pair = evaluate([CHECK], ENGINES[:2], sample.droplevel("twin"))[0]
    assert (
        np.sign(results[0].difference)
        == np.sign(pair.difference)
        == -np.sign(results[1].difference)
    )


def test_only_packings_that_all_ran_count():
    sample = endpoints().drop([("native", 0, 0), ("yade", 5, 0)])
    results = leave_one_out([CHECK], sample, ENGINES)
    assert all(
        one.seeds == tuple(seed for seed in range(12) if seed not in (0, 5)) for one in results
    )
