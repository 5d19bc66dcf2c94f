"""From a case to runs: packings and their twins, then every engine on each of them, with progress."""

import os
import shutil
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

from rich.console import Console

from crossdem.adapters.case import Case
from crossdem.adapters.engines import get_engine
from crossdem.adapters.gates import REFERENCE
from crossdem.adapters.mpi import ranks_of
from crossdem.adapters.packing import Packing, make_packing, make_twin
from crossdem.adapters.run import RunResult
from crossdem.adapters.run_folder import RunRequest, prepare
from crossdem.adapters.solver import SolverError
from crossdem.adapters.workflow.ensemble import run_ensemble
from crossdem.adapters.workspace import Workspace

from .progress import ProgressDisplay
from .wording import plural

# How large an ensemble is: packings, and perturbed twins of each beside the packing itself.
TIERS = {"smoke": (4, 0), "nightly": (16, 2), "release": (32, 2)}
WITHOUT_TIER = (2, 0)


@dataclass(frozen=True)
class Runs:
    """What became of every engine on every packing."""

    folders: tuple[Path, ...]  # of the datasets, or of the inputs where only these were asked for
    failures: dict[tuple[str, int], str]  # (engine, seed): why there is none
    unsupported: frozenset[
        tuple[str, int]
    ] = frozenset()  # those of failures that no engine is to blame for


def run_engines(
    case: Case,
    engines: list[str],
    seeds: int,
    workspace: Workspace,
    jobs: int | None,
    console: Console,
    twins: int = 0,
    profile: str | None = None,
    ranks: int = 1,
) -> Runs:
    """Every engine on every packing and on `twins` twins of each; the folders of native runs come first.

    `jobs`, `profile`: as in run_ensemble. `ranks`: MPI processes per run, of the engines that can.
    """
    with ProgressDisplay(console) as display:
        packings, unsettled = settle(case, seeds, workspace, here(jobs, profile), display)
        started_from = [
            make_twin(packing, number, workspace.twin_folder(packing, number))
            for packing in packings
            for number in range(twins + 1)
        ]
        requests = [
            RunRequest(case, packing, engine, ranks_of(engine, ranks))
            for engine in sorted(engines, key=lambda engine: engine != REFERENCE)
            for packing in started_from
        ]
        display.say(f"{plural(len(requests), 'run')}, {where(jobs, profile)}")
        results = run_ensemble(
            [(request, workspace.root) for request in requests],
            workspace.root / "workflow",
            jobs,
            display.count,
            profile,
        )
        if reused := sum(result.status == "reused" for result in results):
            display.say(f"{reused} of these were there already")
    failures = {(engine, seed): why for engine in engines for seed, why in unsettled.items()}
    for result in results:
        if result.failure:
            failures.setdefault(_run(result), _reason(result))
    unsupported = frozenset(_run(result) for result in results if result.status == "unsupported")
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


def cores() -> int:
    """How many processes run at a time here, unless it is said otherwise."""
    return len(os.sched_getaffinity(0))


def here(jobs: int | None, profile: str | None) -> int:
    """How many processes run on this machine at a time: with a profile, `jobs` are the cluster's."""
    return cores() if profile or not jobs else jobs


def where(jobs: int | None, profile: str | None) -> str:
    """For people."""
    return f"with the profile {profile}" if profile else f"{jobs} at a time"


def _run(result: RunResult) -> tuple[str, int]:
    return result.request.engine_name, result.request.packing.seed


def _reason(result: RunResult) -> str:
    twin = result.request.packing.twin
    return f"twin {twin}: {result.failure}" if twin else result.failure
