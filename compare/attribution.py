"""Attribution: from one scheme to another, by how much does each ingredient change what a check looks at?

Every station of the walk runs the same packings. A step's effect is the mean of the differences packing by packing,
with its 95 % interval (t distribution). On one set of packings the steps add up to the total, whatever they scatter.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import pandas as pd
from statsmodels.stats.weightstats import DescrStatsW

from crossdem.adapters.case import Case

from .checks import Check
from .ingredients import Ingredient

CONFIDENCE = 0.95
TOTAL = "total"
ROUND_OFF = 1e-9  # of a sum of differences, as a share of the largest of them


@dataclass(frozen=True)
class Station:
    """A place of the walk: the paper's scheme with all ingredients up to this one."""

    ingredient: Ingredient
    values: pd.DataFrame  # one row per seed with a result, one column per quantity
    failures: dict[int, str]  # seed: why it has none
    unrested: dict[
        int, str
    ]  # seed: what the gate on the rest says of a bed that did not come to rest

    @property
    def name(self) -> str:
        return self.ingredient.name

    @property
    def remarks(self) -> list[str]:
        """What a reader must know of its runs."""
        seeds = len(self.values) + len(self.failures)
        told = []
        if self.failures:
            first = next(iter(self.failures.values()))
            told.append(f"no result in {len(self.failures)} of {seeds}: {first}")
        if self.unrested:
            first = next(iter(self.unrested.values())).removeprefix("not comparable: ")
            told.append(f"in {len(self.unrested)} of {seeds} {first}")
        return told


@dataclass(frozen=True)
class Change:
    """What lies between two stations, for one check; on the scale of the check's kind, see `on_scale`."""

    check: Check
    name: str
    against: str | None  # the station before it, with results; None: there is none
    seeds: tuple[int, ...]  # that both stations have
    mean: float  # NaN without seeds
    interval: tuple[float, float] | None  # None for fewer than two seeds

    @property
    def clear(self) -> bool:
        """Whether the interval leaves out no change."""
        return self.interval is not None and not self.interval[0] <= 0 <= self.interval[1]


@dataclass(frozen=True)
class Endpoint:
    """One check along the whole walk."""

    check: Check
    steps: tuple[Change, ...]  # one for each station but the first
    to_scheme: Change  # from the first station to the last native one
    total: Change  # from the first station to the last

    @property
    def sum_of_steps(self) -> float:
        return math.fsum(step.mean for step in self.steps if math.isfinite(step.mean))

    @property
    def left_over(self) -> float:
        """Total less the sum of the steps: 0, but for steps that did not have all packings."""
        return self.total.mean - self.sum_of_steps

    @property
    def adds_up(self) -> bool:
        """Also where there is no total, as nothing contradicts the steps then."""
        if not math.isfinite(self.total.mean):
            return True
        largest = max((abs(step.mean) for step in self.steps), default=0.0)
        return abs(self.left_over) <= ROUND_OFF * largest


@dataclass(frozen=True)
class Attribution:
    """The whole walk."""

    case: Case
    target: str
    stations: tuple[Station, ...]
    endpoints: tuple[Endpoint, ...]

    @property
    def clear_steps(self) -> list[Change]:
        return [step for endpoint in self.endpoints for step in endpoint.steps if step.clear]


def attribute(case: Case, target: str, stations: tuple[Station, ...]) -> Attribution:
    """The walk through `stations`, of which the last is the engine `target` itself."""
    endpoints = tuple(_endpoint(check, stations) for check in Check.of_case(case.resolved))
    return Attribution(case, target, stations, endpoints)


def on_scale(check: Check, values: pd.Series, unit: float) -> pd.Series:
    """Values whose differences add up: shares of `unit` for "relative", logarithms for "ratio", else as they are."""
    if check.kind == "ratio":
        return np.log(values.where(values > 0))
    return values / unit if check.kind == "relative" else values


def _endpoint(check: Check, stations: tuple[Station, ...]) -> Endpoint:
    quantity = check.quantity.name
    columns = [station.values[quantity].astype(float) for station in stations]
    first = next((column for column in columns if len(column)), columns[0])
    unit = abs(float(first.mean())) or math.nan
    scaled = [on_scale(check, column, unit).dropna() for column in columns]

    def change(name: str, start: int | None, end: int) -> Change:
        if start is None:
            return Change(check, name, None, (), math.nan, None)
        paired = pd.concat([scaled[end], scaled[start]], axis="columns", join="inner").sort_index()
        differences = (paired.iloc[:, 0] - paired.iloc[:, 1]).to_numpy()
        statistics = DescrStatsW(differences)
        interval = None
        if len(differences) >= 2:
            interval = tuple(map(float, statistics.tconfint_mean(alpha=1 - CONFIDENCE)))
        mean = float(statistics.mean) if len(differences) else math.nan
        seeds = tuple(int(seed) for seed in paired.index)
        return Change(check, name, stations[start].name, seeds, mean, interval)

    present = [number for number, column in enumerate(scaled) if len(column)]
    steps = [
        change(station.name, max((n for n in present if n < number), default=None), number)
        for number, station in enumerate(stations)
        if number > 0
    ]
    last_native = len(stations) - 2
    origin = 0 if 0 in present else None
    return Endpoint(
        check,
        tuple(steps),
        change(stations[last_native].name, origin, last_native),
        change(TOTAL, origin, len(stations) - 1),
    )
