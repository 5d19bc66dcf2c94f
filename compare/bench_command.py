"""`crossdem bench`: what it runs, and what it ends with."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from rich.console import Console

from crossdem import ExitCode
from crossdem.adapters.case import Case
from crossdem.adapters.engines import DEFAULT_ENGINES
from crossdem.adapters.gates import REFERENCE
from crossdem.adapters.workspace import Workspace

from .bench import Contender
from .bench_clocks import CLOCKS
from .bench_report import print_bench, write_bench
from .bench_runs import run_bench
from .bench_scaling import run_scaling
from .bench_scaling_report import print_scaling, write_scaling
from .bench_tables import machine
from .bench_workloads import WORKLOADS


def bench_engines(
    case: Case,
    names: Sequence[str],
    engines: Sequence[str] | None,
    threads: Sequence[int],
    repeats: int,
    quick: bool,
    workspace: Workspace,
    json_file: Path | None,
) -> ExitCode:
    about = machine()  # its load, before there is ours
    workloads = [WORKLOADS[name](case, quick) for name in names]
    contenders = [
        Contender(engine, count)
        for engine in engines or CLOCKS
        for count in (threads if engine == REFERENCE else (1,))
    ]
    bench = run_bench(case, workloads, contenders, repeats, workspace, Console())
    write_bench(bench, workspace.root, json_file, about)
    print_bench(bench, workspace.root, about)
    missing = bench.left_out.keys() & set(engines or DEFAULT_ENGINES)  # others are extras
    return ExitCode.ENGINE_FAILED if missing or bench.failures else ExitCode.AGREES


def bench_scaling(
    case: Case,
    largest: int,
    threads: Sequence[int],
    repeats: int,
    quick: bool,
    workspace: Workspace,
    json_file: Path | None,
) -> ExitCode:
    about = machine()
    bench, sizes = run_scaling(case, largest, threads, repeats, quick, workspace, Console())
    write_scaling(bench, sizes, workspace.root, json_file, about)
    print_scaling(bench, sizes, workspace.root, about)
    return ExitCode.ENGINE_FAILED if bench.left_out or bench.failures else ExitCode.AGREES
