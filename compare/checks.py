"""Checks of pairs of engines: is the difference of a quantity within its margin?

Runs are paired by seed: both engines start from the same packing, so that how a bed happens to lie cancels in part.
The statement is one of equivalence: two one-sided t-tests (TOST) at 5 % each, which is the same as asking whether the
90 % interval of the mean paired difference lies within the margin.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import pandas as pd
from scipy import stats
from statsmodels.stats.weightstats import DescrStatsW

from .quantities import QUANTITIES, Quantity, check_tables

AGREES = "agrees"
DIFFERS = "differs"
INCONCLUSIVE = "inconclusive"
NOT_COMPARABLE = "not comparable"

ALPHA = 0.05  # of each one-sided test
POWER = 0.9  # of a planned statement of equivalence, when the engines do not differ
# A mean difference beyond this many seed-to-seed standard deviations needs no more seeds.
ALARM_SCATTERS = 4
# An interval beyond the margin counts as a difference from this many seeds on. The interval of so few differences is a
# poor one: 8 checks of 3 equal engines would raise a false alarm in 1 of 5 comparisons at 2 seeds, 1 of 50 at 5.
SEEDS_FOR_INTERVAL = 5
# From here on the scatter of the differences is taken from the differences: before, its own error is beyond a quarter.
SEEDS_FOR_SCATTER = 10
MOST_SEEDS = 1000  # looked at when planning
# Far above, boost's non-central t ends the process; the power is 1 to all digits from here on.
LARGEST_NONCENTRALITY = 30.0


@dataclass(frozen=True)
class Check:
    """One [[check]] table of the case.

    kind "relative": difference over the mean of both engines' means; "absolute": in the quantity's unit; "ratio": the
    quotient, for which margin and seed_scatter are factors above 1 (1.33: within 1/1.33 .. 1.33).
    """

    quantity: Quantity
    kind: str
    margin: float
    seed_scatter: float  # standard deviation from seed to seed of one run
    reason: str

    @staticmethod
    def of_case(case: dict) -> list[Check]:
        """The checks of a resolved case without faults."""
        return [
            Check(**{**entry, "quantity": QUANTITIES[entry["quantity"]]})
            for entry in case.get("check", [])
        ]

    def on_scale(self, value: float) -> float:
        """A margin or scatter on the scale of the differences: the logarithm for quotients."""
        return math.log(value) if self.kind == "ratio" else value

    def scatter(self, endpoints: pd.DataFrame, pair: tuple[str, str]) -> float:
        """Standard deviation of one run from seed to seed, on the scale of the differences.

        The one stated, or that of the calmer engine of `pair` where it is larger: what the case states was measured on
        the case as it stands, and a variant of it may scatter more. One engine that scatters wildly is no excuse.
        """
        measured = [
            self._scatter_of(_runs_of(endpoints, engine, self.quantity.name)) for engine in pair
        ]
        return max(self.on_scale(self.seed_scatter), min(measured))

    def _scatter_of(self, values: pd.Series) -> float:
        """That of one engine's runs; 0 where they do not tell."""
        if self.kind == "ratio":
            values = np.log(values.where(values > 0))
        unit = abs(values.mean()) if self.kind == "relative" else 1.0
        scatter = float(values.std(ddof=1)) / unit if unit > 0 else math.nan
        return scatter if math.isfinite(scatter) else 0.0

    def differences(self, a: pd.Series, b: pd.Series) -> pd.Series:
        """Paired differences a - b, on the scale of the kind; NaN or infinite where it has no meaning."""
        if self.kind == "absolute":
            return a - b
        if self.kind == "ratio":
            return np.log(a.where(a > 0)) - np.log(b.where(b > 0))
        mean = abs(a.mean() + b.mean()) / 2
        return (a - b) / (mean if mean > 0 else math.nan)


@dataclass(frozen=True)
class CheckResult:
    """What a check says of one pair; differences (first engine - second) are on the scale of the check's kind."""

    check: Check
    pair: tuple[str, str]
    outcome: str
    seeds: tuple[int, ...]  # that both engines have
    means: tuple[float, float]  # of the quantity, for each engine; NaN without runs
    difference: float  # mean of the paired differences; NaN without pairs
    interval: tuple[
        float, float
    ] | None  # 90 %, of the mean difference; None for fewer than two pairs
    scatter: float  # standard deviation of one run from seed to seed, as Check.scatter has it
    seeds_needed: int | None  # for a statement of equivalence; None: more than MOST_SEEDS
    obstacles: tuple[str, ...]  # why it is not comparable

    @property
    def alarm(self) -> float:
        """Half width of the alarm band, on the scale of the differences."""
        return ALARM_SCATTERS * self.scatter

    @property
    def alarmed(self) -> bool:
        return abs(self.difference) > self.alarm


