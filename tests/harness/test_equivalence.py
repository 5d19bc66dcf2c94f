"""TOST, Holm and planning against statsmodels, closed forms and worked examples."""

import math

import numpy as np
import pytest
from scipy import stats
from statsmodels.stats.multitest import multipletests
from statsmodels.stats.power import TTestPower
from statsmodels.stats.weightstats import ttost_paired

from crossdem.compare import equivalence
from crossdem.compare.equivalence import find, holm, levels, seeds_needed


def column(values):
    return np.array(values, dtype=float)[:, np.newaxis]


def test_the_p_of_equivalence_is_that_of_statsmodels_paired_tost():
    rng = np.random.default_rng(1)
    a, b = rng.normal(1.0, 0.1, 12), rng.normal(1.03, 0.1, 12)
    found = find(column(a - b), np.array([0.1]))
    expected, _, _ = ttost_paired(a, b, -0.1, 0.1)
    assert found.p_equivalent[0] == pytest.approx(expected, rel=1e-12)


def test_a_worked_example():
    """Differences 1, 2, 3, 4, 5: mean 3, standard error sqrt(0.5), 4 degrees of freedom, margin 4."""
    found = find(column([1, 2, 3, 4, 5]), np.array([4.0]))
    error = math.sqrt(0.5)
    assert found.mean[0] == 3 and found.scatter[0] == pytest.approx(math.sqrt(2.5))
    assert (found.low[0], found.high[0]) == pytest.approx(
        (3 - 2.131846786 * error, 3 + 2.131846786 * error)
    )
    assert found.p_equivalent[0] == pytest.approx(stats.t.cdf((3 - 4) / error, 4))
    away = stats.t.sf((3 - 4) / error, 4) + stats.t.sf((3 + 4) / error, 4)
    assert found.p_different[0] == pytest.approx(away)


@pytest.mark.parametrize("sign", [1, -1])
def test_a_difference_of_either_sign_is_found_alike(sign):
    values = column([1.0, 1.2, 0.9, 1.1, 1.0])
    up, here = find(values, np.array([0.5])), find(sign * values, np.array([0.5]))
    assert here.p_different[0] == pytest.approx(up.p_different[0]) and here.p_different[0] < 0.01
    assert here.p_equivalent[0] == pytest.approx(up.p_equivalent[0]) and here.p_equivalent[0] > 0.9


def test_against_a_margin_of_nearly_nothing_it_is_the_two_sided_t_test():
    values = [0.3, -0.1, 0.4, 0.2, 0.1]
    found = find(column(values), np.array([1e-12]))
    assert found.p_different[0] == pytest.approx(stats.ttest_1samp(values, 0).pvalue)


def test_holm_on_a_worked_example():
    """Smallest times 4, next times 3, and never below the one before: 0.04, 0.06, 0.06, 0.06."""
    assert holm(np.array([0.03, 0.01, 0.06, 0.02])) == pytest.approx([0.06, 0.04, 0.06, 0.06])
    assert holm(np.array([0.9, 0.8])) == pytest.approx([1.0, 1.0])


def test_holm_is_that_of_statsmodels():
    rng = np.random.default_rng(2)
    for _ in range(5):
        p = rng.uniform(0, 0.3, 13)
        assert holm(p) == pytest.approx(multipletests(p, method="holm")[1])


def test_the_claims_of_a_pair_are_corrected_together():
    values = np.random.default_rng(3).normal(0.02, 0.05, (8, 5))
    together = find(values, np.full(5, 0.1))
    alone = np.array([find(values[:, [n]], np.array([0.1])).p_equivalent[0] for n in range(5)])
    assert together.p_equivalent == pytest.approx(multipletests(alone, method="holm")[1])


@pytest.mark.parametrize(
    "shift, equivalent, different",
    [(0.5, 1, 1), (-0.5, 1, 1), (0.4, 0, 1), (-0.4, 0, 1), (0.6, 1, 0), (-0.6, 1, 0)],
)
def test_without_scatter_nothing_is_left_to_chance(shift, equivalent, different):
    found = find(np.full((3, 1), shift), np.array([0.5]))
    assert (found.p_equivalent[0], found.p_different[0]) == (equivalent, different)


def test_one_packing_or_none_proves_nothing():
    for values in (np.empty((0, 2)), np.zeros((1, 2))):
        found = find(values, np.array([0.1, 0.1]))
        assert np.isnan(found.low).all() and (found.p_equivalent == 1).all()
        assert (found.p_different == 1).all()


def test_a_column_without_value_proves_nothing_and_hurts_no_other():
    values = np.column_stack([[0.01, 0.0, -0.01, 0.0], [0.0, np.nan, 0.0, 0.0], [0, np.inf, 0, 0]])
    found = find(values, np.full(3, 0.1))
    assert found.p_equivalent[0] < 0.01
    assert (found.p_equivalent[1:] == 1).all() and np.isnan(found.low[1:]).all()


def test_no_more_than_five_percent_of_engines_at_the_margin_pass_for_equivalent():
    """And of those just within it, no more than that for different."""
    rng = np.random.default_rng(4)
    passed = different = 0
    for _ in range(400):
        found = find(rng.normal(0.1, 0.1, (16, 1)), np.array([0.1]))
        passed += found.p_equivalent[0] <= equivalence.ALPHA
        different += found.p_different[0] <= equivalence.ALPHA
    assert 4 <= passed <= 36 and 4 <= different <= 36  # 20 each, within 3.7 standard deviations


def test_of_a_family_the_easiest_is_held_against_the_strictest_level():
    assert levels(np.array([1.0, 3.0, 2.0])) == pytest.approx([0.05, 0.05 / 3, 0.05 / 2])


def test_the_seeds_needed_for_a_true_difference_have_the_power_of_the_one_sided_t_test():
    """Beyond the margin, where one of the two tests is decided: by statsmodels' power of a t-test."""
    seeds = seeds_needed(0.1, 0.08, 0.15)
    sizes = np.array([seeds - 1, seeds])
    power = TTestPower().power((0.15 - 0.1) / 0.08, sizes, 0.05, alternative="larger")
    assert power[0] < equivalence.POWER <= power[1]
    assert seeds_needed(0.1, 0.08, -0.15) == seeds
    assert seeds_needed(0.1, 0.08, 0.0999) is None
    assert seeds_needed(0.1, 0.08, 0.05) == seeds  # as far from the margin on the other side
    assert seeds_needed(0.1, 0.08, 0.0, 0.01) > seeds_needed(0.1, 0.08)
