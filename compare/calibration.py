"""The judge judged: how often it is wrong about runs of which the truth is known, because one solver made them all.

Packings are drawn from a recorded ensemble, and the twins of each dealt into two halves, which pass for two codes that do
the same. A true shift put into one half makes them codes that differ by that much. The judge is the one of every
comparison: packing_means, then checks.evaluate.

Splits of the same few packings overlap: a rate over 200 of them is known less well than from 200 sets of new packings.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from functools import partial

import numpy as np
import pandas as pd
from statsmodels.stats.proportion import proportion_confint

from .checks import DIFFERENT, EQUIVALENT, Check, evaluate
from .ensemble import packing_means

HALVES = ("one half", "other half")
STATE = 20000  # of the random numbers, the year of the paper and a zero
CONFIDENCE = 0.95  # of the intervals of rates
AT_MARGIN = 1.0  # margins: where either claim is untrue by a hair, and held to equivalence.ALPHA
TRUE_SHIFT = 1.5  # margins: of the engines that must not pass for equivalent
POWER = 0.8  # share of splits that a detectable shift is found in
# [margins]; where the operating characteristic is computed.
SHIFTS = (0.5, AT_MARGIN, TRUE_SHIFT, 2.0, 3.0, 5.0)
BISECTIONS = 3  # between two of them, for the smallest detectable shift

Judge = Callable[..., list]  # as checks.evaluate


@dataclass(frozen=True)
class Design:
    """How many packings a comparison has, and how many runs each engine makes on each of them."""

    packings: int
    runs: int

    def __str__(self) -> str:
        return f"{self.packings} x {self.runs}"


@dataclass(frozen=True)
class Rate:
    """Of events among trials. The interval is Wilson's, of independent trials: of splits, which overlap, it is too narrow."""

    events: int
    trials: int

    @property
    def share(self) -> float:
        return self.events / self.trials

    @property
    def interval(self) -> tuple[float, float]:
        alpha = 1 - CONFIDENCE
        low, high = proportion_confint(self.events, self.trials, alpha, method="wilson")
        return float(low), float(high)


@dataclass(frozen=True)
class Point:
    """What the judge says of one check when the truth is `shift`."""

    shift: float  # [margins]
    equivalent: Rate
    different: Rate


@dataclass(frozen=True)
class Endpoint:
    """One check, the only one whose truth is shifted: Holm is at its strictest for DIFFERENT, at its mildest for EQUIVALENT."""

    check: Check
    mean: float  # of the quantity, over all recorded packings
    points: tuple[Point, ...]  # by shift
    detectable: float | None  # [margins] smallest shift found different in POWER of the splits; None: above all tried

    def at(self, shift: float) -> Point:
        return next(point for point in self.points if point.shift == shift)


@dataclass(frozen=True)
class Calibration:
    """Of the judge at one design."""

    design: Design
    false_different: Rate  # splits without a true shift in which any check says different
    all_equivalent: Rate  # splits without one in which every check says equivalent
    endpoints: tuple[Endpoint, ...]


@dataclass(frozen=True)
class Splits:
    """The packings' means of both halves, for each split of one design, and the direction of its true shift."""

    tables: tuple[pd.DataFrame, ...]  # packing_means
    signs: tuple[int, ...]


def dealt(runs: pd.DataFrame, design: Design, splits: int, state: int = STATE) -> Splits | None:
    """Random splits of one engine's `runs` (indexed by seed, twin); None: there are too few of them."""
    by_seed = runs.groupby(level="seed").groups
    able = sorted(seed for seed, found in by_seed.items() if len(found) >= 2 * design.runs)
    if len(able) < design.packings:
        return None
    random = np.random.default_rng([state, design.packings, design.runs])
    tables, signs = [], []
    for _ in range(splits):
        halves: dict[str, list] = {half: [] for half in HALVES}
        for seed in sorted(random.choice(able, design.packings, replace=False)):
            order = random.permutation(len(by_seed[seed]))
            for number, half in enumerate(HALVES):
                mine = order[number * design.runs : (number + 1) * design.runs]
                halves[half] += [by_seed[seed][place] for place in mine]
        table = pd.concat({half: runs.loc[rows] for half, rows in halves.items()}, names=["engine"])
        tables.append(packing_means(table))
        signs.append(int(random.choice((-1, 1))))
    return Splits(tuple(tables), tuple(signs))


