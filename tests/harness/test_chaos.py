"""The scatter of beds and that of chaos, told apart."""

import numpy as np
import pandas as pd
import pytest

from crossdem.compare.chaos import scatter


def runs(*beds):
    rows = {(seed, twin): v for seed, bed in enumerate(beds, 1) for twin, v in enumerate(bed)}
    index = pd.MultiIndex.from_tuples(rows, names=["seed", "twin"])
    return pd.Series(list(rows.values()), index=index, dtype=float)


def test_a_worked_example():
    """Means 1, 3, 5: 8 between beds; 2 within; expected mean square of beds = within + 2 x between."""
    found = scatter(runs([0, 2], [2, 4], [4, 6]))
    assert found.within**2 == pytest.approx(2)
    assert found.between**2 == pytest.approx((8 - 2) / 2)
    assert found.share_of_beds == pytest.approx(3 / 5)


def test_beds_that_scatter_less_than_chaos_explains_scatter_nothing_of_their_own():
    found = scatter(runs([0, 10], [1, 9], [2, 8.5]))
    assert found.between == 0 and found.share_of_beds == 0


def test_twins_that_do_not_part_leave_all_to_the_beds():
    found = scatter(runs([1, 1], [2, 2], [3, 3]))
    assert (found.between, found.within, found.share_of_beds) == (1, 0, 1)


def test_without_twins_on_two_beds_or_with_a_missing_value_it_does_not_say():
    assert scatter(runs([1], [2], [3])) is None
    assert scatter(runs([1, 2], [3])) is None
    assert scatter(runs([1, np.nan], [2, 3])) is None


def test_unequal_numbers_of_twins_are_made_up_for():
    rng = np.random.default_rng(1)
    beds = [rng.normal(bed, 1.0, size) for bed, size in zip(rng.normal(0, 2, 400), [2, 5] * 200)]
    found = scatter(runs(*beds))
    assert found.between == pytest.approx(2, rel=0.1) and found.within == pytest.approx(1, rel=0.1)