def check_faults(case: dict) -> list[str]:
    """A fault line for each factor of a ratio check that is not above 1, which the units of the schema cannot see."""
    return [
        f"check[{number}].{key}: {entry[key]:g} is not a factor above 1, as kind 'ratio' needs"
        for number, entry in check_tables(case)
        if entry.get("kind") == "ratio"
        for key in ("margin", "seed_scatter")
        if isinstance(entry.get(key), (int, float)) and 0 < entry[key] <= 1
    ]


def seeds_needed(margin: float, difference_scatter: float) -> int | None:
    """Fewest seeds for which TOST finds two equal engines equivalent with power 0.9, by the non-central t distribution.

    `difference_scatter` is the standard deviation of one paired difference. None: more than MOST_SEEDS.
    """
    seeds = np.arange(2, MOST_SEEDS + 1)
    if difference_scatter <= 0:
        return int(seeds[0])
    noncentrality = np.minimum(margin / difference_scatter * np.sqrt(seeds), LARGEST_NONCENTRALITY)
    threshold = stats.t.ppf(1 - ALPHA, seeds - 1)
    with np.errstate(all="ignore"):  # SciPy 1.10 raises floating-point flags here without cause
        power = 1 - 2 * stats.nct.cdf(threshold, seeds - 1, noncentrality)
    enough = power >= POWER
    return int(seeds[np.argmax(enough)]) if enough.any() else None


def evaluate(
    check: Check, pair: tuple[str, str], endpoints: pd.DataFrame, obstacles: tuple[str, ...] = ()
) -> CheckResult:
    """Evaluate `check` on the runs of `pair` in `endpoints` (quantities.endpoints); `obstacles` forbid a comparison."""
    runs = [_runs_of(endpoints, engine, check.quantity.name) for engine in pair]
    paired = pd.concat(runs, axis="columns", join="inner", keys=pair).sort_index()
    differences = check.differences(paired[pair[0]], paired[pair[1]]).to_numpy(dtype=float)
    if len(differences) == 0 and not obstacles:
        obstacles = ("no seed that both engines ran",)
    elif not np.isfinite(differences).all():
        obstacles += (f"the {check.quantity.title} has no value, or none to compare, in some run",)

    statistics = DescrStatsW(differences) if len(differences) else None
    interval = None
    if len(differences) >= 2:
        interval = tuple(float(end) for end in statistics.tconfint_mean(alpha=2 * ALPHA))
    measured = len(differences) >= SEEDS_FOR_SCATTER and not obstacles
    difference_scatter = (
        statistics.std_ddof(1) if measured else math.sqrt(2) * check.on_scale(check.seed_scatter)
    )
    result = CheckResult(
        check=check,
        pair=pair,
        outcome=NOT_COMPARABLE,
        seeds=tuple(int(seed) for seed in paired.index),
        means=tuple(float(values.mean()) for values in runs),
        difference=float(statistics.mean) if statistics else math.nan,
        interval=interval,
        scatter=check.scatter(endpoints, pair),
        seeds_needed=seeds_needed(check.on_scale(check.margin), float(difference_scatter)),
        obstacles=obstacles,
    )
    return result if obstacles else _judged(result)


def _judged(result: CheckResult) -> CheckResult:
    return CheckResult(**{**vars(result), "outcome": _outcome(result)})


def _outcome(result: CheckResult) -> str:
    margin = result.check.on_scale(result.check.margin)
    if result.alarmed:
        return DIFFERS
    if result.interval is None:
        return INCONCLUSIVE
    low, high = result.interval
    if len(result.seeds) >= SEEDS_FOR_INTERVAL and (low > margin or high < -margin):
        return DIFFERS
    return AGREES if -margin < low and high < margin else INCONCLUSIVE


def _runs_of(endpoints: pd.DataFrame, engine: str, quantity: str) -> pd.Series:
    """The values by seed; empty for an engine without runs."""
    return endpoints.loc[endpoints.index.get_level_values("engine") == engine, quantity].droplevel(
        "engine"
    )
