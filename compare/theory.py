"""What theory expects of the resistance, whatever the codes say: an opinion beside the verdict, no part of it.

All codes may agree and all be wrong alike. A window is wide, as theory is about soil under a footing and not about a bar
two particles wide. Of the recorded runs that of the bearing factor finds a resistance half or twice as large, and only just;
a difference of 10 % it does not. The exponent tells nothing of size.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd
from statsmodels.stats.weightstats import DescrStatsW

from .ensemble import packing_means

INSIDE, OUTSIDE, OPEN = "inside", "outside", "open"
ALPHA = 0.10  # of the interval, two-sided, as that of the checks


@dataclass(frozen=True)
class Window:
    """What theory expects of a quantity (quantities.py), and why."""

    quantity: str
    low: float
    high: float
    source: str


WINDOWS = (
    Window(
        "bearing_factor",
        7.0,
        25.0,
        "Bearing capacity: the pressure under a deep strip footing grows with depth as N_q times the unit weight, and N_q "
        "is 13 to 18 at the angle of friction of such discs, 27 to 30\N{DEGREE SIGN} (Prandtl and Reissner). From half the one to 1.4 "
        "times the other: the theory knows neither the shaft nor a bar as narrow as two discs.",
    ),
    Window(
        "resistance_exponent",
        0.8,
        1.3,
        "A bed without cohesion has no length or stress of its own but its depth: the resistance grows in proportion to "
        "it. Less than 1 where walls carry weight, more where the shaft takes part.",
    ),
)
HOLDS = (
    "The windows hold for a level bed without cohesion, at rest under its weight, of discs with a friction near 0.75, and "
    "a slow bar far from all walls. Elsewhere, such as for smooth discs, they say nothing."
)


@dataclass(frozen=True)
class Opinion:
    """What a window says of one engine."""

    window: Window
    engine: str
    packings: int
    mean: float  # over the packings; NaN where some run has no value
    interval: tuple[float, float] | None  # 90 %, of the mean; None: too few packings, or no value
    word: str  # INSIDE or OUTSIDE: the whole interval; OPEN: else


def opinions(endpoints: pd.DataFrame, engines: Sequence[str]) -> list[Opinion]:
    """Of each window and engine; `endpoints` are those of an ensemble."""
    means = packing_means(endpoints)
    return [
        _opinion(window, engine, means.loc[[engine], window.quantity].to_numpy(dtype=float))
        for window in WINDOWS
        for engine in engines
    ]


def _opinion(window: Window, engine: str, values: np.ndarray) -> Opinion:
    mean, interval = float(values.mean()), None
    if len(values) > 1 and np.isfinite(mean):
        interval = tuple(float(end) for end in DescrStatsW(values).tconfint_mean(alpha=ALPHA))
    return Opinion(window, engine, len(values), mean, interval, _word(window, interval))


def _word(window: Window, interval: tuple[float, float] | None) -> str:
    if interval is None:
        return OPEN
    low, high = interval
    if window.low <= low and high <= window.high:
        return INSIDE
    return OUTSIDE if high < window.low or low > window.high else OPEN
