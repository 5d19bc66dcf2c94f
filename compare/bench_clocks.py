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
from crossdem.adapters.engine import INPUTS, Code, EngineFailure
from crossdem.adapters.engine_file import read_engine
from crossdem.adapters.engines import get_engine

LAMMPS = Path(__file__).parents[1] / "examples/lammps/lammps.toml"  # in a checkout
YADE_CLOCK = Path(__file__).with_name("bench_yade_clock.py")
# LIGGGHTS' and LAMMPS' own, by MPI_Wtime from the end of all setting up to the end of the last step.
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
    code: Code
    command: Callable[[Code, Case, Path], list[str]]  # to be started in the run's folder
    read: Callable[[str], Told]  # from the log


def timed_command(code: Code, case: Case, run_dir: Path, threads: int = 1) -> list[str]:
    """The command that makes the run in `run_dir` and tells its time. Raises EngineNotFound."""
    command = CLOCKS[code.name].command(code, case, run_dir)
    command[command.index(code.program)] = code.executable()
    return [*command, "--threads", str(threads)] if threads > 1 else command


def told(code: Code, case: Case, log: str) -> Told:
    """What the log of a run that ended well says. Raises EngineFailure where that is not the time of the whole run."""
    try:
        found = CLOCKS[code.name].read(log)
    except (ValueError, LookupError, TypeError) as error:
        raise EngineFailure("did not say how long its steps took") from error
    if found.steps != (steps := code.schedule(case).steps):
        raise EngineFailure(f"made {found.steps} steps instead of {steps}")
    return found


def _measure(code: Code, case: Case, run_dir: Path) -> list[str]:
    return [code.program, "measure", f"{INPUTS}/case.json", "--packing", f"{INPUTS}/packing.csv"]


def _as_it_runs(code: Code, case: Case, run_dir: Path) -> list[str]:
    return code.command(case, run_dir)


def _with_clock(code: Code, case: Case, run_dir: Path) -> list[str]:
    shutil.copyfile(YADE_CLOCK, run_dir / INPUTS / YADE_CLOCK.name)
    return [code.program, f"{INPUTS}/{YADE_CLOCK.name}", code.name]


def _json_line(log: str) -> Told:
    said = json.loads(log.strip().splitlines()[-1])
    return Told(said["steps"], said["wall_s"], said.get("peak_memory_bytes"))


def _loop_time(log: str) -> Told:
    # LIGGGHTS' first loop is that of `run 0`, the packing's forces; LAMMPS rests in a loop of its own.
    found = [(int(steps), float(wall_s)) for wall_s, steps in LOOP_TIME.findall(log)]
    if not found:
        raise LookupError("no loop")
    return Told(sum(steps for steps, _ in found), sum(wall_s for steps, wall_s in found if steps))


CLOCKS = {
    clock.code.name: clock
    for clock in (
        Clock(get_engine("native"), _measure, _json_line),
        Clock(get_engine("liggghts"), _as_it_runs, _loop_time),
        Clock(get_engine("yade"), _with_clock, _json_line),
        *(Clock(read_engine(path), _as_it_runs, _loop_time) for path in [LAMMPS] if path.exists()),
    )
}
