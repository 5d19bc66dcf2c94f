"""Speed: what was timed, and what follows from it. Times are of an engine's stepping alone, by its own clock."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from crossdem.adapters.case import Case
from crossdem.adapters.gates import REFERENCE

from .bench_workloads import Workload


@dataclass(frozen=True)
class Timing:
    """One run of one engine on one workload."""

    workload: str
    engine: str
    round: int  # 0, 1, ...: in each, every engine runs every workload once, one after the other
    particles: int
    steps: int
    wall_s: float  # of the steps
    process_wall_s: float  # of the whole process: starting, reading and setting up included
    process_cpu_s: float
    peak_memory_bytes: int | None  # of the process; None where the engine does not say

    @property
    def ns_per_particle_step(self) -> float:
        return 1e9 * self.wall_s / (self.particles * self.steps)

    @property
    def core_share(self) -> float:
        """Of a core [0, 1], over the whole process: clearly below 1 where it had to wait for one."""
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
    """One engine on one workload."""

    workload: str
    engine: str
    step_s: float
    particles: int
    steps: int
    wall_s: Spread
    ns_per_particle_step: Spread
    ratio: Spread | None  # of times, to the native solver's in the same round; None where it has none


@dataclass(frozen=True)
class Bench:
    case: Case
    workloads: tuple[Workload, ...]
    repeats: int
    versions: dict[str, str]  # of the engines that ran
    left_out: dict[str, str]  # engine: why it did not run
    timings: tuple[Timing, ...]
    failures: dict[tuple[str, str], str]  # (workload, engine): why it has no timings

    def of(self, workload: str, engine: str) -> list[Timing]:
        """In the order of the rounds."""
        return [t for t in self.timings if (t.workload, t.engine) == (workload, engine)]

    def rows(self) -> list[Row]:
        pairs = [(workload, engine) for workload in self.workloads for engine in self.versions]
        return [
            self._row(workload, engine)
            for workload, engine in pairs
            if self.of(workload.name, engine)
        ]

    def _row(self, workload: Workload, engine: str) -> Row:
        timings = self.of(workload.name, engine)
        return Row(
            workload.name,
            engine,
            workload.case.step_s(engine),
            timings[0].particles,
            timings[0].steps,
            Spread.of([timing.wall_s for timing in timings]),
            Spread.of([timing.ns_per_particle_step for timing in timings]),
            self._ratio(workload.name, timings),
        )

    def _ratio(self, workload: str, timings: list[Timing]) -> Spread | None:
        """Round by round, as what slows a machine down lasts longer than a round's runs and cancels in their ratio."""
        native = {timing.round: timing.wall_s for timing in self.of(workload, REFERENCE)}
        ratios = [t.wall_s / native[t.round] for t in timings if t.round in native]
        return Spread.of(ratios) if ratios else None
