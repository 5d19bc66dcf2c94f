"""The beds that speed is measured on: settled once by the native solver on all cores, and kept."""

from __future__ import annotations

import json
import time
from pathlib import Path

from crossdem.adapters.case import Case
from crossdem.adapters.engines import get_engine
from crossdem.adapters.files import write_whole
from crossdem.adapters.gates import REFERENCE
from crossdem.adapters.packing import Packing, make_packing
from crossdem.adapters.workspace import Workspace

from .progress import ProgressDisplay
from .runs import cores

SEED = 1
SETTLING = 3.0  # times the shortest settling at rest's cost, for the guess how long a bed takes


def bed(case: Case, workspace: Workspace, display: ProgressDisplay) -> Packing:
    """The packing of `case`, made once and kept.

    Not made anew by another solver, as elsewhere: versions of it are to be compared on the same bed.
    """
    folder = bed_folder(case, workspace)
    if folder.exists():
        return make_packing(case, SEED, folder)
    count, recipe = case.resolved["particles"]["count"], case.resolved["packing"]
    steps = SETTLING * recipe["settling_s"] / recipe["step_s"]
    threads = cores()
    guess_s = get_engine(REFERENCE).cost_s * count * steps / threads
    display.say(f"settling a bed ({count:,} particles): about {guess_s:.0f} s")
    started = time.monotonic()
    packing = make_packing(case, SEED, folder, threads)
    made = {
        "wall_s": time.monotonic() - started,
        "threads": threads,
        "solver": get_engine(REFERENCE).version(),
    }
    write_whole(folder.with_suffix(".json"), json.dumps(made).encode())
    return packing


def bed_folder(case: Case, workspace: Workspace) -> Path:
    """Of the packing of `case`; NAME.json beside it says how long it took to make."""
    count = case.resolved["particles"]["count"]
    return workspace.root / "packings" / f"seed{SEED}-{count}-{case.run_hash[:12]}"
