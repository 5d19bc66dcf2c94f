"""`crossdem check FOLDER`: the ladder of every case in it; or of one case whose particles are placed by hand."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from pathlib import Path

from rich.console import Console

from crossdem import ExitCode
from crossdem.adapters.case import CaseError
from crossdem.adapters.workspace import Workspace

from .ladder_report import print_ladder, write_ladder
from .ladder_runs import Plan, climb, load_plans


def check_ladder(
    where: Path, engines: Sequence[str], out: Path | None, overrides: Sequence[str], jobs: int
) -> ExitCode:
    """Raises CaseError with the faults of all cases, before anything is written."""
    console = Console()
    plans = load_plans(where, engines, overrides, jobs)
    for warning in dict.fromkeys(line for plan in plans for line in plan.case.warnings):
        console.print(warning, markup=False, soft_wrap=True)
    name = where.resolve().stem
    workspace = Workspace(out or Path("results") / f"{name}{_variant(plans, overrides)}")
    try:
        ladder = climb(name, plans, engines, workspace, jobs, console)
    except CaseError:
        workspace.discard_if_new()
        raise
    page = write_ladder(ladder, workspace.root)
    print_ladder(ladder, page)
    return ladder.exit_code


def _variant(plans: Sequence[Plan], overrides: Sequence[str]) -> str:
    if not overrides:
        return ""
    hashes = "".join(plan.case.hash for plan in plans)
    return f"-{hashlib.sha256(hashes.encode()).hexdigest()[:8]}"
