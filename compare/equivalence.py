"""Two one-sided t-tests (TOST) of mean paired differences against margins, and how many pairs they need.

Plain arrays, one column per check: nothing here knows a case or an engine. A difference is one packing's: the mean over
its twins in one engine less that in the other, so that n packings are n values however many twins there are.
"""

from __future__ import annotations

import functools
from dataclasses import dataclass

import numpy as np
from scipy import stats
from statsmodels.stats.weightstats import DescrStatsW

ALPHA = 0.05  # of each one-sided test
POWER = 0.9  # of a planned statement of equivalence, when the engines do not differ
MOST_SEEDS = 1000  # looked at when planning
# Far above, boost's non-central t ends the process; the power is 1 to all digits from here on.
LARGEST_NONCENTRALITY = 30.0


@dataclass(frozen=True)
class Findings:
    """An entry per check; NaN, and p = 1, where its differences do not tell."""

    mean: np.ndarray
    low: np.ndarray  # ends of the 90 % interval of the mean
    high: np.ndarray
    scatter: np.ndarray  # standard deviation of one difference
    p_equivalent: np.ndarray  # of "the mean is at or beyond the margin", after Holm
    p_different: np.ndarray  # of "the mean is at or within the margin", after Holm


def find(differences: np.ndarray, margins: np.ndarray) -> Findings:
    """Of `differences`, a row per packing and a column per check, against `margins`, all > 0."""
    usable = np.isfinite(differences).all(axis=0)
    differences = np.where(usable, differences, np.nan)
    nothing, impossible = np.full(len(margins), np.nan), np.ones(len(margins))
    if len(differences) < 2:
        mean = differences[0] if len(differences) else nothing
        return Findings(mean, nothing, nothing, nothing, impossible, impossible)
    with np.errstate(all="ignore"):  # differences without scatter divide by it
        statistics = DescrStatsW(differences)
        low, high = statistics.tconfint_mean(alpha=2 * ALPHA)
        equivalent, _, _ = statistics.ttost_mean(-margins, margins)
        different = _beyond(differences, margins)
    mean = statistics.mean
    still = usable & (
        differences.min(axis=0) == differences.max(axis=0)
    )  # nothing is left to chance
    equivalent = np.where(still, np.abs(mean) >= margins, equivalent)
    different = np.where(still, np.abs(mean) <= margins, different)
    return Findings(
        mean,
        low,
        high,
        statistics.std_ddof(1),
        holm(np.where(usable, equivalent, 1.0)),
        holm(np.where(usable, different, 1.0)),
    )


def _beyond(differences: np.ndarray, margins: np.ndarray) -> np.ndarray:
    """p of a mean at or within the margin. Both tails count, so that it holds for a margin of nothing, too."""
    away = DescrStatsW(differences * np.where(differences.mean(axis=0) < 0, -1.0, 1.0))
    near, far = (away.ttest_mean(end, alternative="larger")[1] for end in (margins, -margins))
    return near + far


def holm(p: np.ndarray) -> np.ndarray:
    """p after Holm, for all claims of a family together.

    statsmodels' multipletests does the same, tests hold this against it; but it collects Python's garbage each time,
    20 ms, and a calibration asks 100,000 times.
    """
    order = np.argsort(p)
    adjusted = np.empty(len(p))
    adjusted[order] = np.maximum.accumulate(p[order] * np.arange(len(p), 0, -1))
    return np.minimum(adjusted, 1.0)


def levels(ease: np.ndarray) -> np.ndarray:
    """The level that Holm leaves each check of a family when they settle in order of their `ease`, margin over scatter:
    the easiest is held against ALPHA / all of them, the hardest against ALPHA.
    """
    place = np.empty(len(ease))
    place[np.argsort(-ease, kind="stable")] = np.arange(len(ease))
    return ALPHA / (len(ease) - place)


@functools.lru_cache(maxsize=4096)
def seeds_needed(
    margin: float, scatter: float, difference: float = 0.0, level: float = ALPHA
) -> int | None:
    """Fewest packings with which the test of the claim that is true has power 0.9, by the non-central t distribution:
    equivalence where the true `difference` is within the margin, difference where it is beyond.

    `scatter` is the standard deviation of one paired difference. None: more than MOST_SEEDS.
    """
    seeds = np.arange(2, MOST_SEEDS + 1)
    ends = (margin - abs(difference), margin + abs(difference))
    if scatter <= 0:
        return int(seeds[0]) if ends[0] else None
    threshold = stats.t.ppf(1 - level, seeds - 1)

    def missed(distance: float) -> np.ndarray:
        noncentrality = np.minimum(distance / scatter * np.sqrt(seeds), LARGEST_NONCENTRALITY)
        with np.errstate(all="ignore"):  # SciPy 1.10 raises floating-point flags here without cause
            return stats.nct.cdf(threshold, seeds - 1, noncentrality)

    power = 1 - missed(-ends[0]) if ends[0] < 0 else 1 - missed(ends[0]) - missed(ends[1])
    enough = power >= POWER
    return int(seeds[np.argmax(enough)]) if enough.any() else None
