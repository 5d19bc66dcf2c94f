"""Checks of pairs of engines: is the difference of a quantity within its margin?

Runs are paired by packing: both engines start from the same bed, so that how a bed happens to lie cancels in part. Only
packings are independent, so that a packing counts once, with the mean over its twins. The statement is one of
equivalence (equivalence.py); that a difference is not significant is none.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import pandas as pd
from scipy import special

from . import equivalence
from .ensemble import of_engine
from .equivalence import ALPHA, MOST_SEEDS
from .margins import Check, check_faults
from .outcomes import DIFFERENT, EQUIVALENT, INCONCLUSIVE, NOT_COMPARABLE

__all__ = [
    "ALPHA",
    "DIFFERENT",
    "EQUIVALENT",
    "INCONCLUSIVE",
    "MOST_SEEDS",
    "NOT_COMPARABLE",
    "Check",
    "CheckResult",
    "by_check",
    "check_faults",
    "evaluate",
]

# How often a check of few packings may raise an alarm at a true difference of one margin. Where runs scatter twice as
# much as the case states, which few of them hardly show, it is up to 1.8 %, and about 1 % between equal engines.
ALARM_LEVEL = 0.005
# Fewer packings only raise alarms: of so few differences nobody can tell how they scatter. From here on their interval
# decides, and no alarm.
SEEDS_FOR_INTERVAL = 5
# From here on the scatter of the differences is taken from the differences: before, its own error is beyond a quarter.
SEEDS_FOR_SCATTER = 10


@dataclass(frozen=True)
class CheckResult:
    """What a check says of one pair; differences (first engine - second) are on the scale of the check's kind."""

    check: Check
    pair: tuple[str, str]
    outcome: str
    seeds: tuple[int, ...]  # of the packings that both engines have
    means: tuple[float, float]  # of the quantity, over all packings of each engine; NaN without
    difference: float  # mean of the paired differences; NaN without pairs
    interval: tuple[
        float, float
    ] | None  # 90 %, of the mean difference; None for fewer than two pairs
    p_equivalent: float  # of a difference at or beyond the margin, after Holm over the checks of the pair
    p_different: float  # of one at or within it, likewise
    family: int  # checks of the pair
    scatter: float  # standard deviation of one run from seed to seed, as Check.scatter has it
    scatter_degrees: int  # of freedom, of the scatter
    difference_scatter: float  # that of one paired difference, for planning
    level: float  # that Holm may leave this check, for planning
    obstacles: tuple[str, ...]  # why it is not comparable

    @property
    def margin(self) -> float:
        """On the scale of the differences."""
        return self.check.on_scale(self.check.margin)

    @property
    def alarm(self) -> float | None:
        """Half width of the alarm band of few packings, on the scale of the differences; None: the interval decides.

        The standard error is that of runs on different beds, which scatter at least as much as runs on the same one.
        """
        if not 0 < len(self.seeds) < SEEDS_FOR_INTERVAL:
            return None
        errors = float(special.stdtrit(self.scatter_degrees, 1 - ALARM_LEVEL))  # Student's t
        return self.margin + errors * math.sqrt(2 / len(self.seeds)) * self.scatter

    @property
    def alarmed(self) -> bool:
        return self.alarm is not None and abs(self.difference) > self.alarm

    @property
    def within(self) -> bool:
        """Whether the interval lies inside the margin."""
        return (
            bool(self.interval)
            and -self.margin < self.interval[0] <= self.interval[1] < self.margin
        )

    @property
    def beyond(self) -> bool:
        """Whether the interval lies wholly outside the margin."""
        return bool(self.interval) and (
            self.interval[0] > self.margin or self.interval[1] < -self.margin
        )

    @property
    def seeds_needed(self) -> int | None:
        """For a statement of equivalence, if the engines are equal; None: more than MOST_SEEDS."""
        return self._planned(0.0)

    @property
    def seeds_to_settle(self) -> int | None:
        """To settle the check either way, if the difference is as measured; None: more than MOST_SEEDS."""
        return self._planned(self.difference) if math.isfinite(self.difference) else None

    def _planned(self, difference: float) -> int | None:
        needed = equivalence.seeds_needed(
            self.margin, self.difference_scatter, difference, self.level
        )
        return needed and max(needed, SEEDS_FOR_INTERVAL)


