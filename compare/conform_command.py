"""`crossdem conform FILE`: a user's code on the ladder, then on the bed beside recorded runs of the other codes."""

from __future__ import annotations

from pathlib import Path

from rich.console import Console

from crossdem import ExitCode
from crossdem.adapters.case import Case
from crossdem.adapters.dataset import Dataset
from crossdem.adapters.engine_file_faults import LADDER
from crossdem.adapters.engines import get_engine
from crossdem.adapters.workspace import Workspace

from .comparison import Comparison, compare_runs
from .conform_report import print_conformity, write_conformity
from .conformity import Conformity, not_run
from .horizon_runs import horizon_of_runs
from .ladder import Ladder
from .ladder_report import write_ladder
from .ladder_runs import climb, load_plans
from .recorded import RECORDS, find_record
from .replay import replayed, restore_packings, said_of
from .report import write_report
from .runs import TIERS, run_engines


def conform(
    engine: str, case: Case, tier: str, bed: bool | None, workspace: Workspace, jobs: int
) -> ExitCode:
    """Raises as `examine`."""
    console = Console()
    found, page = examine(engine, case, tier, bed, workspace, jobs, console)
    print_conformity(found, page)
    return found.exit_code


def examine(
    engine: str,
    case: Case,
    tier: str,
    bed: bool | None,
    workspace: Workspace,
    jobs: int,
    console: Console,
) -> tuple[Conformity, Path]:
    """Where it stands, and the path of the page that says so. `bed`: whether to run it; None: if the ladder holds.

    Raises EngineNotFound for a code that does not say its version, CaseError for `case` without a record.
    """
    version = get_engine(engine).version()
    record = find_record(case, RECORDS)
    plans = load_plans(LADDER, [engine], (), jobs)
    ladder = climb("micro", plans, [engine], Workspace(workspace.root / "ladder"), jobs, console)
    write_ladder(ladder, workspace.root / "ladder")
    why = {None: not_run(ladder), False: "The bed was not asked for.", True: ""}[bed]
    beside = None if why else _bed(engine, case, record, tier, workspace, jobs, console)
    particles = {plan.case.name: plan.case.resolved["particles"]["count"] for plan in plans}
    found = Conformity(engine, version, ladder, particles, beside, why, tier)
    return found, write_conformity(found, workspace.root)


def _bed(engine, case, record, tier, workspace, jobs, console) -> Comparison:
    seeds, twins = TIERS[tier]
    others = replayed(record, [engine], seeds, twins)
    console.print(said_of(others))
    space = Workspace(workspace.root / "bed")
    restore_packings(case, record, seeds, space)
    runs = run_engines(case, [engine], seeds, space, jobs, console, twins)
    horizon = horizon_of_runs(case, [engine], runs.failures, space, jobs, console)
    datasets = map(Dataset.read, runs.folders)
    found = compare_runs(case, datasets, runs.failures, runs.unsupported, horizon, others)
    write_report(found, space.root)
    return found