def shifted(check: Check, values: np.ndarray, shift: float) -> np.ndarray:
    """`values` of an engine that truly lies `shift` above, on the scale of the check's differences."""
    if check.kind == "absolute":
        return values + shift
    if check.kind == "ratio":
        return values * math.exp(shift)
    return values * (2 + shift) / (2 - shift)  # so that difference over mean of both is `shift`


def calibrate(
    checks: Sequence[Check],
    runs: pd.DataFrame,
    design: Design,
    splits: Splits,
    pool: Executor | None = None,
    judge: Judge = evaluate,
) -> Calibration:
    """`runs` are those that the `splits` were dealt from."""
    outcomes = [
        [result.outcome for result in judge(checks, HALVES, table)] for table in splits.tables
    ]
    one = partial(_endpoint, checks, splits, [tuple(row) for row in zip(*outcomes)], judge)
    endpoints: Iterable[Endpoint] = (pool.map if pool else map)(one, range(len(checks)))
    means = packing_means(pd.concat({HALVES[0]: runs}, names=["engine"])).mean()
    return Calibration(
        design,
        _rate(any(outcome == DIFFERENT for outcome in split) for split in outcomes),
        _rate(all(outcome == EQUIVALENT for outcome in split) for split in outcomes),
        tuple(
            Endpoint(check, float(means[check.quantity.name]), *found)
            for check, found in zip(checks, endpoints)
        ),
    )


def _endpoint(
    checks: Sequence[Check], splits: Splits, unshifted: list[tuple], judge: Judge, number: int
) -> tuple[tuple[Point, ...], float | None]:
    """The operating characteristic of one check, and the smallest shift that it finds."""
    known = [{0.0: outcome} for outcome in unshifted[number]]

    def at(shift: float) -> Point:
        for table, sign, outcomes in zip(splits.tables, splits.signs, known):
            outcomes[shift] = _implied(outcomes, shift) or _outcome(
                checks, number, judge, table, sign * shift
            )
        return _point(shift, [outcomes[shift] for outcomes in known])

    points = {0.0: _point(0.0, unshifted[number])} | {shift: at(shift) for shift in SHIFTS}
    found = [shift for shift, point in points.items() if point.different.share >= POWER]
    if not found:
        return tuple(points.values()), None
    high = min(found)
    low = max((shift for shift in points if shift < high), default=None)
    for _ in range(0 if low is None else BISECTIONS):
        middle = (low + high) / 2
        points[middle] = at(middle)
        low, high = (low, middle) if points[middle].different.share >= POWER else (middle, high)
    return tuple(points[shift] for shift in sorted(points)), high


def _implied(outcomes: dict[float, str], shift: float) -> str | None:
    """What smaller and larger shifts of the same split tell of this one, without asking the judge; None: nothing.

    A growing shift only moves the interval on: from beyond the margin there is no way back, and between two equal
    outcomes there is no other.
    """
    below = max(one for one in outcomes if one < shift)
    above = min((one for one in outcomes if one > shift), default=None)
    if below >= 1 and outcomes[below] == DIFFERENT:
        return DIFFERENT
    if above is None or outcomes[above] != outcomes[below]:
        return None
    return outcomes[below] if below >= 1 or outcomes[below] == EQUIVALENT else None


def _outcome(
    checks: Sequence[Check], number: int, judge: Judge, table: pd.DataFrame, shift: float
) -> str:
    """Of check `number`, with the truth `shift` margins away."""
    check = checks[number]
    values = table.to_numpy(copy=True)
    column = table.columns.get_loc(check.quantity.name)
    other = table.index.get_level_values("engine") == HALVES[1]
    by = shift * check.on_scale(check.margin)
    values[other, column] = shifted(check, values[other, column], by)
    moved = pd.DataFrame(values, index=table.index, columns=table.columns)
    return judge(checks, HALVES, moved)[number].outcome


def _point(shift: float, outcomes: Sequence[str]) -> Point:
    return Point(
        shift,
        equivalent=_rate(outcome == EQUIVALENT for outcome in outcomes),
        different=_rate(outcome == DIFFERENT for outcome in outcomes),
    )


def _rate(events: Iterable[bool]) -> Rate:
    events = list(events)
    return Rate(sum(events), len(events))