def evaluate(
    checks: Sequence[Check],
    pair: tuple[str, str],
    endpoints: pd.DataFrame,
    obstacles: Sequence[str] = (),
) -> list[CheckResult]:
    """All `checks` of one `pair`, which are one family, on `endpoints` (ensemble.packing_means).

    `obstacles` forbid a comparison; its numbers are told all the same.
    """
    if not checks:
        return []
    names = [check.quantity.name for check in checks]
    runs = [of_engine(endpoints, engine)[names] for engine in pair]
    seeds, *rows = np.intersect1d(*(one.index for one in runs), return_indices=True)
    obstacles = tuple(obstacles) or (() if len(seeds) else ("no packing that both engines ran",))
    values = [one.to_numpy(dtype=float) for one in runs]
    first, second = (one[shared].T for one, shared in zip(values, rows))
    with np.errstate(all="ignore"):  # what has no value becomes NaN, and is said
        differences = np.column_stack(
            [check.differences(a, b) for check, a, b in zip(checks, first, second)]
        )
    margins = np.array([check.on_scale(check.margin) for check in checks])
    found = equivalence.find(differences, margins)
    stated = math.sqrt(2) * np.array([check.on_scale(check.seed_scatter) for check in checks])
    measured = len(seeds) >= SEEDS_FOR_SCATTER and not obstacles
    scatters = np.where(np.isfinite(found.scatter) & measured, found.scatter, stated)
    with np.errstate(divide="ignore"):
        levels = equivalence.levels(margins / scatters)
    pooled = [
        check.scatter(*(one[:, number] for one in values)) for number, check in enumerate(checks)
    ]
    return [
        _judged(
            CheckResult(
                check=check,
                pair=pair,
                outcome=NOT_COMPARABLE,
                seeds=tuple(seeds.tolist()),
                means=tuple(_mean(one[:, number]) for one in values),
                difference=float(found.mean[number]),
                interval=None
                if len(seeds) < 2
                else (float(found.low[number]), float(found.high[number])),
                p_equivalent=float(found.p_equivalent[number]),
                p_different=float(found.p_different[number]),
                family=len(checks),
                scatter=pooled[number][0],
                scatter_degrees=pooled[number][1],
                difference_scatter=float(scatters[number]),
                level=float(levels[number]),
                obstacles=obstacles + _valueless(check, differences[:, number]),
            )
        )
        for number, check in enumerate(checks)
    ]


def by_check(results: Sequence[CheckResult]) -> dict[Check, list[CheckResult]]:
    """The results of several pairs, together by check, in their order."""
    found: dict[Check, list[CheckResult]] = {}
    for result in results:
        found.setdefault(result.check, []).append(result)
    return found


def _judged(result: CheckResult) -> CheckResult:
    return result if result.obstacles else replace(result, outcome=_outcome(result))


def _outcome(result: CheckResult) -> str:
    if result.alarmed:
        return DIFFERENT
    if result.alarm is not None:
        return INCONCLUSIVE
    if result.within and result.p_equivalent <= ALPHA:
        return EQUIVALENT
    if result.beyond and result.p_different <= ALPHA:
        return DIFFERENT
    return INCONCLUSIVE


def _mean(values: np.ndarray) -> float:
    """Over the packings that have a value."""
    values = values[~np.isnan(values)]
    return float(values.mean()) if len(values) else math.nan


def _valueless(check: Check, differences: np.ndarray) -> tuple[str, ...]:
    if np.isfinite(differences).all():
        return ()
    return (f"the {check.quantity.title} has no value, or none to compare, in some run",)
