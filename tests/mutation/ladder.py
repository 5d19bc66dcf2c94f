"""The ladder of few particles, climbed by a program with a fault: which rungs do not hold."""

from __future__ import annotations

import json
import os
import subprocess
from dataclasses import dataclass
from pathlib import Path

from workshop import ROOT

from crossdem import ExitCode
from crossdem.compare.outcomes import AGREES
from crossdem.compare.rungs import CLOSED_FORM

MICRO = ROOT / "reference_cases" / "micro"


@dataclass(frozen=True)
class Climb:
    """How a program fares on the ladder; without rungs it failed at the first touch."""

    exit_code: int
    said: str
    rungs: tuple[dict, ...]  # as in ladder.json, in the ladder's order

    @property
    def failing(self) -> list[dict]:
        return [rung for rung in self.rungs if rung["outcome"] != AGREES]

    @property
    def failing_answers(self) -> list[dict]:
        """Those that need no second implementation."""
        return [rung for rung in self.failing if rung["kind"] == CLOSED_FORM]

    @property
    def caught(self) -> bool:
        return self.exit_code != 0


def climb(solver: Path, out_dir: Path, ladder: Path = MICRO) -> Climb:
    """`crossdem check` of the reference cases with a known answer, by this native solver alone."""
    done = subprocess.run(
        [ROOT / "crossdem", "check", ladder, "--engines=native", f"--out={out_dir}"],
        env={**os.environ, "CROSSDEM_SOLVER": str(solver)},
        cwd=ROOT,
        capture_output=True,
        text=True,
        timeout=600,
    )
    record = out_dir / "ladder.json"
    judged = record.exists() or done.returncode in (ExitCode.BAD_INPUT, ExitCode.ENGINE_FAILED)
    assert judged, f"no verdict, which says nothing of the fault:\n{done.stdout}{done.stderr}"
    rungs = json.loads(record.read_bytes())["rungs"] if record.exists() else []
    return Climb(done.returncode, done.stdout + done.stderr, tuple(rungs))


def name_of(rung: dict) -> str:
    return f"{rung['case']}: {rung['about']}"
