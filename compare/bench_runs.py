"""The runs behind a speed comparison: one at a time, engine after engine, round after round."""

from __future__ import annotations

import shutil
import time
from collections.abc import Sequence
from pathlib import Path
from tempfile import TemporaryDirectory

from rich.console import Console

from crossdem.adapters.case import Case
from crossdem.adapters.engine import EngineFailure, EngineNotFound
from crossdem.adapters.packing import Packing
from crossdem.adapters.workspace import Workspace

from .bench import Bench, Contender, Key, Timing
from .bench_beds import bed
from .bench_clocks import CLOCKS
from .bench_timing import time_run
from .bench_workloads import Workload
from .progress import ProgressDisplay

RUN = ".run-"  # how the folder that an engine works in starts


def run_bench(
    case: Case,
    workloads: Sequence[Workload],
    contenders: Sequence[Contender],
    repeats: int,
    workspace: Workspace,
    console: Console,
) -> Bench:
    """Time `contenders` on `workloads`, `repeats` rounds. Raises CaseError, SolverError where a bed cannot be made."""
    versions, left_out = _present([contender.engine for contender in contenders])
    present = [contender for contender in contenders if contender.engine in versions]
    with ProgressDisplay(console) as display:
        packings = {w.name: bed(w.bed, workspace, display) for w in workloads}
        rounds = _Rounds(workloads, present, repeats, packings, workspace.root, display)
        rounds.run()
    return Bench(
        case,
        tuple(workloads),
        repeats,
        versions,
        left_out,
        tuple(timing for timing in rounds.timings if timing.key not in rounds.failures),
        rounds.failures,
    )


def _present(engines: Sequence[str]) -> tuple[dict[str, str], dict[str, str]]:
    """By name: the versions of the engines that are here, and why the others are left out."""
    versions, left_out = {}, {}
    for name in dict.fromkeys(engines):
        try:
            code = CLOCKS[name].code
            compiler = code.compiler()
            versions[name] = code.version() + (f" ({compiler})" if compiler else "")
        except EngineNotFound as error:
            left_out[name] = str(error)
    return versions, left_out


class _Rounds:
    """Every contender on every workload in turn, so that whatever slows the machine down for a while slows all of them."""

    def __init__(
        self,
        workloads: Sequence[Workload],
        contenders: Sequence[Contender],
        repeats: int,
        packings: dict[str, Packing],
        root: Path,
        display: ProgressDisplay,
    ):
        self.timings: list[Timing] = []
        self.failures: dict[Key, str] = {}
        self._packings, self._root, self._display = packings, root, display
        self._waiting = [
            (number, workload, contender)
            for number in range(repeats)
            for workload in workloads
            for contender in contenders
        ]
        self._expected_s = {
            (workload.name, contender): CLOCKS[contender.engine].code.expected_s(workload.case)
            for _, workload, contender in self._waiting
        }
        self._started = time.monotonic()

    def run(self) -> None:
        for unfinished in self._root.glob(f"{RUN}*"):  # of a crossdem that was killed
            shutil.rmtree(unfinished, ignore_errors=True)
        while self._waiting:
            number, workload, contender = self._waiting.pop(0)
            key = workload.name, contender
            if key in self.failures:
                continue
            packing = self._packings[workload.name]
            try:
                with TemporaryDirectory(prefix=RUN, dir=self._root) as folder:
                    run_dir = Path(folder) / "run"
                    timing = time_run(
                        number,
                        workload,
                        contender,
                        packing,
                        run_dir,
                        lambda process_s: self._tell(key, process_s),
                    )
            except (EngineFailure, EngineNotFound) as failure:
                self.failures[key] = f"{contender} {failure}"
            else:
                self.timings.append(timing)
                self._expected_s[key] = timing.process_wall_s
        self._display.update("timing", 1.0)

    def _tell(self, key: Key, process_s: float) -> None:
        """Progress, of which `process_s` in the run of `key`; what is left as runs of before took, else as expected."""
        waiting = [(workload.name, contender) for _, workload, contender in self._waiting]
        later_s = sum(self._expected_s[run] for run in waiting if run not in self.failures)
        left_s = max(0.0, self._expected_s[key] - process_s) + later_s
        done_s = time.monotonic() - self._started
        self._display.update("timing", min(0.99, done_s / (done_s + left_s)), left_s)
