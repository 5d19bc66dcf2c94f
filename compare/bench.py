"""Speed: what was timed, and what follows from it. Times are of an engine's stepping alone, by its own clock."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from crossdem.adapters.case import Case
from crossdem.adapters.gates import REFERENCE

from .bench_workloads import Workload


@dataclass(frozen=True)
class Contender:
    """What takes its turn in every round."""

    engine: str
    threads: int = 1  # at most so many; more than one only of the native solver

    def __str__(self) -> str:
        return f"{self.engine}, {self.threads} threads" if self.threads > 1 else self.engine


Key = tuple[str, Contender]  # with the workload's name before it


@dataclass(frozen=True)
class Timing:
    """One run of one engine on one workload."""

    workload: str
    engine: str
    threads: int  # as many as it might use at most
    round: int  # 0, 1, ...: in each, every contender runs every workload once, one after the other
    step_s: float
    particles: int
    steps: int
    wall_s: float  # of the steps
    process_wall_s: float  # of the whole process: starting, reading and setting up included
    process_cpu_s: float
    peak_memory_bytes: int | None  # of the process; None where the engine does not say

    @property
    def key(self) -> Key:
        return self.workload, Contender(self.engine, self.threads)

    @property
    def ns_per_particle_step(self) -> float:
        return 1e9 * self.wall_s / (self.particles * self.steps)

    @property
    def cores(self) -> float:
        """In use on average, over the whole process: clearly below 1 where it had to wait for one."""
        return self.process_cpu_s / self.process_wall_s


@dataclass(frozen=True)
class Spread:
    """Of the rounds: the median and the quartiles about it."""

    median: float
    low: float
    high: float

    @classmethod
    def of(cls, values: Sequence[float]) -> Spread:
        low, median, high = np.quantile(values, (0.25, 0.5, 0.75))
        return cls(float(median), float(low), float(high))


@dataclass(frozen=True)
class Row:
    """One contender on one workload."""

    workload: str
    engine: str
    threads: int
    step_s: float
    particles: int
    steps: int
    wall_s: Spread
    ns_per_particle_step: Spread
    # Of times, to the native solver's on its fewest threads in the same round; None where it has none.
    ratio: Spread | None

    @property
    def key(self) -> Key:
        return self.workload, Contender(self.engine, self.threads)

    @property
    def contender(self) -> str:
        """In words."""
        return str(self.key[1])


@dataclass(frozen=True)
class Bench:
    case: Case
    workloads: tuple[Workload, ...]
    repeats: int
    versions: dict[str, str]  # of the engines that ran
    left_out: dict[str, str]  # engine: why it did not run
    timings: tuple[Timing, ...]
    failures: dict[Key, str]  # why it has no timings

    def of(self, key: Key) -> list[Timing]:
        """In the order of the rounds."""
        return [timing for timing in self.timings if timing.key == key]

    def rows(self) -> list[Row]:
        return [self._row(key) for key in dict.fromkeys(timing.key for timing in self.timings)]

    def _row(self, key: Key) -> Row:
        timings = self.of(key)
        first = timings[0]
        return Row(
            first.workload,
            first.engine,
            first.threads,
            first.step_s,
            first.particles,
            first.steps,
            Spread.of([timing.wall_s for timing in timings]),
            Spread.of([timing.ns_per_particle_step for timing in timings]),
            Spread.of(ratios) if (ratios := self.ratios(key)) else None,
        )

    def ratios(self, key: Key) -> list[float]:
        """Round by round, as what slows a machine down lasts longer than a round's runs and cancels in their ratio."""
        native = [t for t in self.timings if (t.workload, t.engine) == (key[0], REFERENCE)]
        fewest = min((timing.threads for timing in native), default=None)
        reference = {t.round: t.wall_s for t in native if t.threads == fewest}
        return [t.wall_s / reference[t.round] for t in self.of(key) if t.round in reference]
