"""The runs behind the horizon: each engine and the native scheme of its name, from the packing and from its twin."""

from __future__ import annotations

import math
import traceback
from collections.abc import Mapping, Sequence
from dataclasses import replace

from rich.console import Console

from crossdem.adapters.case import Case, CaseError, varied
from crossdem.adapters.engines import get_engine
from crossdem.adapters.packing import Packing, make_packing, make_twin
from crossdem.adapters.workspace import Workspace

from .comparison import in_order
from .horizon import COMPARED_S, EngineHorizon, Horizon, closeness, growth
from .progress import ProgressDisplay
from .twin_schemes import has_twin, native_twin_or_why, scheme_name
from .variants import Variant, VariantRun, run_variants

SEED = 1  # of the packing on which a check compares particle by particle
RECORDED_S = 1.0  # a shift of 1e-12 m reaches the horizon after half of it
FRAME_S = 0.01
LEAST_FRAMES = 5  # within COMPARED_S, or the whole record where that is shorter
RUN_FACTS = ("engine_version", "time_step_s", "packing_hash", "run_key")  # of a run's manifest


def find_horizon(
    case: Case,
    engines: Sequence[str],
    seed: int,
    workspace: Workspace,
    jobs: int,
    console: Console,
) -> Horizon:
    """Run what is needed on the packing of `seed`, and measure. Raises CaseError, SolverError where there is no packing."""
    _refuse_unsettled(case)
    packing = make_packing(case, seed, workspace.packing_folder(case, seed))
    with ProgressDisplay(console) as display:
        return _measure(case, in_order(engines), packing, workspace, jobs, display)


def horizon_of_runs(
    case: Case,
    engines: Sequence[str],
    failures: Mapping[tuple[str, int], str],
    workspace: Workspace,
    jobs: int,
    console: Console,
) -> Horizon:
    """What find_horizon finds on seed 1 for the engines that finished it; `failures` as in Runs. Raises nothing.

    Whatever happens here, the runs behind it are finished, and their report is owed.
    """
    skipped = {
        name: EngineHorizon(name, obstacle=f"seed {SEED} has no result: {failures[name, SEED]}")
        for name in engines
        if (name, SEED) in failures
    }
    able = [name for name in engines if name not in skipped]
    found = Horizon(SEED, 0.0, ())
    if able:
        try:
            found = find_horizon(case, able, SEED, workspace, jobs, console)
        except CaseError as error:
            why = "; ".join(error.faults)
            found = Horizon(SEED, 0.0, tuple(EngineHorizon(name, obstacle=why) for name in able))
        except Exception as error:
            traceback.print_exc()
            why = f"{type(error).__name__}: {error}"
            lost = tuple(EngineHorizon(name, obstacle=why, failed=True) for name in able)
            found = Horizon(SEED, 0.0, lost)
    every = skipped | {one.engine: one for one in found.engines}
    return replace(found, engines=tuple(every[name] for name in in_order(engines)))


def _measure(
    case: Case,
    engines: Sequence[str],
    packing: Packing,
    workspace: Workspace,
    jobs: int,
    display: ProgressDisplay,
) -> Horizon:
    start = from_packing(case)
    variants, found = {}, {}
    for name in engines:
        if reasons := get_engine(name).unsupported(start):
            found[name] = EngineHorizon(name, obstacle="; ".join(reasons))
        else:
            variants[name] = Variant(name, start, name)
    schemes = {name: _native_scheme(start, name) for name in variants if has_twin(name)}
    wanted = [*variants.values(), *(one for one in schemes.values() if isinstance(one, Variant))]
    twin = make_twin(packing, 1, workspace.twin_folder(packing, 1))
    pairs = [(variant, packing) for variant in wanted]
    pairs += [(replace(one, name=f"{one.name} from the twin"), twin) for one in wanted]
    display.say(f"{len(pairs)} short runs for the horizon")
    done = run_variants(case, pairs, workspace, jobs, display)
    runs = {variant.name: pair for variant, *pair in zip(wanted, done, done[len(wanted) :])}
    for name, variant in variants.items():
        scheme = schemes.get(name)
        native = runs[scheme.name] if isinstance(scheme, Variant) else scheme
        found[name] = _measured(name, runs[name], native)
    return Horizon(
        packing.seed,
        start.resolved["time"]["penetration_s"],
        tuple(found[name] for name in engines),
        tuple(_facts(run) for run in done if run.folder),
    )


def _refuse_unsettled(case: Case) -> None:
    """The runs go without rest. Raises CaseError where the case places its particles by hand, to settle in it."""
    resolved = case.resolved
    if resolved["particle"] and "bar" in resolved and resolved["time"]["rest_s"] > 0:
        raise CaseError(
            [
                f"{case.file_name}: time.rest_s: the horizon starts from the particles as they are placed, without "
                f"rest, and the bar may stand where they still are; `crossdem check` compares them rung by rung"
            ]
        )


def from_packing(case: Case) -> Case:
    """The case from its packing on, without rest, for RECORDED_S at most, in frames of about FRAME_S or less.

    A frame comes after a whole number of each engine's time steps, as the interval between samples does: it is a
    multiple of the smallest part of that interval which all time steps divide.
    """
    time = case.resolved["time"]
    recorded_s = min(RECORDED_S, time["penetration_s"])
    steps_s = [
        time["step_s"],
        *(one["step_s"] for one in case.resolved.get("engines", {}).values()),
    ]
    parts = math.gcd(*(round(time["sample_interval_s"] / step_s) for step_s in steps_s))
    most_s = min(FRAME_S, COMPARED_S / LEAST_FRAMES, recorded_s / LEAST_FRAMES)
    taken = max(1, math.floor(most_s * parts / time["sample_interval_s"] * (1 + 1e-9)))
    frame_s = time["sample_interval_s"] * taken / parts
    values = {
        "rest_s": 0.0,
        "penetration_s": math.floor(recorded_s / frame_s * (1 + 1e-9)) * frame_s,
        "sample_interval_s": frame_s,
        "frame_interval_s": frame_s,
    }
    return varied(case, [f"time.{key}={value!r}" for key, value in values.items()])


def _native_scheme(start: Case, engine: str) -> Variant | str:
    """What `engine` is compared with: the native solver in the scheme of its name; or why there is none."""
    twin = native_twin_or_why(start, engine)
    return Variant(f"native scheme {scheme_name(engine)}", twin) if isinstance(twin, Case) else twin


def _measured(
    engine: str, own: Sequence[VariantRun], native: Sequence[VariantRun] | str | None
) -> EngineHorizon:
    """From the two runs of an engine and of its native scheme, each from the packing and from its twin."""
    if failure := _failure(own):
        return EngineHorizon(engine, obstacle=failure, failed=True)
    run, twin = (one.dataset() for one in own)
    grown = growth(run, twin)
    if native is None or isinstance(native, str):
        return EngineHorizon(engine, grown, obstacle=native)
    if failure := _failure(native):
        return EngineHorizon(engine, grown, obstacle=f"its native scheme: {failure}", failed=True)
    scheme_run, scheme_twin = (one.dataset() for one in native)
    usual = growth(scheme_run, scheme_twin)
    close = closeness(run, scheme_run, scheme_name(engine), usual)
    return EngineHorizon(engine, grown, close, scheme_growth=usual)


def _failure(runs: Sequence[VariantRun]) -> str | None:
    return next((run.failure for run in runs if run.failure), None)


def _facts(run: VariantRun) -> dict:
    manifest = run.dataset().manifest
    return {"run": run.variant.name} | {key: manifest[key] for key in RUN_FACTS}
