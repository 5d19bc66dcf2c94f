"""The only place that starts engines: all the runs asked for, each to a dataset or to a reason why not."""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from . import mpi
from .attempt import clear_away
from .dataset import Dataset
from .engine import Declined, EngineFailure, EngineNotFound
from .engines import get_engine
from .gates import REFERENCE, with_gates
from .one_run import Limits, Run
from .process import wait_for_any
from .run_folder import RunRequest, run_key

POLL_S = 0.1
PROGRESS_S = 0.5


@dataclass(frozen=True)
class RunResult:
    """What became of a request."""

    request: RunRequest
    dataset_folder: Path | None
    failure: str | None  # why there is no dataset
    status: str  # done, reused, failed, missing, unsupported
    exit_status: int | None = None  # of the process, where it ended by itself in this call


# Called about twice a second for every run in progress: the request, the share done, the seconds left if known.
Progress = Callable[[RunRequest, float, float | None], None]


def run_all(
    requests: Sequence[RunRequest],
    out_dir: Path,
    jobs: int,
    on_progress: Progress = lambda request, share, seconds_left: None,
    limits: Limits = Limits(),
    journal: Path | None = None,
) -> list[RunResult]:
    """Run or reuse every request, at most `jobs` at a time; one result per request, in their order.

    Datasets go to `out_dir`/runs. A run that fails leaves what it had in `out_dir`/failed, and the others go on.
    Whatever ends this function early, such as Ctrl-C, ends the processes too. Each attempt at a run leaves its story
    in `journal`, a folder.
    """
    out_dir = Path(out_dir)
    (out_dir / "runs").mkdir(parents=True, exist_ok=True)
    clear_away(out_dir / "runs")
    queue = _Queue(out_dir, jobs, on_progress, limits, journal)
    try:
        for request in requests:
            queue.admit(request)
        queue.work()
    finally:
        queue.stop()
    return [queue.results[id(request)] for request in requests]


def look_up(
    request: RunRequest, out_dir: Path, journal: Path | None = None
) -> tuple[Run | None, RunResult | None]:
    """The run that is to be made or reused; or why there can be none."""
    engine = get_engine(request.engine_name)
    if reasons := engine.unsupported(request.case):
        why = f"{engine.name}: {'; '.join(reasons)}"
        return None, RunResult(request, None, why, "unsupported")
    try:
        key = run_key(request.case, request.packing, engine, request.ranks)
        if request.ranks > 1:
            mpi.check(os.environ.get("PATH"))
    except EngineNotFound as error:
        return None, RunResult(request, None, str(error), "missing")
    return Run(request, engine, key, out_dir, journal), None


class _Queue:
    def __init__(
        self,
        out_dir: Path,
        jobs: int,
        on_progress: Progress,
        limits: Limits,
        journal: Path | None,
    ):
        self._out_dir = out_dir
        self._journal = journal
        self._jobs = jobs
        self._on_progress = on_progress
        self._limits = limits
        self._waiting: list[Run] = []
        self._running: list[Run] = []
        self.results: dict[int, RunResult] = {}

    def admit(self, request: RunRequest) -> None:
        """Answer what needs no process, and queue the rest."""
        run, answer = look_up(request, self._out_dir, self._journal)
        if answer:
            self.results[id(request)] = answer
        elif run.finished():
            self._finish(run, "reused")
        else:
            self._waiting.append(run)

    def work(self) -> None:
        # The native runs first, as they are short and the others are compared with them; then the longest.
        self._waiting.sort(
            key=lambda run: (run.engine.name != REFERENCE, -run.engine.expected_s(run.case))
        )
        told = 0.0
        while self._waiting or self._running:
            self._start()
            self._poll()
            if time.monotonic() - told >= PROGRESS_S:
                told = time.monotonic()
                for run in self._running:
                    self._on_progress(run.request, *run.progress())
            wait_for_any([run.process for run in self._running], POLL_S)

    def stop(self) -> None:
        for run in self._running:
            run.stop()

    def _start(self) -> None:
        while self._waiting and len(self._running) < self._jobs:
            run = self._waiting.pop(0)
            self._running.append(run)
            try:
                run.start()
            except (EngineNotFound, OSError) as error:
                self._running.remove(run)
                self._fail(run, f"could not be started: {error}")

    def _poll(self) -> None:
        for run in list(self._running):
            try:
                if not run.poll(self._limits):
                    continue
                dataset = run.read()
            except Declined as why:
                self._running.remove(run)
                run.stop()
                reason = f"{run.engine.name}: {why}"
                self._answer(run.request, "unsupported", failure=reason)
            except (EngineFailure, OSError) as failure:
                self._running.remove(run)
                self._fail(run, str(failure))
            else:
                self._running.remove(run)
                self._keep(run, dataset)

    def _keep(self, run: Run, dataset: Dataset) -> None:
        try:
            run.keep(with_gates(dataset))
        except OSError as error:
            self._fail(run, f"ended well, but its dataset cannot be written: {error}")
        else:
            self._finish(run, "done")

    def _finish(self, run: Run, status: str) -> None:
        self._on_progress(run.request, 1.0, 0.0)
        self._answer(run.request, status, folder=run.folder)

    def _fail(self, run: Run, reason: str) -> None:
        exit_status = run.ending.status if run.ending else None
        self._answer(run.request, "failed", failure=run.put_aside(reason), exit_status=exit_status)

    def _answer(
        self,
        request: RunRequest,
        status: str,
        folder: Path | None = None,
        failure: str | None = None,
        exit_status: int | None = None,
    ) -> None:
        self.results[id(request)] = RunResult(request, folder, failure, status, exit_status)
