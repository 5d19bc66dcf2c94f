"""Displacement fields: what equal codes give, and that a moved cell is found, and only it."""

import numpy as np
import pandas as pd
import pytest
from paired_tables import PAIR, cells, fields, table
from scipy import stats

from crossdem.compare import opinion_tables, pairing
from crossdem.compare.fields import (
    SPLITS,
    cell_t,
    compare_fields,
    largest_t_test,
    split_shares,
)

TRIALS, MOST_ALARMS = 200, 20  # as in test_curves.py
MOVED = ("y", 0.025, 0.015)


def moved(by_m):
    """A shift of one cell in one direction."""
    component, *place = MOVED
    return np.array([by_m * (c == component and at == pytest.approx(place)) for c, *at in cells()])


def values(sample):
    return [sample.loc[engine].to_numpy() for engine in PAIR]


@pytest.mark.parametrize("by_m, direction", [(0.004, "up"), (-0.004, "down")])
def test_a_moved_cell_is_found_and_no_other(by_m, direction):
    found = compare_fields(fields(np.random.default_rng(1), 16, moved(by_m)), PAIR)
    standing = found.cells[found.cells["p"] <= pairing.ALPHA]
    ((component, *place),) = standing.index
    assert component == MOVED[0] and place == pytest.approx(MOVED[1:])
    assert found.p <= 0.001
    assert standing["difference_m"].iloc[0] == pytest.approx(by_m, rel=0.4)
    sentence = opinion_tables.field_sentence(found)
    assert sentence.startswith("1 cell stands out, most of all that at x = 2.5 cm, y = 1.5 cm")
    assert sentence.endswith(f"mm further {direction}.")


def test_equal_codes_have_an_outstanding_cell_1_time_in_20():
    rng = np.random.default_rng(1)
    alarms = 0
    for _ in range(TRIALS):
        first, second = values(fields(rng, 12))
        p, p_cells = largest_t_test(first - second)
        assert (p <= pairing.ALPHA) == (p_cells <= pairing.ALPHA).any()
        alarms += p <= pairing.ALPHA
    assert 2 <= alarms <= MOST_ALARMS


@pytest.mark.parametrize("bed_m, own_m", [(0.001, 0.001), (0.003, 0.0005), (0.0, 0.001)])
@pytest.mark.parametrize("packings", [7, 16])
def test_the_ratio_of_equal_codes_is_1_on_average(bed_m, own_m, packings):
    """However much of the scatter is the beds', which both codes share, and for odd numbers, too."""
    rng = np.random.default_rng(1)
    samples = (values(fields(rng, packings, bed_m=bed_m, own_m=own_m)) for _ in range(100))
    squares = np.array([np.square(split_shares(*sample)) for sample in samples])
    of_codes, of_packings = squares.mean(axis=0)
    assert of_codes / of_packings == pytest.approx(1.0, abs=0.06)


def test_the_ratio_of_unlike_codes_grows_with_their_difference():
    ratios = [
        compare_fields(fields(np.random.default_rng(1), 16, shift_m), PAIR).ratio
        for shift_m in (0.0, 0.001, 0.003)
    ]
    assert ratios == sorted(ratios) and ratios[0] < 1.3 and ratios[-1] > 3


def test_the_split_half_value_is_the_scatter_of_halves():
    """Fields of independent values of scatter s in n packings: halves differ by s sqrt(4 / n) in each cell."""
    first, second = values(fields(np.random.default_rng(1), 64, bed_m=0.0))
    scatter_m = np.sqrt((first.var(axis=0, ddof=1) + second.var(axis=0, ddof=1)) / 2)
    size = np.linalg.norm((first.mean(axis=0) + second.mean(axis=0)) / 2)
    expected = np.linalg.norm(scatter_m * np.sqrt(4 / 64)) / size
    assert split_shares(first, second)[1] == pytest.approx(expected, rel=0.1)
    assert SPLITS >= 200


def test_the_share_is_the_norm_of_the_difference_over_that_of_the_mean():
    columns = cells()
    rows = {
        (engine, seed, 0): np.full(len(columns), value)
        for engine, value in zip(PAIR, (0.011, 0.009))
        for seed in range(6)
    }
    found = compare_fields(table(rows, columns), PAIR)
    assert found.share == pytest.approx(0.2)
    assert np.isnan(found.ratio)  # nothing scatters: there is nothing to compare it with
    assert np.isfinite(found.cells["t"]).all() and (found.cells["p"] == 2 / 2**6).all()


def test_t_is_students_over_the_packings_that_fill_the_cell():
    differences = np.random.default_rng(1).normal(size=(9, 3))
    differences[2, 1] = np.nan
    expected = stats.ttest_1samp(differences, 0.0, nan_policy="omit").statistic
    assert cell_t(differences) == pytest.approx(np.asarray(expected))


def test_cells_that_are_often_empty_are_left_out_and_rarely_empty_ones_count():
    sample = fields(np.random.default_rng(1), 8)
    often, rarely = sample.columns[0][1:], sample.columns[5][1:]
    for component in "xy":
        sample.loc[(PAIR[0], [1, 2, 3], 0), (component, *often)] = np.nan
        sample.loc[(PAIR[1], [4, 5], 0), (component, *rarely)] = np.nan
    found = compare_fields(sample, PAIR)
    assert found.left_out == 1
    assert len(found.cells) == sample.shape[1] - 2 and np.isfinite(found.cells).all(axis=None)
    both = sample[("x", *rarely)].unstack("engine").dropna()
    expected_m = (both[PAIR[0]] - both[PAIR[1]]).mean()
    assert found.cells.loc[("x", *rarely), "difference_m"] == pytest.approx(expected_m)


def test_few_packings_and_identical_runs():
    few = compare_fields(fields(np.random.default_rng(1), 5), PAIR)
    assert few.cells is None and np.isfinite(few.share)
    assert "too few" in opinion_tables.field_sentence(few)
    sample = fields(np.random.default_rng(1), 8)
    same = pd.concat({engine: sample.loc[PAIR[0]] for engine in PAIR}, names=["engine"])
    found = compare_fields(same, PAIR)
    assert (found.share, found.p, found.ratio) == (0.0, 1.0, pytest.approx(1.0))
    assert (found.cells["p"] == 1).all()
    apart = fields(np.random.default_rng(1), 8).drop([(PAIR[0], seed, 0) for seed in range(1, 9)])
    none = compare_fields(apart, PAIR)
    assert none.seeds == () and none.cells is None and np.isnan(none.share)
