"""Each code against the mean of all others, by the checks' own statistics: which of several codes stands apart.

No code is the truth, nor is their mean: a code that stands apart may be the only one that is right. Where two codes share
a mistake, the third stands apart. One of n codes that is off moves the mean of the others of each other code, too, by
1 / (n - 1) of its distance: all may differ from the others, and the one furthest from them stands apart.
"""

from __future__ import annotations

from collections.abc import Sequence

import pandas as pd

from .checks import DIFFERENT, CheckResult, evaluate
from .margins import Check
from .pairing import shared_means

OTHERS = "the others"
FEWEST_ENGINES = 3  # with two, the others are the other one: the pair's own checks


def leave_one_out(
    checks: Sequence[Check],
    endpoints: pd.DataFrame,
    engines: Sequence[str],
    obstacles: Sequence[str] = (),
) -> list[CheckResult]:
    """All `checks` of each engine against the mean of the others, on the (seed, twin) that all of them ran.

    `endpoints` are those of an ensemble; `obstacles` of one engine forbid all comparisons, as it is among the others of
    each. Nothing for fewer than three engines.
    """
    if len(engines) < FEWEST_ENGINES or not checks:
        return []
    means = shared_means(endpoints, engines)
    results = []
    for engine in engines:
        others = sum(means[other] for other in engines if other != engine) / (len(engines) - 1)
        both = pd.concat({engine: means[engine], OTHERS: others}, names=["engine"])
        results += evaluate(checks, (engine, OTHERS), both, obstacles)
    return results


def apart(results: Sequence[CheckResult]) -> str | None:
    """Of one check, the engine that stands apart: the furthest from its others; None where no engine is DIFFERENT."""
    if DIFFERENT not in {result.outcome for result in results}:
        return None
    return max(results, key=lambda result: abs(result.difference)).pair[0]
