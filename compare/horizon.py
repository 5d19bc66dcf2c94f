"""The horizon: up to when can a bed be compared particle by particle?

A bed is chaotic. A twin of the packing with one particle shifted by 1e-12 m drifts away from it exponentially, and so
does a code that only rounds otherwise. Until the twin has drifted by 1 % of a radius, a difference between two codes
that do the same steps is a fault of one of them; after it only statistics mean anything.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy import stats

from crossdem.adapters.dataset import Dataset

from .wording import metres

# Of one particle of the twin: far above the rounding of a coordinate, a billionth of a radius.
SHIFT_M = 1e-12
NOTICED_M = 1e-9  # drift from which on no comparison to this limit can be made
LOST_SHARE = 0.01  # of the smallest radius: the drift at the horizon
# Drifts between which growth is exponential: past the start, far from the horizon.
FIT_M = (10 * SHIFT_M, 1e-6)

COMPARED_S = 0.1  # from the packing on, each engine against the native scheme of its name
# Largest difference allowed there: rounding, grown by the same chaos, stays far below.
LIMIT_M = 1e-9


@dataclass(frozen=True)
class Growth:
    """How far twins drift apart: the largest distance between the two places of any particle."""

    time_s: np.ndarray  # (F,) since the packing
    drift_m: np.ndarray  # (F,)
    lost_m: float  # drift at the horizon

    @property
    def noticed_s(self) -> float | None:
        """When the drift reaches NOTICED_M; None: not within the time recorded."""
        return crossing_s(self.time_s, self.drift_m, NOTICED_M)

    @property
    def horizon_s(self) -> float | None:
        """When the drift reaches LOST_SHARE of the smallest radius; None: not within the time recorded."""
        return crossing_s(self.time_s, self.drift_m, self.lost_m)

    @property
    def rate_1_s(self) -> tuple[float, float] | None:
        """Exponential rate of growth [1/s] and its standard error, by least squares within FIT_M; None: too few frames."""
        low, high = (crossing_s(self.time_s, self.drift_m, level) for level in FIT_M)
        if low is None:
            return None
        within = (self.time_s >= low) & (self.time_s <= (math.inf if high is None else high))
        within &= self.drift_m > 0
        if np.count_nonzero(within) < 3:
            return None
        line = stats.linregress(self.time_s[within], np.log(self.drift_m[within]))
        return float(line.slope), float(line.stderr)


@dataclass(frozen=True)
class Closeness:
    """An engine against the native scheme of its name, frame by frame."""

    scheme: str
    time_s: np.ndarray  # (F,)
    difference_m: np.ndarray  # (F,) the largest of any particle
    until_s: float  # the comparison counts up to here

    @property
    def largest_m(self) -> float:
        return float(self.difference_m[self.time_s <= self.until_s].max())

    @property
    def beyond_s(self) -> float | None:
        """Time of the first frame beyond LIMIT_M; None: there is none."""
        beyond = (self.time_s <= self.until_s) & (self.difference_m > LIMIT_M)
        return float(self.time_s[np.argmax(beyond)]) if beyond.any() else None


@dataclass(frozen=True)
class EngineHorizon:
    """What was found for one engine."""

    engine: str
    growth: Growth | None = None  # None: `obstacle` says why
    closeness: Closeness | None = None  # None: no native scheme has its name, or `obstacle`
    obstacle: str | None = None
    failed: bool = False  # the obstacle is a run that failed; else it is no fault of the engine

    @property
    def stray(self) -> str | None:
        """The sentence that names engine and time, where it differs before the horizon."""
        close = self.closeness
        if close is None or close.beyond_s is None:
            return None
        return (
            f"{self.engine} leaves the native scheme {close.scheme!r} at t = {close.beyond_s:.3g} s after the "
            f"packing, before the horizon: a particle is up to {metres(close.largest_m)} off by {close.until_s:.3g} s, "
            f"where {metres(LIMIT_M)} are allowed"
        )


@dataclass(frozen=True)
class Horizon:
    """All engines on one packing."""

    seed: int
    recorded_s: float
    engines: tuple[EngineHorizon, ...]

    @property
    def strays(self) -> list[str]:
        return [one.stray for one in self.engines if one.stray]

    @property
    def failures(self) -> dict[tuple[str, int], str]:
        """As a comparison has them: (engine, seed): why."""
        return {(one.engine, self.seed): one.obstacle for one in self.engines if one.failed}


def growth(run: Dataset, twin: Dataset) -> Growth:
    lost_m = LOST_SHARE * float(run.radius_m.min())
    return Growth(run.motion.time_s, drift_m(run, twin), lost_m)


def closeness(run: Dataset, native: Dataset, scheme: str, own: Growth) -> Closeness:
    """`run` against the `native` scheme, no longer than its `own` twin stays below NOTICED_M."""
    until_s = min(COMPARED_S, float(run.motion.time_s[-1]), own.noticed_s or math.inf)
    return Closeness(scheme, run.motion.time_s, drift_m(run, native), until_s)


def drift_m(one: Dataset, other: Dataset) -> np.ndarray:
    """(F,) largest distance [m] between the places of a particle in both runs, at each frame."""
    apart = one.motion.position_m - other.motion.position_m
    return np.hypot(apart[..., 0], apart[..., 1]).max(axis=1)


def crossing_s(time_s: np.ndarray, drift_m: np.ndarray, level_m: float) -> float | None:
    """When `drift_m` first reaches `level_m`, on straight lines through the logarithms; None: never."""
    reached = np.flatnonzero(drift_m >= level_m)
    if not len(reached):
        return None
    frame = int(reached[0])
    if frame == 0 or drift_m[frame - 1] <= 0:
        return float(time_s[frame])
    ends = np.log(drift_m[frame - 1 : frame + 1])
    return float(np.interp(math.log(level_m), ends, time_s[frame - 1 : frame + 1]))
