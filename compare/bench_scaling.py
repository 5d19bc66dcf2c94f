"""How the native solver's speed and memory depend on the number of particles: static beds from 1000 on."""

from __future__ import annotations

import json
from dataclasses import dataclass
from statistics import median

from rich.console import Console

from crossdem.adapters.case import Case
from crossdem.adapters.gates import REFERENCE
from crossdem.adapters.workspace import Workspace

from .bench import Bench, Spread
from .bench_beds import bed_folder
from .bench_runs import run_bench
from .bench_workloads import Workload, static

SMALLEST, LARGEST = 1000, 1_000_000
EMPTY = 1  # particle of the run whose memory is that of the program itself


@dataclass(frozen=True)
class Size:
    """A bed of so many particles."""

    particles: int
    steps: int
    ns_per_particle_step: Spread
    bytes_per_particle: float  # peak of the process less that of a run of one particle, over the particles
    packing_s: float | None  # wall time in which its bed was settled, once; None where that is not known


def sizes_up_to(largest: int) -> list[int]:
    """Powers of ten from SMALLEST on, and `largest` itself."""
    sizes = [SMALLEST]
    while 10 * sizes[-1] < largest:
        sizes.append(10 * sizes[-1])
    return sizes if largest <= SMALLEST else [*sizes, largest]


def run_scaling(
    case: Case,
    largest: int,
    repeats: int,
    quick: bool,
    workspace: Workspace,
    console: Console,
) -> tuple[Bench, list[Size]]:
    """The timings, and what they say. Raises CaseError, SolverError where a bed cannot be made."""
    workloads = [static(particles)(case, quick) for particles in (EMPTY, *sizes_up_to(largest))]
    bench = run_bench(case, workloads, [REFERENCE], repeats, workspace, console)
    packing_s = {workload.name: _packing_s(workload, workspace) for workload in workloads}
    return bench, sizes(bench, packing_s)


def sizes(bench: Bench, packing_s: dict[str, float | None]) -> list[Size]:
    """Of the workloads that were timed, the first of which is that of one particle."""
    empty, *others = bench.rows() or [None]
    if (
        empty is None or empty.particles != EMPTY
    ):  # a run of it failed, and nothing can be taken off
        return []
    return [
        Size(
            row.particles,
            row.steps,
            row.ns_per_particle_step,
            (_peak(bench, row.workload) - _peak(bench, empty.workload)) / row.particles,
            packing_s[row.workload],
        )
        for row in others
    ]


def _peak(bench: Bench, workload: str) -> float:
    """[bytes]"""
    return median(timing.peak_memory_bytes for timing in bench.of(workload, REFERENCE))


def _packing_s(workload: Workload, workspace: Workspace) -> float | None:
    try:
        made = bed_folder(workload.bed, workspace).with_suffix(".json").read_bytes()
    except FileNotFoundError:  # killed between the bed and the note
        return None
    return json.loads(made)["wall_s"]
