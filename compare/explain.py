"""`crossdem explain`: runs the walk from the paper's scheme to that of another code, and to that code itself."""

from __future__ import annotations

import pandas as pd
from rich.console import Console

from crossdem.adapters.case import Case, CaseError, varied
from crossdem.adapters.engines import get_engine
from crossdem.adapters.workspace import Workspace

from .attribution import Attribution, Station, attribute
from .checks import Check
from .ingredients import Ingredient, engine_itself, walk
from .progress import ProgressDisplay
from .runs import here, where
from .variants import Variant, VariantRun, run_many_variants, settled


def explain_case(
    case: Case,
    target: str,
    seeds: int,
    engine_seeds: int,
    workspace: Workspace,
    jobs: int | None,
    console: Console,
    profile: str | None = None,
) -> Attribution:
    """Walk on the packings of `seeds` seeds, with the engine itself on the first `engine_seeds` of them.

    Raises CaseError for a case with nothing to explain, SolverError where packings cannot be made.
    """
    if faults := unexplainable(case):
        raise CaseError(faults)
    checks = Check.of_case(case.resolved)
    steps = route(case, target)
    with ProgressDisplay(console) as display:
        packings = settled(case, seeds, workspace, here(jobs, profile), display)
        pairs = [
            (variant, packing)
            for _, variant in steps
            for packing in packings[: engine_seeds if variant.engine == target else seeds]
        ]
        display.say(f"{len(pairs)} runs, {where(jobs, profile)}")
        runs = run_many_variants(case, pairs, workspace, jobs, display, profile)
    stations = tuple(
        station(ingredient, checks, [run for run in runs if run.variant == variant])
        for ingredient, variant in steps
    )
    return attribute(case, target, stations)


def unexplainable(case: Case) -> list[str]:
    """What a walk needs and the case lacks: a fault line each."""
    lacks = []
    if case.resolved["particle"]:
        lacks.append(
            "particle: particles placed by hand are one packing, and no interval comes of one; take out the "
            "[[particle]] tables, or run `crossdem check` on this case, which compares them particle by particle"
        )
    if not case.resolved.get("check"):
        lacks.append("check: there are no [[check]] tables; add them, they name what to explain")
    if "bar" not in case.resolved:
        lacks.append("bar: there is no [bar]; add one, what is explained is its resistance")
    return [f"{case.file_name}: {fault}" for fault in lacks]


def route(case: Case, target: str) -> list[tuple[Ingredient, Variant]]:
    """Each station of the walk with the case that it runs; the last is `case` itself in the engine `target`.

    Raises CaseError for readings that the walk cannot be taken with.
    """
    try:
        return _route(case, target)
    except CaseError as error:
        advice = (
            f"{case.file_name}: scheme: explain starts from the paper's default readings: "
            "take out --set scheme... and the readings in the case's [scheme]"
        )
        raise CaseError([advice, *error.faults]) from error


def _route(case: Case, target: str) -> list[tuple[Ingredient, Variant]]:
    step_s = get_engine(target).step_s(case)
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
    values, manifests = {}, []
    failed_gates: dict[str, dict[int, str]] = {}
    for run in runs:
        if run.folder:
            dataset = run.dataset()
            manifests.append(dataset.manifest)
            values[run.packing.seed] = [quantity.of(dataset) for quantity in quantities]
            for gate in dataset.manifest["gates"]:
                if not gate["passed"]:
                    failed_gates.setdefault(gate["name"], {})[run.packing.seed] = gate["message"]
    table = pd.DataFrame.from_dict(
        values, orient="index", columns=[quantity.name for quantity in quantities], dtype=float
    )
    failed = [run for run in runs if not run.folder]
    return Station(
        ingredient,
        table.rename_axis("seed"),
        failures={run.packing.seed: run.failure for run in failed},
        failed_gates=failed_gates,
        unsupported=frozenset(run.packing.seed for run in failed if run.unsupported),
        manifests=tuple(manifests),
    )
