"""The runs behind the stability map."""

from __future__ import annotations

from collections.abc import Sequence

from rich.console import Console

from crossdem.adapters.case import Case, CaseError
from crossdem.adapters.workspace import Workspace

from .progress import ProgressDisplay
from .stability import DEFAULT_REST_S, StabilityMap, bounds, default_steps_s, grid, trial
from .variants import run_variants, settled


def map_stability(
    case: Case,
    steps_s: Sequence[float],
    seeds: int,
    workspace: Workspace,
    jobs: int,
    console: Console,
) -> StabilityMap:
    """Try every scheme at `steps_s` (none given: default_steps_s). Raises CaseError, SolverError."""
    if case.resolved["particle"]:
        raise CaseError(
            [
                f"{case.file_name}: particle: particles placed by hand are no packed bed; take out the [[particle]] "
                "tables, or run `crossdem check` on this case"
            ]
        )
    places, left_out = grid(case, steps_s or default_steps_s(case))
    with ProgressDisplay(console) as display:
        packings = settled(case, seeds, workspace, jobs, display)
        pairs = [(place.variant, packing) for place in places for packing in packings]
        display.say(f"{len(pairs)} runs, {jobs} at a time")
        runs = run_variants(case, pairs, workspace, jobs, display)
    tried = [(place.scheme, place.step_s) for place in places for _ in packings]
    trials = tuple(trial(*about, run) for about, run in zip(tried, runs))
    manifests = tuple(run.manifest() for run in runs if run.folder)
    rest_s = case.resolved["time"]["rest_s"] or DEFAULT_REST_S
    return StabilityMap(case, bounds(case), rest_s, trials, left_out, manifests)
