"""The runs behind the horizon: each engine from the packing and from its twin, and the native schemes of their names."""

from __future__ import annotations

import math
import shutil
from collections.abc import Sequence

import numpy as np
from rich.console import Console

from crossdem.adapters.case import Case, varied
from crossdem.adapters.engines import get_engine
from crossdem.adapters.packing import Packing, make_packing
from crossdem.adapters.workspace import Workspace

from .horizon import SHIFT_M, EngineHorizon, Horizon, closeness, growth
from .progress import ProgressDisplay
from .variants import Variant, VariantRun, run_variants

RECORDED_S = 1.0  # a shift of 1e-12 m reaches the horizon after half of it
FRAME_S = 0.01
# The native scheme that does what an engine does, step by step.
SCHEMES = {"liggghts": "liggghts", "yade": "yade", "yade-averaged": "yade_averaged"}


def find_horizon(
    case: Case,
    engines: Sequence[str],
    seed: int,
    workspace: Workspace,
    jobs: int,
    console: Console,
) -> Horizon:
    """Run what is needed on the packing of `seed`, and measure. Raises CaseError, SolverError where there is no packing."""
    packing = make_packing(case, seed, workspace.packing_folder(case, seed))
    with ProgressDisplay(console) as display:
        return _measure(case, engines, packing, workspace, jobs, display)


def _measure(
    case: Case,
    engines: Sequence[str],
    packing: Packing,
    workspace: Workspace,
    jobs: int,
    display: ProgressDisplay,
) -> Horizon:
    start = from_packing(case)
    twin = shifted(packing, workspace)
    unable = {name: reasons for name in engines if (reasons := get_engine(name).unsupported(start))}
    able = [name for name in engines if name not in unable]
    variants = {name: Variant(f"{name} from the packing", start, name) for name in able}
    twins = {name: Variant(f"{name} from its twin", start, name) for name in able}
    schemes = {name: native_scheme(start, name) for name in able if name in SCHEMES}
    pairs = [(variant, packing) for variant in (*variants.values(), *schemes.values())]
    pairs += [(variant, twin) for variant in twins.values()]
    display.say(f"{len(pairs)} short runs for the horizon")
    runs = {run.variant.name: run for run in run_variants(case, pairs, workspace, jobs, display)}
    found = []
    for name in engines:
        if name in unable:
            found.append(EngineHorizon(name, obstacle="; ".join(unable[name])))
            continue
        native = runs[schemes[name].name] if name in schemes else None
        found.append(_measured(name, runs[variants[name].name], runs[twins[name].name], native))
    return Horizon(packing.seed, start.resolved["time"]["penetration_s"], tuple(found))


def from_packing(case: Case) -> Case:
    """The case from its packing on, without rest, for RECORDED_S at most."""
    time = case.resolved["time"]
    frame_s = max(1, round(FRAME_S / time["sample_interval_s"])) * time["sample_interval_s"]
    frame_s = min(frame_s, time["penetration_s"])
    frames = max(1, math.floor(min(RECORDED_S, time["penetration_s"]) / frame_s + 1e-9))
    values = {
        "rest_s": 0.0,
        "penetration_s": frames * frame_s,
        "sample_interval_s": frame_s,
        "frame_interval_s": frame_s,
    }
    return varied(case, [f"time.{key}={value!r}" for key, value in values.items()])


def shifted(packing: Packing, workspace: Workspace) -> Packing:
    """The packing's twin: the particle in the middle of the bed lies SHIFT_M further to the right."""
    folder = workspace.root / "packings" / f"{packing.folder.name}-shifted"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    particles = packing.particles.copy()
    place_m = particles[["x_m", "y_m"]].to_numpy()
    middle = int(np.argmin(np.hypot(*(place_m - place_m.mean(axis=0)).T)))
    particles.loc[middle, "x_m"] += SHIFT_M
    particles.to_csv(folder / "packing.csv", index=False)
    shutil.copyfile(packing.folder / "packing.json", folder / "packing.json")
    return Packing.read(folder)


def native_scheme(start: Case, engine: str) -> Variant:
    """What `engine` is compared with: the native solver under the scheme of its name, at its time step."""
    changes = [f"scheme.name={SCHEMES[engine]}", f"time.step_s={start.step_s(engine)!r}"]
    return Variant(f"native scheme {SCHEMES[engine]} from the packing", varied(start, changes))


def _measured(
    engine: str, run: VariantRun, twin: VariantRun, native: VariantRun | None
) -> EngineHorizon:
    for needed in filter(None, (run, twin, native)):
        if needed.failure:
            return EngineHorizon(engine, obstacle=needed.failure, failed=True)
    whole = run.dataset()
    own = growth(whole, twin.dataset())
    if native is None:
        return EngineHorizon(engine, own)
    return EngineHorizon(engine, own, closeness(whole, native.dataset(), SCHEMES[engine], own))
