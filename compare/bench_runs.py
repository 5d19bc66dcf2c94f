"""The runs behind a speed comparison: one at a time, engine after engine, round after round."""

from __future__ import annotations

import json
import shutil
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory

from rich.console import Console

from crossdem.adapters.case import Case
from crossdem.adapters.engine import Engine, EngineFailure, EngineNotFound
from crossdem.adapters.engines import get_engine
from crossdem.adapters.files import write_whole
from crossdem.adapters.gates import REFERENCE
from crossdem.adapters.one_run import LOG, Limits
from crossdem.adapters.packing import Packing, make_packing
from crossdem.adapters.process import Process
from crossdem.adapters.run_folder import environment, prepare
from crossdem.adapters.workspace import Workspace

from .bench import Bench, Timing
from .bench_clocks import timed_command, told
from .bench_workloads import Workload
from .progress import ProgressDisplay

SEED = 1
POLL_S = 0.05
TELL_S = 0.5
RUN = ".run-"  # how the folder that an engine works in starts
SETTLING = 1.5  # times the shortest settling, for the guess how long a bed takes

Key = tuple[str, str]  # workload, engine


def run_bench(
    case: Case,
    workloads: Sequence[Workload],
    engines: Sequence[str],
    repeats: int,
    workspace: Workspace,
    console: Console,
) -> Bench:
    """Time `engines` on `workloads`, `repeats` rounds. Raises CaseError, SolverError where a bed cannot be made."""
    versions, left_out = _present(engines)
    with ProgressDisplay(console) as display:
        packings = {w.name: bed(w.bed, workspace, display) for w in workloads}
        rounds = _Rounds(workloads, list(versions), repeats, packings, workspace.root, display)
        rounds.run()
    return Bench(
        case,
        tuple(workloads),
        repeats,
        versions,
        left_out,
        tuple(t for t in rounds.timings if (t.workload, t.engine) not in rounds.failures),
        rounds.failures,
    )


def bed(case: Case, workspace: Workspace, display: ProgressDisplay) -> Packing:
    """The packing of `case`, made once and kept.

    Not made anew by another solver, as elsewhere: versions of it are to be compared on the same bed.
    """
    folder = bed_folder(case, workspace)
    if folder.exists():
        return make_packing(case, SEED, folder)
    count, recipe = case.resolved["particles"]["count"], case.resolved["packing"]
    steps = SETTLING * recipe["settling_s"] / recipe["step_s"]
    guess_s = get_engine(REFERENCE).cost_s * count * steps
    display.say(f"settling a bed ({count:,} particles): about {guess_s:.0f} s")
    started = time.monotonic()
    packing = make_packing(case, SEED, folder)
    made = {"wall_s": time.monotonic() - started, "solver": get_engine(REFERENCE).version()}
    write_whole(folder.with_suffix(".json"), json.dumps(made).encode())
    return packing


def bed_folder(case: Case, workspace: Workspace) -> Path:
    """Of the packing of `case`; NAME.json beside it says how long it took to make."""
    count = case.resolved["particles"]["count"]
    return workspace.root / "beds" / f"{count}-{case.run_hash[:12]}"


def _present(engines: Sequence[str]) -> tuple[dict[str, str], dict[str, str]]:
    """By name: the versions of the engines that are here, and why the others are left out."""
    versions, left_out = {}, {}
    for name in engines:
        try:
            engine = get_engine(name)
            compiler = engine.compiler()
            versions[name] = engine.version() + (f" ({compiler})" if compiler else "")
        except EngineNotFound as error:
            left_out[name] = str(error)
    return versions, left_out


class _Rounds:
    """Every engine on every workload in turn, so that whatever slows the machine down for a while slows all of them."""

    def __init__(
        self,
        workloads: Sequence[Workload],
        engines: Sequence[str],
        repeats: int,
        packings: dict[str, Packing],
        root: Path,
        display: ProgressDisplay,
    ):
        self.timings: list[Timing] = []
        self.failures: dict[Key, str] = {}
        self._packings, self._root, self._display = packings, root, display
        self._waiting = [
            (number, workload, get_engine(engine))
            for number in range(repeats)
            for workload in workloads
            for engine in engines
        ]
        self._expected_s = {
            (workload.name, engine.name): engine.expected_s(workload.case)
            for _, workload, engine in self._waiting
        }
        self._started = time.monotonic()

    def run(self) -> None:
        for unfinished in self._root.glob(f"{RUN}*"):  # of a crossdem that was killed
            shutil.rmtree(unfinished, ignore_errors=True)
        while self._waiting:
            number, workload, engine = self._waiting.pop(0)
            key = workload.name, engine.name
            if key in self.failures:
                continue
            packing = self._packings[workload.name]
            try:
                with TemporaryDirectory(prefix=RUN, dir=self._root) as folder:
                    run_dir = Path(folder) / "run"
                    timing = _time(
                        number,
                        workload,
                        engine,
                        packing,
                        run_dir,
                        lambda process_s: self._tell(key, process_s),
                    )
            except (EngineFailure, EngineNotFound, OSError) as failure:
                self.failures[key] = f"{engine.name} {failure}"
            else:
                self.timings.append(timing)
                self._expected_s[key] = timing.process_wall_s
        self._display.update("timing", 1.0)

    def _tell(self, key: Key, process_s: float) -> None:
        """Progress, of which `process_s` in the run of `key`; what is left as runs of before took, else as expected."""
        waiting = [(workload.name, engine.name) for _, workload, engine in self._waiting]
        later_s = sum(self._expected_s[run] for run in waiting if run not in self.failures)
        left_s = max(0.0, self._expected_s[key] - process_s) + later_s
        done_s = time.monotonic() - self._started
        self._display.update("timing", min(0.99, done_s / (done_s + left_s)), left_s)


def _time(
    number: int,
    workload: Workload,
    engine: Engine,
    packing: Packing,
    run_dir: Path,
    tell: Callable[[float], None],
) -> Timing:
    """One run in the new folder `run_dir`. Raises EngineFailure, EngineNotFound, OSError."""
    case = workload.case
    if reasons := engine.unsupported(case):
        raise EngineFailure(f"cannot run this case: {'; '.join(reasons)}")
    prepare(case, packing, engine, run_dir)
    command = timed_command(engine, case, run_dir)
    allowed_s = Limits().allowed_s(engine.expected_s(case))
    process = Process(command, run_dir, environment(engine), run_dir / LOG)
    told_s = 0.0
    try:
        while (ending := process.poll()) is None:
            if process.wall_s > allowed_s:
                raise EngineFailure(f"ran past its time limit of {allowed_s:.3g} s and was ended")
            if process.wall_s - told_s >= TELL_S:
                told_s = process.wall_s
                tell(told_s)
            time.sleep(POLL_S)
    finally:
        process.kill()
    log = (run_dir / LOG).read_text(encoding="utf-8", errors="replace")
    if ending.status != 0:
        complaint = engine.complaint(log)
        raise EngineFailure(f"{ending}" + (f": {complaint}" if complaint else ""))
    said = told(engine, case, log)
    return Timing(
        workload=workload.name,
        engine=engine.name,
        round=number,
        particles=len(packing.particles),
        steps=said.steps,
        wall_s=said.wall_s,
        process_wall_s=ending.wall_s,
        process_cpu_s=ending.cpu_s,
        peak_memory_bytes=said.peak_memory_bytes,
    )
