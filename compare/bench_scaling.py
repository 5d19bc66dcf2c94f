"""How the native solver's speed and memory depend on particles and threads: static beds from 1000 particles on."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from statistics import median

from rich.console import Console

from crossdem.adapters.case import Case
from crossdem.adapters.gates import REFERENCE
from crossdem.adapters.workspace import Workspace

from .bench import Bench, Contender, Row, Spread
from .bench_beds import Settling, settling
from .bench_runs import run_bench
from .bench_workloads import static

SMALLEST, LARGEST = 1000, 1_000_000
EMPTY = 1  # particle of the run whose memory is that of the program itself
PARTICLE_STEPS = 300_000_000  # of a bed: a few seconds at 10 ns


@dataclass(frozen=True)
class Speed:
    """Of a bed, on at most so many threads."""

    threads: int
    ns_per_particle_step: Spread
    speed_up: Spread  # over the fewest threads, within each round


@dataclass(frozen=True)
class Size:
    """A bed of so many particles."""

    particles: int
    steps: int
    speeds: tuple[Speed, ...]  # in ascending order of the threads
    bytes_per_particle: float  # on the fewest threads: peak of the process less that of one particle's, over the particles
    settling: Settling | None  # None where another build of the solver made its bed


def sizes_up_to(largest: int) -> list[int]:
    """Powers of ten from SMALLEST on, and `largest` itself."""
    sizes = [SMALLEST]
    while 10 * sizes[-1] < largest:
        sizes.append(10 * sizes[-1])
    return sizes if largest <= SMALLEST else [*sizes, largest]


def run_scaling(
    case: Case,
    largest: int,
    threads: Sequence[int],
    repeats: int,
    quick: bool,
    workspace: Workspace,
    console: Console,
) -> tuple[Bench, list[Size]]:
    """The timings, and what they say. Raises CaseError, SolverError where a bed cannot be made."""
    workloads = [
        static(particles, PARTICLE_STEPS)(case, quick)
        for particles in (EMPTY, *sizes_up_to(largest))
    ]
    contenders = [Contender(REFERENCE, count) for count in sorted(threads)]
    bench = run_bench(case, workloads, contenders, repeats, workspace, console)
    settled = {workload.name: settling(workload.bed, workspace) for workload in workloads}
    return bench, sizes(bench, settled)


def sizes(bench: Bench, settled: dict[str, Settling | None]) -> list[Size]:
    """Of the workloads that were timed on every number of threads; the first is that of one particle."""
    rows: dict[str, list[Row]] = {}
    for row in bench.rows():
        rows.setdefault(row.workload, []).append(row)
    first, *others = rows.values() or [[]]
    if not first or first[0].particles != EMPTY:  # a run of it failed: nothing can be taken off
        return []
    empty = _peak(bench, first[0])
    return [
        Size(
            of_bed[0].particles,
            of_bed[0].steps,
            tuple(_speed(bench, on_threads) for on_threads in of_bed),
            (_peak(bench, of_bed[0]) - empty) / of_bed[0].particles,
            settled[of_bed[0].workload],
        )
        for of_bed in others
        if len(of_bed) == len(first)
    ]


def _speed(bench: Bench, row: Row) -> Speed:
    speed_up = Spread.of([1 / ratio for ratio in bench.ratios(row.key)])
    return Speed(row.threads, row.ns_per_particle_step, speed_up)


def _peak(bench: Bench, row: Row) -> float:
    """[bytes]"""
    return median(timing.peak_memory_bytes for timing in bench.of(row.key))
