"""Speed in words and rows of text, and as plain data."""

from __future__ import annotations

import os
from collections import Counter
from dataclasses import asdict

from crossdem.adapters.machine import machine_facts, processor

from .bench import Bench, Row, Spread, Timing
from .runs import cores
from .wording import DASH, listed, number, plural

TITLES = ("workload", "engine", "time, s", "ns per particle-step", "× native's time")
WAITED = 0.9  # share of its cores below which a run is said to have waited for one
LONG_S = 1.0  # runs for which that can be said: a short one waits for its files, too


def rows(bench: Bench) -> list[tuple[str, ...]]:
    """Of each contender on each workload: TITLES; medians and, in brackets, quartiles of the rounds."""
    return [_row(row) for row in bench.rows()]


def workload_lines(bench: Bench) -> list[str]:
    """ "bar: 944 particles, 114,000 steps of 50.0 µs": what each engine ran."""
    said: dict[tuple[str, str], list[str]] = {}  # contenders by workload and what they ran of it
    for row in bench.rows():
        ran = f"{row.particles:,} particles, {row.steps:,} steps of {number(1e6 * row.step_s)} µs"
        said.setdefault((row.workload, ran), []).append(row.contender)
    alone = Counter(workload for workload, _ in said)
    return [
        f"{workload}: {ran}" + (f" ({listed(engines)})" if alone[workload] > 1 else "")
        for (workload, ran), engines in said.items()
    ]


def remarks(bench: Bench) -> list[str]:
    """What ran not, and what speaks against the numbers."""
    said = [f"{engine} is left out: {why}" for engine, why in bench.left_out.items()]
    said += [f"{workload}: {why}" for (workload, _), why in bench.failures.items()]
    long = [timing for timing in bench.timings if timing.process_wall_s >= LONG_S]
    if waited := sum(timing.cores < WAITED * _cores_of(bench, timing) for timing in long):
        said.append(
            f"{waited} of {plural(len(long), 'run')} had less than {100 * WAITED:.0f} % of a core, or of the cores "
            "that they had in another round: other processes ran beside them; trust the ratios, not the times"
        )
    return said


def _cores_of(bench: Bench, timing: Timing) -> int:
    """That a run like `timing` can use, by its best round: a small bed keeps fewer threads busy than it may have."""
    return max(1, round(max(other.cores for other in bench.of(timing.key))))


def machine() -> dict:
    """What the times belong to."""
    return {
        "processor": processor(),
        "cores": cores(),
        "load_average": os.getloadavg()[0],
    } | machine_facts()


def machine_line(about: dict) -> str:
    named = about["processor"] or about["machine"]
    flags = f", {' '.join(about['flags'])}" if about["flags"] else ""
    return f"{named}, {plural(about['cores'], 'core')}{flags}, {about['libc']}; on one thread where none are named"


def record(bench: Bench, about: dict) -> dict:
    """Everything, in SI but for the ns."""
    return {
        "machine": about,
        "engines": bench.versions,
        "left_out": bench.left_out,
        "failures": [
            {"workload": workload} | asdict(contender) | {"why": why}
            for (workload, contender), why in bench.failures.items()
        ],
        "repeats": bench.repeats,
        "workloads": [
            {"name": workload.name, "case_hash": workload.case.hash} for workload in bench.workloads
        ],
        "rows": [asdict(row) for row in bench.rows()],
        "timings": [asdict(timing) for timing in bench.timings],
    }


def _row(row: Row) -> tuple[str, ...]:
    return (
        row.workload,
        row.contender,
        number(row.wall_s.median),
        spread(row.ns_per_particle_step),
        spread(row.ratio) if row.ratio else DASH,
    )


def spread(found: Spread) -> str:
    """ "40.4 (40.3 to 40.6)"."""
    return f"{number(found.median)} ({number(found.low)} to {number(found.high)})"
