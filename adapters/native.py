"""The native solver, crossdem-solver, through the same door as the others: files in, a process, files out."""

from __future__ import annotations

import re
from functools import lru_cache
from pathlib import Path

import pandas as pd

from .case import Case
from .dataset import Dataset
from .engine import INPUTS, OUTPUT, Engine, EngineFailure, EngineNotFound
from .motion_file import MotionFileError, read_motion
from .packing import Packing
from .solver import SolverError, call_solver, find_solver, solver_sha256

VERSION_LINE = re.compile(r"(crossdem-solver \S+)(?: \((.*)\))?")


class Native(Engine):
    name = "native"
    program = "crossdem-solver"
    samples_file = f"{OUTPUT}/resistance.csv"
    kept_output = ("ledger.csv", "run.json")
    cost_s = 1e-8  # of the paper's scheme; of the others, up to five times as much
    by_hand = "crossdem-solver lies in build/release/solver of the crossdem checkout: put that folder on the PATH."

    def executable(self) -> str:
        try:
            return str(find_solver())
        except SolverError as error:
            raise EngineNotFound(str(error)) from error

    def version(self) -> str:
        return self._version_line()[1]

    def compiler(self) -> str | None:
        return self._version_line()[2]

    def digest(self) -> str:
        return f"{super().digest()} {solver_sha256()}"

    def command(self, case: Case, run_dir: Path) -> list[str]:
        packing = ["--packing", f"{INPUTS}/packing.csv"]
        return [self.program, "run", f"{INPUTS}/case.json", *packing, "--output", OUTPUT]

    def lines_before_bar(self, case: Case) -> int:
        return 1  # the title; it takes no samples of the rest

    def complaint(self, log: str) -> str | None:
        lines = [line for line in log.splitlines() if line.strip()]
        return lines[-1] if lines else None

    def write_input(self, case: Case, packing: Packing, run_dir: Path) -> None:
        """Nothing to add: it reads the case and the packing as they are."""

    def read_output(self, case: Case, packing: Packing, run_dir: Path, manifest: dict) -> Dataset:
        output = run_dir / OUTPUT
        try:
            motion, radius_m = read_motion(output / "motion.h5")
            resistance = pd.read_csv(output / "resistance.csv", float_precision="round_trip")
        except (OSError, ValueError, MotionFileError) as error:
            raise EngineFailure(f"native left no readable output ({error})") from error
        return Dataset(case.resolved, manifest, radius_m, motion, resistance)

    def _version_line(self) -> re.Match:
        try:
            line = _says_of_itself(solver_sha256())
        except SolverError as error:
            raise EngineNotFound(str(error)) from error
        found = VERSION_LINE.fullmatch(line)
        if not found:
            raise EngineNotFound(
                f"{self.executable()} is not crossdem-solver: it calls itself {line!r}"
            )
        return found


@lru_cache
def _says_of_itself(sha256: str) -> str:
    """The line of the solver that has this sum, asked once for all runs."""
    return call_solver(["--version"]).stdout.decode(errors="replace").strip()
