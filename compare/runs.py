"""From a case to runs: packings, then every engine on each of them, with progress."""

import shutil
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

from rich.console import Console

from crossdem.adapters.case import Case
from crossdem.adapters.engines import get_engine
from crossdem.adapters.packing import Packing, make_packing
from crossdem.adapters.run import RunRequest, run_all
from crossdem.adapters.run_folder import prepare
from crossdem.adapters.solver import SolverError
from crossdem.adapters.workspace import Workspace

from .progress import ProgressDisplay


@dataclass(frozen=True)
class Runs:
    """What became of every engine on every packing."""

    folders: tuple[Path, ...]  # of the datasets, or of the inputs where only these were asked for
    failures: dict[tuple[str, int], str]  # (engine, seed): why there is none
    unsupported: frozenset[
        tuple[str, int]
    ] = frozenset()  # those of failures that no engine is to blame for


def run_engines(
    case: Case, engines: list[str], seeds: int, workspace: Workspace, jobs: int, console: Console
) -> Runs:
    with ProgressDisplay(console) as display:
        packings, unsettled = settle(case, seeds, workspace, jobs, display)
        requests = [RunRequest(case, packing, engine) for packing in packings for engine in engines]
        display.say(f"{len(requests)} runs, {jobs} at a time")
        results = run_all(
            requests,
            workspace.root,
            jobs,
            lambda request, *progress: display.update(_job(request), *progress),
        )
        if reused := sum(result.status == "reused" for result in results):
            display.say(f"{reused} of these were there already")
    failures = {(engine, seed): why for engine in engines for seed, why in unsettled.items()}
    by_run = {
        (result.request.engine_name, result.request.packing.seed): result for result in results
    }
    failures |= {run: result.failure for run, result in by_run.items() if result.failure}
    unsupported = frozenset(run for run, result in by_run.items() if result.status == "unsupported")
    folders = (result.dataset_folder for result in results)
    return Runs(tuple(folder for folder in folders if folder), failures, unsupported)


def settle(
    case: Case, seeds: int, workspace: Workspace, jobs: int, display: ProgressDisplay
) -> tuple[list[Packing], dict[int, str]]:
    """The packings of seeds 1, 2, ..., and by seed why one could not be made. Raises CaseError.

    Particles placed by hand are one packing, whatever `seeds` says.
    """

    def make(seed: int) -> Packing | SolverError:
        try:
            return make_packing(case, seed, workspace.packing_folder(case, seed))
        except SolverError as error:
            return error

    numbers = range(1, 2 if case.resolved["particle"] else seeds + 1)
    packings, unsettled = [], {}
    with ThreadPoolExecutor(jobs) as pool:  # leaving the loop early cancels what has not begun
        for seed, made in zip(numbers, pool.map(make, numbers)):
            if isinstance(made, Packing):
                packings.append(made)
            else:
                unsettled[seed] = str(made)
            display.update("packings", seed / len(numbers))
    return packings, unsettled


def write_inputs(
    case: Case, engines: list[str], seeds: int, workspace: Workspace, jobs: int, console: Console
) -> Runs:
    """Per run only a folder with all that its engine reads, and a README.txt with the command that starts it."""
    with ProgressDisplay(console) as display:
        packings, unsettled = settle(case, seeds, workspace, jobs, display)
    folders = []
    failures = {(engine, seed): why for engine in engines for seed, why in unsettled.items()}
    for packing in packings:
        for name in engines:
            engine = get_engine(name)
            if reasons := engine.unsupported(case):
                failures[name, packing.seed] = "; ".join(reasons)
                continue
            folder = workspace.root / "inputs" / f"{name}-seed{packing.seed}-{case.hash[:12]}"
            partial = folder.with_name(f".{folder.name}.partial")
            for old in (partial, folder):
                shutil.rmtree(old, ignore_errors=True)
            prepare(case, packing, engine, partial)
            partial.rename(folder)
            folders.append(folder)
    return Runs(tuple(folders), failures)


def _job(request: RunRequest) -> str:
    return f"{request.engine_name}, seed {request.packing.seed}"
