"""The plan of a call: the runs that are to be made and how they are grouped into tasks, in a file that tasks read."""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from ..case import Case
from ..engines import attach, attached
from ..files import write_whole
from ..one_run import Limits
from ..packing import Packing
from ..run_folder import RunRequest

PLAN = "plan.json"
STATUS = "status"  # folder of what each task says of its runs
AROUND_S = 60.0  # beside the process of a run: starting Python, writing the input and the dataset
DONE = "done"  # folder of what Snakemake waits for: a file per task with nothing left to try again


@dataclass(frozen=True)
class PlannedRun:
    """A run that a task makes."""

    request: RunRequest
    out_dir: Path  # of the dataset's runs/
    name: str  # of its folder there
    key: str
    expected_s: float  # CPU time


@dataclass(frozen=True)
class Group:
    """The runs of one task, which makes them one after the other."""

    runs: tuple[PlannedRun, ...]

    @property
    def name(self) -> str:
        keys = " ".join(f"{run.out_dir} {run.key}" for run in self.runs)
        return hashlib.sha256(keys.encode()).hexdigest()[:12]

    @property
    def expected_s(self) -> float:
        """CPU time."""
        return sum(run.expected_s for run in self.runs)

    @property
    def limit_s(self) -> float:
        """Wall time for schedulers that want a limit: each run gives up by itself before."""
        return sum(AROUND_S + Limits().allowed_s(run.expected_s) for run in self.runs)

    @property
    def threads(self) -> int:
        return max(run.request.ranks for run in self.runs)


def write_plan(groups: Sequence[Group], journal: Path, folder: Path) -> None:
    """For read_group and the Snakefile. Paths stay as they were given, with the folder that they are relative to."""
    cases = {run.request.case.hash: run.request.case for group in groups for run in group.runs}
    plan = {
        "started_in": os.getcwd(),
        "journal": str(journal),
        "attached": attached(run.request.engine_name for group in groups for run in group.runs),
        "cases": {name: case.canonical.decode() for name, case in cases.items()},
        "groups": {
            group.name: {
                "expected_s": group.expected_s,
                "limit_s": group.limit_s,
                "threads": group.threads,
                "runs": [_to_json(run) for run in group.runs],
            }
            for group in groups
        },
    }
    write_whole(folder / PLAN, json.dumps(plan, indent=1).encode())


def read_group(folder: Path, name: str) -> tuple[list[PlannedRun], Path]:
    """The runs of a task and the folder of the journal. Goes to the folder that their paths are relative to."""
    plan = json.loads((folder / PLAN).read_text(encoding="utf-8"))
    os.chdir(plan["started_in"])
    for description in plan["attached"]:
        attach(description)
    cases = {
        name: Case.from_canonical(canonical.encode()) for name, canonical in plan["cases"].items()
    }
    return [_of_json(run, cases) for run in plan["groups"][name]["runs"]], Path(plan["journal"])


def _to_json(run: PlannedRun) -> dict:
    return {
        "case": run.request.case.hash,
        "packing": str(run.request.packing.folder),
        "engine": run.request.engine_name,
        "ranks": run.request.ranks,
        "out_dir": str(run.out_dir),
        "name": run.name,
        "key": run.key,
        "expected_s": run.expected_s,
    }


def _of_json(run: dict, cases: dict[str, Case]) -> PlannedRun:
    request = RunRequest(
        cases[run["case"]], Packing.read(Path(run["packing"])), run["engine"], run["ranks"]
    )
    return PlannedRun(request, Path(run["out_dir"]), run["name"], run["key"], run["expected_s"])
