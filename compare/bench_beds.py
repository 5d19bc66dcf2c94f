"""The beds that speed is measured on: settled once by the native solver on all cores, and kept."""

from __future__ import annotations

import json
import time
from dataclasses import asdict, dataclass
from pathlib import Path

from crossdem.adapters.case import Case
from crossdem.adapters.engines import get_engine
from crossdem.adapters.files import write_whole
from crossdem.adapters.gates import REFERENCE
from crossdem.adapters.packing import Packing, make_packing
from crossdem.adapters.solver import solver_sha256
from crossdem.adapters.workspace import Workspace

from .progress import ProgressDisplay
from .runs import cores
from .wording import plural

SEED = 1
SETTLING = 3.0  # times the shortest settling at rest's cost, for the guess how long a bed takes


@dataclass(frozen=True)
class Settling:
    """How a bed was made, from the solver's start until its files were read."""

    wall_s: float
    threads: int  # at most so many
    ns_per_particle_step: float  # over the whole fall, with every neighbour list that it takes
    solver_sha256: str


def bed(case: Case, workspace: Workspace, display: ProgressDisplay) -> Packing:
    """The packing of `case`, made once and kept.

    Not made anew by another solver, as elsewhere: versions of it are to be compared on the same bed.
    """
    folder = _folder(case, workspace)
    if folder.exists():
        return make_packing(case, SEED, folder)
    count, recipe = case.resolved["particles"]["count"], case.resolved["packing"]
    steps = SETTLING * recipe["settling_s"] / recipe["step_s"]
    threads = cores()
    guess_s = get_engine(REFERENCE).cost_s * count * steps / threads
    display.say(f"settling a bed of {plural(count, 'particle')}: about {guess_s:.0f} s")
    started = time.monotonic()
    packing = make_packing(case, SEED, folder, threads)
    wall_s = time.monotonic() - started
    settled_s = json.loads((folder / "packing.json").read_bytes())["settling_s"]
    particle_steps = count * settled_s / recipe["step_s"]
    made = Settling(wall_s, threads, 1e9 * wall_s / particle_steps, solver_sha256())
    write_whole(_note(folder), json.dumps(asdict(made)).encode())
    return packing


def settling(case: Case, workspace: Workspace) -> Settling | None:
    """Of the bed of `case`; None where another build of the solver made it, or that is not known."""
    try:
        made = Settling(**json.loads(_note(_folder(case, workspace)).read_bytes()))
    except (FileNotFoundError, TypeError):  # killed before the note, or a note of another crossdem
        return None
    return made if made.solver_sha256 == solver_sha256() else None


def _note(folder: Path) -> Path:
    """Lies beside a bed's folder."""
    return folder.with_suffix(".json")


def _folder(case: Case, workspace: Workspace) -> Path:
    count = case.resolved["particles"]["count"]
    return workspace.root / "packings" / f"seed{SEED}-{count}-{case.run_hash[:12]}"
