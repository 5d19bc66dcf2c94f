"""The runs behind the stability map."""

from __future__ import annotations

from collections.abc import Sequence

from rich.console import Console

from crossdem.adapters.case import Case
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
    places = grid(case, steps_s or default_steps_s(case))
    with ProgressDisplay(console) as display:
        packings = settled(case, seeds, workspace, jobs, display)
        display.say(f"{len(places) * seeds} runs, {jobs} at a time")
        pairs = [(variant, packing) for _, _, variant in places for packing in packings]
        runs = iter(run_variants(case, pairs, workspace, jobs, display))
    trials = tuple(
        trial(scheme, step_s, next(runs)) for scheme, step_s, _ in places for _ in packings
    )
    rest_s = case.resolved["time"]["rest_s"] or DEFAULT_REST_S
    return StabilityMap(case, bounds(case), rest_s, trials)
