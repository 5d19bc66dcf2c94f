"""The theory's windows: where they come from, and on which side of them an interval lies."""

import math

import numpy as np
import pytest
from paired_tables import table

from crossdem.compare.quantities import QUANTITIES
from crossdem.compare.recorded import RECORDS, Record
from crossdem.compare.theory import INSIDE, OPEN, OUTSIDE, WINDOWS, opinions

BEARING, EXPONENT = WINDOWS
QUANTITY_NAMES = [window.quantity for window in WINDOWS]


def words(*bearing_factors, twins=1):
    rows = {
        ("native", seed, twin): [value, 1.0]
        for seed, value in enumerate(bearing_factors)
        for twin in range(twins)
    }
    bearing, exponent = opinions(table(rows, QUANTITY_NAMES), ["native"])
    assert (bearing.window, exponent.window, exponent.word) == (
        BEARING,
        EXPONENT,
        INSIDE if len(bearing_factors) > 1 else OPEN,
    )
    return bearing


def test_the_windows_are_of_quantities_and_enclose_what_their_source_says():
    assert all(window.quantity in QUANTITIES and window.low < window.high for window in WINDOWS)
    assert (BEARING.low, BEARING.high, EXPONENT.low, EXPONENT.high) == (7, 25, 0.8, 1.3)
    assert EXPONENT.low < 1 < EXPONENT.high
    n_q = [
        math.exp(math.pi * math.tan(angle)) * math.tan(math.pi / 4 + angle / 2) ** 2
        for angle in np.radians([27, 30])
    ]
    assert [round(value) for value in n_q] == [13, 18]
    assert "13 to 18" in BEARING.source and BEARING.low < n_q[0] < n_q[1] < BEARING.high
    assert n_q[0] / BEARING.low == pytest.approx(2, abs=0.2)
    assert BEARING.high / n_q[1] == pytest.approx(1.4, abs=0.1)


@pytest.mark.parametrize(
    "factor, word", [(0.5, OUTSIDE), (0.9, INSIDE), (1.0, INSIDE), (1.1, INSIDE), (2.0, OUTSIDE)]
)
def test_of_the_recorded_runs_half_and_twice_the_resistance_are_found_and_a_tenth_is_not(
    recorded, factor, word
):
    endpoints = recorded.endpoints.assign(bearing_factor=factor * recorded.endpoints.bearing_factor)
    found = opinions(endpoints, recorded.engines)
    assert {one.word for one in found if one.window == BEARING} == {word}
    assert {one.word for one in found if one.window == EXPONENT} == {INSIDE}


@pytest.fixture(scope="module")
def recorded():
    return Record.read(RECORDS / "bar_penetration" / "default").ensemble


@pytest.mark.parametrize(
    "values, word",
    [
        ((13, 14, 15), INSIDE),
        ((3, 3.1, 3.2), OUTSIDE),
        ((40, 41, 42), OUTSIDE),
        ((6, 8, 7), OPEN),
        ((24, 26, 25), OPEN),
        ((14,), OPEN),
        ((14, np.nan, 14), OPEN),
    ],
)
def test_the_whole_interval_has_to_lie_on_one_side(values, word):
    assert words(*values).word == word


def test_the_interval_is_students_90_percent_interval_over_packings_not_over_runs():
    opinion = words(10.0, 12.0, twins=4)
    half_width = 6.313751515 * 1.0  # t(0.95, 1 degree of freedom) times scatter / sqrt(2)
    assert (opinion.packings, opinion.mean) == (2, 11.0)
    assert opinion.interval == pytest.approx((11 - half_width, 11 + half_width))
