"""One task of the workflow: makes the runs of its group one after the other and says what became of each.

Started by Snakemake in the folder of the plan. Ends with 1 when a run failed that may go well another time.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path

from ..files import write_whole
from ..gates import REFERENCE
from ..run import RunResult, look_up, run_all
from ..solver import BEYOND_REASON
from .plan import DONE, STATUS, PlannedRun, read_group
from .signals import end_on_signals, end_with_parent


def main(name: str) -> int:
    end_on_signals()
    end_with_parent()
    here = Path.cwd()
    runs, journal = read_group(here, name)
    results = [_make(run, journal) for run in runs]
    report = {run.key: _report(result) for run, result in zip(runs, results)}
    (here / STATUS).mkdir(exist_ok=True)
    write_whole(here / STATUS / f"{name}.json", json.dumps(report, indent=1).encode())
    if any(_is_worth_another_try(result) for result in results):
        return 1
    (here / DONE).mkdir(exist_ok=True)
    (here / DONE / name).touch()
    return 0


def _make(run: PlannedRun, journal: Path) -> RunResult:
    here, _ = look_up(run.request, run.out_dir)
    if here and here.key != run.key:
        other = f"{run.request.engine_name}: the machine of this task has another version of it"
        return RunResult(run.request, None, other, "failed")
    [result] = run_all([run.request], run.out_dir, 1, journal=journal)
    return result


def _report(result: RunResult) -> dict:
    return {
        "status": result.status,
        "failure": result.failure,
        "exit_status": result.exit_status,
    }


def _is_worth_another_try(result: RunResult) -> bool:
    """Unless it is there, cannot be had of its engine, or is a motion beyond reason of the native solver: the same every time."""
    if result.status == "unsupported":
        return False
    beyond_reason = result.exit_status == BEYOND_REASON and result.request.engine_name == REFERENCE
    return result.failure is not None and not beyond_reason


if __name__ == "__main__":
    try:
        sys.exit(main(sys.argv[1]))
    except KeyboardInterrupt:
        sys.exit(130)
