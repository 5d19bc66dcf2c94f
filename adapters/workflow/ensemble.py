"""An ensemble of runs: what is there is taken up, what is left goes through Snakemake, and every run ends in a result."""

from __future__ import annotations

import os
import shutil
import time
from collections.abc import Callable, Sequence
from datetime import datetime, timezone
from pathlib import Path
from secrets import token_hex

from ..attempt import clear_away
from ..gates import REFERENCE
from ..one_run import Run
from ..process import Ending
from ..run import RunResult, look_up
from ..run_folder import RunRequest
from .grouping import grouped
from .plan import PlannedRun, write_plan
from .shelf import Shelf
from .snakemake import Snakemake
from .watch import Progress, Watch, outcomes

POLL_S = 0.1
PROGRESS_S = 0.5
LATENCY_S = 60.0  # until a run finished elsewhere is seen here: network file systems cache
JOURNAL = "journal"


def run_ensemble(
    requests: Sequence[tuple[RunRequest, Path]],
    folder: Path,
    jobs: int | None,
    on_progress: Callable[[Progress], None] = lambda progress: None,
    profile: str | None = None,
) -> list[RunResult]:
    """Run or reuse every request, whose dataset goes to runs/ in the folder beside it; one result each, in their order.

    `folder` is for the workflow's own files. At most `jobs` processes at a time; with a Snakemake `profile` that many
    tasks, or as many as that says for None. A run that fails is tried twice, and the others go on. Raises WorkflowError.
    """
    for out_dir in {out_dir for _, out_dir in requests}:
        (out_dir / "runs").mkdir(parents=True, exist_ok=True)
        clear_away(out_dir / "runs")
    shelf = Shelf()
    results: dict[int, RunResult] = {}
    waiting: dict[int, Run] = {}
    native_first = sorted(requests, key=lambda entry: entry[0].engine_name != REFERENCE)
    for request, out_dir in native_first:
        run, answer = look_up(request, out_dir)
        if answer:
            results[id(request)] = answer
        elif shelf.take(run):
            results[id(request)] = RunResult(request, run.folder, None, "reused")
        else:
            waiting[id(request)] = run
    if waiting:
        said = _work(waiting.values(), folder, jobs, on_progress, profile)
        deadline = time.monotonic() + LATENCY_S
        for number, run in waiting.items():
            results[number] = _result(run, shelf, said[run.name], deadline)
    shelf.close()
    return [results[id(request)] for request, _ in requests]


def _result(run: Run, shelf: Shelf, outcome: dict, deadline: float) -> RunResult:
    """What became of it, by what is there and by the `outcome` that its task told."""
    while not (there := shelf.take(run)) and not outcome["failure"]:
        if time.monotonic() > deadline:
            unseen = (
                f"{run.engine.name} was finished by its task, but {run.folder} cannot be read here as a whole run: repeat "
                "the command, which takes it up once it can"
            )
            return RunResult(run.request, None, unseen, "failed")
        time.sleep(POLL_S)
    if there:
        return RunResult(run.request, run.folder, None, "done")
    return RunResult(
        run.request, None, outcome["failure"], outcome["status"], outcome["exit_status"]
    )


def _work(
    runs: Sequence[Run],
    folder: Path,
    jobs: int | None,
    on_progress: Callable[[Progress], None],
    profile: str | None,
) -> dict[str, dict]:
    """Has Snakemake make the runs; says by their names what their tasks told of them."""
    planned = [
        PlannedRun(run.request, run.out_dir, run.name, run.key, run.engine.expected_s(run.case))
        for run in runs
    ]
    call = _new_call(folder)
    write_plan(grouped(planned, jobs or 1), folder / JOURNAL, call)
    snakemake = Snakemake(call, jobs, profile)
    try:
        ending = _wait(snakemake, Watch(planned, call), on_progress)
    finally:
        snakemake.cancel()
        for out_dir in {run.out_dir for run in planned}:
            clear_away(out_dir / "runs")
    silence = _silence(snakemake, ending)
    silent = {
        run.name: {
            "status": "failed",
            "failure": f"{run.request.engine_name} {silence}",
            "exit_status": None,
        }
        for run in planned
    }
    return silent | outcomes(call, planned)


def _wait(snakemake: Snakemake, watch: Watch, on_progress: Callable[[Progress], None]) -> Ending:
    told = 0.0
    while not (ending := snakemake.poll()):
        if time.monotonic() - told >= PROGRESS_S:
            told = time.monotonic()
            on_progress(watch.look())
        time.sleep(POLL_S)
    on_progress(watch.look())
    return ending


def _silence(snakemake: Snakemake, ending: Ending) -> str:
    return (
        f"was not run to its end: its task ended without a word, and Snakemake {ending}:\n"
        f"{snakemake.last_words()}\nsee {snakemake.log}"
    )


def _new_call(folder: Path) -> Path:
    """A folder of this call. Those of earlier ones go, and with them what a task of theirs would still run in."""
    for old in folder.glob("call-*"):
        shutil.rmtree(old, ignore_errors=True)
    now = datetime.now(timezone.utc).strftime("%Y%m%dT%H%M%S")
    call = folder / f"call-{now}-{os.getpid()}-{token_hex(2)}"
    call.mkdir(parents=True)
    return call
