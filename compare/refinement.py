"""What a quantity tends to as the time step is halved, and how fast."""

from __future__ import annotations

import math
from collections.abc import Sequence

LEVELS = 3  # at dt, dt / 2 and dt / 4
ROUNDING = 1e-12  # share of a value; differences below it say nothing of an order


def extrapolated(values: Sequence[float]) -> float:
    """Richardson's limit of the values at dt, dt/2 and dt/4: that of the parabola in dt through the three.

    Errors of first and of second order both vanish from it, so that it needs no order to be known or observed.
    """
    coarse, middle, fine = values
    return (8 * fine - 6 * middle + coarse) / 3


def observed_order(values: Sequence[float], resolution: float = 0.0) -> float | None:
    """p, where the values at dt, dt/2 and dt/4 close in on their limit as dt^p; None where they do not close in.

    Differences below `resolution` do not tell.
    """
    coarse, middle, fine = values
    first, second = coarse - middle, middle - fine
    floor = max(resolution, ROUNDING * max(abs(value) for value in values))
    if abs(second) <= floor or first / second <= 1:
        return None
    return math.log2(first / second)
