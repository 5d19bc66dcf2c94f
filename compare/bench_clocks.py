"""The clock of each engine: how its run is started so that it says how long its steps took, and what it says.

Each runs on the input of a real run, from the same decks and scripts.
"""

from __future__ import annotations

import json
import re
import shutil
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from crossdem.adapters.case import Case
from crossdem.adapters.engine import INPUTS, Engine, EngineFailure

YADE_CLOCK = Path(__file__).with_name("bench_yade_clock.py")
# LIGGGHTS's own, from MPI_Wtime after all setting up to the end of the last step; finish.cpp writes it after every run.
LOOP_TIME = re.compile(
    r"^Loop time of (\S+) on \d+ procs for (\d+) steps with \d+ atoms", re.MULTILINE
)


@dataclass(frozen=True)
class Told:
    """What an engine says of its steps."""

    steps: int
    wall_s: float
    peak_memory_bytes: int | None = None


@dataclass(frozen=True)
class Clock:
    command: Callable[[Engine, Case, Path], list[str]]  # to be started in the run's folder
    read: Callable[[str], Told]  # from the log


def timed_command(engine: Engine, case: Case, run_dir: Path) -> list[str]:
    """The command that makes the run in `run_dir` and tells its time. Raises EngineNotFound."""
    command = CLOCKS[engine.name].command(engine, case, run_dir)
    command[command.index(engine.program)] = engine.executable()
    return command


def told(engine: Engine, case: Case, log: str) -> Told:
    """What the log of a run that ended well says. Raises EngineFailure where that is not the time of the whole run."""
    try:
        found = CLOCKS[engine.name].read(log)
    except (ValueError, LookupError, TypeError) as error:
        raise EngineFailure("did not say how long its steps took") from error
    if found.steps != (steps := engine.schedule(case).steps):
        raise EngineFailure(f"made {found.steps} steps instead of {steps}")
    return found


def _measure(engine: Engine, case: Case, run_dir: Path) -> list[str]:
    return [engine.program, "measure", f"{INPUTS}/case.json", "--packing", f"{INPUTS}/packing.csv"]


def _as_it_runs(engine: Engine, case: Case, run_dir: Path) -> list[str]:
    return engine.command(case, run_dir)


def _with_clock(engine: Engine, case: Case, run_dir: Path) -> list[str]:
    shutil.copyfile(YADE_CLOCK, run_dir / INPUTS / YADE_CLOCK.name)
    return [engine.program, f"{INPUTS}/{YADE_CLOCK.name}", engine.name]


def _json_line(log: str) -> Told:
    said = json.loads(log.strip().splitlines()[-1])
    return Told(said["steps"], said["wall_s"], said.get("peak_memory_bytes"))


def _loop_time(log: str) -> Told:
    wall_s, steps = LOOP_TIME.findall(log)[-1]  # the first is that of `run 0`, the packing's forces
    return Told(int(steps), float(wall_s))


CLOCKS = {
    "native": Clock(_measure, _json_line),
    "liggghts": Clock(_as_it_runs, _loop_time),
    "yade": Clock(_with_clock, _json_line),
}
