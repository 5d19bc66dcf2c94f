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
from crossdem.adapters.gates import REST

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
    failed_gates: dict[str, dict[int, str]]  # gate: seed: what it says of a run that it refuses
    unsupported: frozenset[int] = frozenset()  # those of failures that no engine is to blame for
    manifests: tuple[dict, ...] = ()  # of the runs with a result

    @property
    def name(self) -> str:
        return self.ingredient.name

    @property
    def seeds(self) -> frozenset[int]:
        """All that it was run on."""
        return frozenset(self.values.index) | frozenset(self.failures)

    @property
    def unrested(self) -> frozenset[int]:
        """Seeds of the beds that did not come to rest."""
        return frozenset(self.failed_gates.get(REST, {}))


@dataclass(frozen=True)
class Change:
    """What lies between two stations, for one check; on the scale of the check's kind, see `on_scale`."""

    check: Check
    name: str
    against: str | None  # the last station before it with results; None: there is none
    over: tuple[str, ...]  # stations between the two, without results: this change is theirs, too
    seeds: tuple[int, ...]  # that both stations have
    mean: float  # NaN without seeds
    interval: tuple[float, float] | None  # None for fewer than two seeds
    nothing: bool  # every difference is 0, to the last bit
    restless: bool  # some bed of the two stations did not come to rest: its energy is in the change

    @property
    def leaves_out_zero(self) -> bool:
        return self.interval is not None and not self.interval[0] <= 0 <= self.interval[1]

    @property
    def clear(self) -> bool:
        """Whether the interval leaves out no change, on beds that rest."""
        return self.leaves_out_zero and not self.restless

    @property
    def telling(self) -> bool:
        """Whether it has an interval that chance decides about, on beds that rest."""
        return self.interval is not None and not self.nothing and not self.restless


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
    def steps(self) -> list[Change]:
        """Of all quantities."""
        return [step for endpoint in self.endpoints for step in endpoint.steps]

    @property
    def clear_steps(self) -> list[Change]:
        return [step for step in self.steps if step.clear]

    @property
    def last_steps(self) -> list[Change]:
        """From the native scheme to the engine itself, where there is a result."""
        return [one.steps[-1] for one in self.endpoints if math.isfinite(one.steps[-1].mean)]

    @property
    def same_packings(self) -> bool:
        """Whether every step was taken on every packing of the first station."""
        return all(frozenset(step.seeds) == self.stations[0].seeds for step in self.steps)

    @property
    def has_total(self) -> bool:
        return any(math.isfinite(endpoint.total.mean) for endpoint in self.endpoints)

    @property
    def engine_failed(self) -> bool:
        """Whether a run failed that the total, or what the engine itself adds, would have needed."""
        ends = (self.stations[0], *self.stations[-2:])
        return any(set(station.failures) - station.unsupported for station in ends)


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
    unit = abs(float(columns[0].mean())) or math.nan  # NaN where the first station has no result
    scaled = [on_scale(check, column, unit).dropna() for column in columns]

    def change(name: str, start: int | None, end: int, over: tuple[str, ...] = ()) -> Change:
        if start is None:
            return Change(check, name, None, over, (), math.nan, None, False, False)
        paired = pd.concat([scaled[end], scaled[start]], axis="columns", join="inner").sort_index()
        differences = (paired.iloc[:, 0] - paired.iloc[:, 1]).to_numpy()
        seeds = tuple(int(seed) for seed in paired.index)
        interval = None
        if len(seeds) >= 2:
            statistics = DescrStatsW(differences)
            interval = tuple(map(float, statistics.tconfint_mean(alpha=1 - CONFIDENCE)))
        return Change(
            check=check,
            name=name,
            against=stations[start].name,
            over=over,
            seeds=seeds,
            mean=float(differences.mean()) if seeds else math.nan,
            interval=interval,
            nothing=bool(seeds) and not differences.any(),
            restless=not (stations[start].unrested | stations[end].unrested).isdisjoint(seeds),
        )

    present = [number for number, column in enumerate(scaled) if len(column)]
    steps = []
    for number in range(1, len(stations)):
        start = max((n for n in present if n < number), default=None)
        skipped = stations[number if start is None else start + 1 : number]
        over = tuple(station.name for station in skipped) if number in present else ()
        steps.append(change(stations[number].name, start, number, over))
    last_native = len(stations) - 2
    origin = 0 if 0 in present else None
    return Endpoint(
        check,
        tuple(steps),
        change(stations[last_native].name, origin, last_native),
        change(TOTAL, origin, len(stations) - 1),
    )
