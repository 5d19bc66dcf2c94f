"""A run's folder: what goes in before the engine starts, and the names by which runs are found again."""

from __future__ import annotations

import hashlib
import shlex
import shutil
from dataclasses import dataclass
from pathlib import Path

from . import mpi
from .case import Case
from .engine import INPUTS, OUTPUT, Code, Engine
from .packing import Packing


@dataclass(frozen=True)
class RunRequest:
    """One engine on one packing."""

    case: Case
    packing: Packing
    engine_name: str
    ranks: int = 1  # MPI processes that share the bed


def run_key(case: Case, packing: Packing, engine: Engine, ranks: int = 1) -> str:
    """SHA-256 [hex] of all that the result depends on. Raises EngineNotFound."""
    parts = [case.run_hash, packing.hash, engine.name, engine.version(), engine.digest()]
    if ranks > 1:  # they sum forces in another order
        parts.append(f"{ranks} ranks")
    return hashlib.sha256("\n".join(parts).encode()).hexdigest()


def run_name(packing: Packing, engine: Engine, key: str) -> str:
    """The folder's name."""
    twin = f"-twin{packing.twin}" if packing.twin else ""
    return f"{engine.name}-seed{packing.seed}{twin}-{key[:12]}"


def command(case: Case, engine: Code, folder: Path, ranks: int = 1) -> list[str]:
    """The command that starts the run in `folder`, as people would type it."""
    return mpi.with_ranks(engine.command(case, folder), ranks)


def environment(engine: Code, ranks: int = 1) -> dict[str, str]:
    """Variables that are set for it."""
    return engine.environment() | mpi.settings(ranks)


def prepare(case: Case, packing: Packing, engine: Code, folder: Path, ranks: int = 1) -> None:
    """Fill the new `folder` with all that a run reads, and with a README that says how to start it by hand."""
    (folder / INPUTS).mkdir(parents=True)
    (folder / OUTPUT).mkdir()
    (folder / INPUTS / "case.json").write_bytes(case.canonical)
    for name in ("packing.csv", "packing.json"):
        shutil.copyfile(packing.folder / name, folder / INPUTS / name)
    engine.write_input(case, packing, folder)
    (folder / "README.txt").write_text(
        _readme(case, packing, engine, folder, ranks), encoding="utf-8"
    )


def rerun_command(case: Case, engine: Code, folder: Path, ranks: int = 1) -> str:
    """The one shell command that runs the engine by hand, in `folder`."""
    settings = (
        f"{name}={shlex.quote(value)}" for name, value in environment(engine, ranks).items()
    )
    words = shlex.join(command(case, engine, folder, ranks))
    return f"rm -rf {OUTPUT} && mkdir {OUTPUT} && {' '.join(settings)} {words}"


def _readme(case: Case, packing: Packing, engine: Code, folder: Path, ranks: int) -> str:
    return f"""\
{case.name}, seed {packing.seed}, by {engine.name}

To run it again by hand, in a copy of this folder:

    {rerun_command(case, engine, folder, ranks)}

{engine.by_hand}

{INPUTS}/    all that the engine reads
{OUTPUT}/    what it then writes

Once finished, a run has beside these
manifest.json    versions, time step, provenance, gates
motion.h5        positions and velocities (H5MD 1.1)
resistance.csv   forces on the bar
engine.log       what the engine said
"""
