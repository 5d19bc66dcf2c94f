"""The contract of an engine: a few small methods around data files. An engine starts no run; run.py does."""

from __future__ import annotations

import hashlib
import re
import shutil
from abc import ABC, abstractmethod
from pathlib import Path

from .case import Case
from .dataset import Dataset
from .packing import Packing
from .schedule import Schedule

OUTPUT = "output"  # folder, in a run's folder, that the engine writes into
INPUTS = "inputs"  # folder, in a run's folder, of all that the engine reads


class EngineNotFound(Exception):
    """An engine that is not installed; the text says what to install."""


class EngineFailure(Exception):
    """A run that did not end as it should; the text says what happened."""


class Declined(Exception):
    """A case that an engine, once started, says that it cannot run faithfully; the text says why."""


class Code(ABC):
    """A discrete element code that runs a case. Paths that it names are relative to the run's folder, in which it is started."""

    name: str
    script: Path | None = None  # real file that the code runs; a copy goes into every run's inputs/
    program: str  # the word of `command` that `executable` stands for, as people would type it
    by_hand: str = (
        ""  # a sentence for README.txt: what the command needs that is not there of itself
    )
    cost_s: float  # measured CPU time per particle and step, to order runs and to notice a hang
    substeps = 1  # time steps in one of time.step_s, where the case gives the code none of its own

    @abstractmethod
    def version(self) -> str:
        """As the code itself reports it. Raises EngineNotFound."""

    @abstractmethod
    def executable(self) -> str:
        """Where `program` is. Raises EngineNotFound."""

    @abstractmethod
    def write_input(self, case: Case, packing: Packing, run_dir: Path) -> None:
        """Write the code's data files and a copy of its script into `run_dir`/inputs."""

    @abstractmethod
    def command(self, case: Case, run_dir: Path) -> list[str]:
        """The command, to be started in `run_dir`; relative paths only."""

    def unsupported(self, case: Case) -> list[str]:
        """Why the code cannot run `case` faithfully at all; empty if it can."""
        return []

    def environment(self) -> dict[str, str]:
        """Variables set for the process; one thread, so that runs repeat bit by bit and share the cores."""
        return {"OMP_NUM_THREADS": "1"}

    def compiler(self) -> str | None:
        """Compiler and flags, where the code is built here."""
        return None

    def complaint(self, log: str) -> str | None:
        """The reason for a failure in the code's own words, if its log gives one."""
        return None

    def step_s(self, case: Case) -> float:
        """Its time step [s]: its own where the case gives one, else by that of the case."""
        own = case.resolved.get("engines", {}).get(self.name, {})
        return own.get("step_s", case.resolved["time"]["step_s"] / self.substeps)

    def schedule(self, case: Case) -> Schedule:
        return Schedule.of(case.resolved, self.step_s(case))

    def expected_s(self, case: Case) -> float:
        """Rough CPU time of a run [s]."""
        return 2.0 + self.cost_s * case.resolved["particles"]["count"] * self.schedule(case).steps

    def _copy_script(self, run_dir: Path) -> None:
        shutil.copyfile(self.script, run_dir / INPUTS / self.script.name)


class Engine(Code):
    """A code whose runs are read as datasets, so that they can be compared."""

    sources: str | None = None  # how the names of its files here start, where not with `name`
    samples_file: str  # grows by one line per sample: shows the progress
    kept_output: tuple[str, ...] = ()  # files of output/ worth keeping beside the dataset
    declined_status: int | None = (
        None  # exit status that says: not this case, for the reason in my last line
    )
    log_noise: re.Pattern[bytes] | None = None  # of its log, not kept of a run that ended well

    @abstractmethod
    def lines_before_bar(self, case: Case) -> int:
        """Lines of `samples_file` before that of the end of the rest, when the bar starts."""

    @abstractmethod
    def read_output(self, case: Case, packing: Packing, run_dir: Path, manifest: dict) -> Dataset:
        """What the engine left in `run_dir`/output. Raises EngineFailure where it is not whole."""

    def limitations(self, case: Case) -> list[str]:
        """What of `case` the engine expresses otherwise than the case says; for the report."""
        return []

    def digest(self) -> str:
        """SHA-256 [hex] of what the run's result depends on beside case, packing and version: its files here."""
        content = hashlib.sha256()
        for source in sorted(Path(__file__).parent.glob(f"{self.sources or self.name}*.*")):
            content.update(source.read_bytes())
        return content.hexdigest()

    def lines_in_all(self, case: Case) -> int:
        """Lines of `samples_file` when the run is over."""
        return self.lines_before_bar(case) + self.schedule(case).samples


def unexpressed_readings(case: Case) -> list[str]:
    """The readings of `case` that only the native solver can express, as reasons why others do not run it."""
    scheme = case.resolved["scheme"]
    found = []
    if "bar" in case.resolved and scheme["bar_corner"] == "faces_only":
        found.append(
            "its bar always has corners; scheme.bar_corner = faces_only cannot be expressed"
        )
    if scheme["inertia"] == "sphere":
        found.append("its particles are discs; scheme.inertia = sphere cannot be expressed")
    return found


def options(case: Case) -> list[str]:
    """The key paths of the options beyond the paper's law that `case` has on: joints with a strength, rolling friction."""
    found = []
    for kind, contact in case.resolved["contact"].items():
        keys = ("tensile_strength_N", "rolling_friction")
        found += [f"contact.{kind}.{key}" for key in keys if contact.get(key)]
    return found


def unexpressed_options(case: Case, own: dict[str, str]) -> list[str]:
    """Of an engine that lacks the options of `own`, key: sentence, those that `case` has on, as reasons."""
    return [f"{path}: {own[key]}" for path in options(case) if (key := path.split(".")[-1]) in own]


def where_it_differs(case: Case, own: dict[tuple[str, str | None], str]) -> list[str]:
    """Of an engine's `own` readings, (key, value): sentence, those that are not what `case` says."""
    scheme = case.resolved["scheme"]
    return [sentence for (key, value), sentence in own.items() if scheme[key] != value]
