"""`crossdem explain`: runs the walk from the paper's scheme to that of another code, and to that code itself."""

from __future__ import annotations

import pandas as pd
from rich.console import Console

from crossdem.adapters.case import Case, CaseError, varied
from crossdem.adapters.workspace import Workspace

from .attribution import Attribution, Station, attribute
from .checks import Check
from .ingredients import Ingredient, engine_itself, walk
from .progress import ProgressDisplay
from .variants import Variant, VariantRun, run_variants, settled

REST_GATE = "rest_kinetic_energy_J"


def explain_case(
    case: Case,
    target: str,
    seeds: int,
    engine_seeds: int,
    workspace: Workspace,
    jobs: int,
    console: Console,
) -> Attribution:
    """Walk on the packings of `seeds` seeds, with the engine itself on the first `engine_seeds` of them.

    Raises CaseError for a case without checks, SolverError where packings cannot be made.
    """
    checks = Check.of_case(case.resolved)
    if not checks:
        raise CaseError(
            [
                f"{case.file_name}: check: the case has no [[check]] tables, which name what to explain"
            ]
        )
    steps = route(case, target)
    with ProgressDisplay(console) as display:
        packings = settled(case, seeds, workspace, jobs, display)
        pairs = [
            (variant, packing)
            for _, variant in steps
            for packing in packings[: engine_seeds if variant.engine == target else seeds]
        ]
        display.say(f"{len(pairs)} runs, {jobs} at a time")
        runs = run_variants(case, pairs, workspace, jobs, display)
    stations = tuple(
        station(ingredient, checks, [run for run in runs if run.variant == variant])
        for ingredient, variant in steps
    )
    return attribute(case, target, stations)


def route(case: Case, target: str) -> list[tuple[Ingredient, Variant]]:
    """Each station of the walk with the case that it runs; the last is `case` itself in the engine `target`."""
    step_s = case.step_s(target)
    *mixed, native = walk(target)
    steps, taken = [], []
    for ingredient in mixed:
        taken += [text.format(step_s=step_s) for text in ingredient.overrides]
        steps.append((ingredient, Variant(ingredient.name, varied(case, taken))))
    alone = [f"time.step_s={step_s}", *native.overrides]  # a native scheme takes no readings
    steps.append((native, Variant(native.name, varied(case, alone))))
    last = engine_itself(target)
    steps.append((last, Variant(last.name, case, target)))
    return steps


def station(ingredient: Ingredient, checks: list[Check], runs: list[VariantRun]) -> Station:
    """What `runs`, all of one variant, gave."""
    quantities = [check.quantity for check in checks]
    values, unrested = {}, {}
    for run in runs:
        if run.folder:
            dataset = run.dataset()
            values[run.packing.seed] = [quantity.of(dataset) for quantity in quantities]
            unrested |= {
                run.packing.seed: gate["message"]
                for gate in dataset.manifest["gates"]
                if gate["name"] == REST_GATE and not gate["passed"]
            }
    table = pd.DataFrame.from_dict(
        values, orient="index", columns=[quantity.name for quantity in quantities], dtype=float
    )
    failures = {run.packing.seed: run.failure for run in runs if not run.folder}
    return Station(ingredient, table.rename_axis("seed"), failures, unrested)
