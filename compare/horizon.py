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

from crossdem import ExitCode
from crossdem.adapters.dataset import Dataset
from crossdem.adapters.packing import SHIFT_M

from . import outcomes
from .outcomes import FAILED
from .wording import metres

# Of one particle of the twin: far above the rounding of a coordinate, a billionth of a radius.
NOTICED_M = 1e-9  # drift from which on no comparison to this limit can be made
LOST_SHARE = 0.01  # of the smallest radius: the drift at the horizon
# Drifts between which growth is exponential: past the start, far from the horizon.
FIT_M = (10 * SHIFT_M, 1e-6)

COMPARED_S = 0.1  # from the packing on, each engine against the native scheme of its name
# Of the time in which the native scheme's twin is noticed: an engine's own may not be noticed before.
EARLY_SHARE = 0.5
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
    def rate_1_s(self) -> float | None:
        """Exponential rate of growth [1/s], by least squares within FIT_M; None: too few frames.

        No error goes with it: the frames of one twin are not independent of each other.
        """
        low, high = (crossing_s(self.time_s, self.drift_m, level) for level in FIT_M)
        if low is None:
            return None
        within = (self.time_s >= low) & (self.time_s <= (math.inf if high is None else high))
        within &= self.drift_m > 0
        if np.count_nonzero(within) < 3:
            return None
        line = stats.linregress(self.time_s[within], np.log(self.drift_m[within]))
        return float(line.slope)


@dataclass(frozen=True)
class Closeness:
    """An engine against the native scheme of its name, frame by frame."""

    scheme: str
    time_s: np.ndarray  # (F,)
    difference_m: np.ndarray  # (F,) the largest of any particle
    until_s: float  # the comparison counts up to here

    @property
    def frames(self) -> int:
        """How many count; the one at t = 0 is what both were given."""
        return int(np.count_nonzero((self.time_s > 0) & self._counts))

    @property
    def largest_m(self) -> float:
        return float(self.difference_m[self._counts].max())

    @property
    def beyond_s(self) -> float | None:
        """Time of the first frame beyond LIMIT_M; None: there is none."""
        beyond = self._counts & (self.difference_m > LIMIT_M)
        return float(self.time_s[np.argmax(beyond)]) if beyond.any() else None

    @property
    def _counts(self) -> np.ndarray:
        return self.time_s <= self.until_s


@dataclass(frozen=True)
class EngineHorizon:
    """What was found for one engine."""

    engine: str
    growth: Growth | None = None  # None: `obstacle` says why
    closeness: Closeness | None = None  # None: nothing to be compared with, or `obstacle`
    obstacle: str | None = None
    failed: bool = False  # the obstacle is a run that failed; else it is no fault of the engine
    scheme_growth: Growth | None = None  # of the native scheme of its name, as far as there is one

    @property
    def outcome(self) -> str | None:
        """A word of outcomes; None: it has grown, and there is nothing for it to agree with."""
        if self.failed:
            return FAILED
        if self.stray:
            return outcomes.DIFFERS
        if self.reason:
            return outcomes.NOT_COMPARABLE
        return outcomes.AGREES if self.closeness else None

    @property
    def reason(self) -> str | None:
        """Why nothing can be said of its agreement; None: something can, or it was never asked."""
        if self.obstacle or self.closeness is None or self.closeness.frames:
            return self.obstacle
        return (
            f"no frame after the packing and before {self.closeness.until_s:.2g} s, to which its native scheme's "
            f"twin limits the comparison"
        )

    @property
    def stray(self) -> str | None:
        """The sentence that names engine and time, where it differs before the horizon."""
        close = self.closeness
        if close is None:
            return None
        if close.beyond_s is not None:
            return (
                f"{self.engine} leaves the native scheme {close.scheme!r} at t = {close.beyond_s:.3g} s after the "
                f"packing, before the horizon: a particle is up to {metres(close.largest_m)} off by "
                f"{close.until_s:.3g} s, where {metres(LIMIT_M)} are allowed"
            )
        own_s, usual_s = self.growth.noticed_s, self.scheme_growth and self.scheme_growth.noticed_s
        if self.scheme_growth and usual_s is None:
            usual_s = float(self.scheme_growth.time_s[-1])  # or later
        if own_s is None or usual_s is None or own_s >= EARLY_SHARE * usual_s:
            return None
        return (
            f"{self.engine} makes {metres(NOTICED_M)} of a shift of {metres(SHIFT_M)} within {own_s:.3g} s, the native "
            f"scheme {close.scheme!r} not before {usual_s:.3g} s: it is less stable than what it is compared with"
        )


@dataclass(frozen=True)
class Horizon:
    """All engines on one packing."""

    seed: int
    recorded_s: float
    engines: tuple[EngineHorizon, ...]
    runs: tuple[
        dict, ...
    ] = ()  # provenance: RUN_FACTS of each run behind it, and its name as `run`

    @property
    def strays(self) -> list[str]:
        return [one.stray for one in self.engines if one.outcome == outcomes.DIFFERS]

    @property
    def failures(self) -> dict[tuple[str, int], str]:
        """As a comparison has them: (engine, seed): why."""
        return {(one.engine, self.seed): one.obstacle for one in self.engines if one.failed}

    @property
    def exit_code(self) -> ExitCode:
        """An engine that was not compared never counts as agreement; the native solver alone only measures."""
        if self.strays:
            return ExitCode.DIFFERS
        if self.failures:
            return ExitCode.ENGINE_FAILED
        compared = [one.outcome for one in self.engines if one.outcome or not one.growth]
        agree = all(outcome == outcomes.AGREES for outcome in compared)
        return ExitCode.AGREES if agree else ExitCode.INCONCLUSIVE


def growth(run: Dataset, twin: Dataset) -> Growth:
    lost_m = LOST_SHARE * float(run.radius_m.min())
    return Growth(run.motion.time_s, drift_m(run, twin), lost_m)


def closeness(run: Dataset, native: Dataset, scheme: str, usual: Growth) -> Closeness:
    """`run` against the `native` scheme, until that scheme's twin, of the growth `usual`, reaches NOTICED_M.

    The twin of `run` itself has no say: a fault that makes an engine unstable would end the search for it.
    """
    until_s = min(COMPARED_S, float(run.motion.time_s[-1]), usual.noticed_s or math.inf)
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
