"""The particles that every engine starts from, a settled bed or those of the case: made by the solver, then only read."""

import hashlib
import json
import shutil
from dataclasses import dataclass
from pathlib import Path
from tempfile import mkdtemp

import numpy as np
import pandas as pd

from .case import Case, CaseError
from .files import refuse_special_files
from .solver import call_solver, messages, solver_sha256

# Each column of packing.csv with its definition; the last part of a name is its unit.
PACKING = {
    "id": "number of the particle, from 0",
    "x_m": "centre, from the left wall; > 0 is to the right",
    "y_m": "centre, from the floor; > 0 is upwards",
    "radius_m": "radius of the disc",
    "velocity_x_m_s": "horizontal velocity; > 0 is to the right",
    "velocity_y_m_s": "vertical velocity; > 0 is upwards",
    "angular_velocity_rad_s": "angular velocity; > 0 is counter-clockwise",
}
COLUMNS = tuple(PACKING)


# How far the twins of a packing lie apart: far below any physics, far above the last bit of a position.
SHIFT_M = 1e-12


class PackingError(Exception):
    """A folder that holds no usable packing."""


@dataclass(frozen=True)
class Packing:
    """Discs, unrotated, with zero shear springs. `folder` holds packing.csv and packing.json."""

    seed: int
    particles: pd.DataFrame  # COLUMNS; ids 0, 1, ...; a settled bed is at rest
    bar_tip_m: float | None  # height of the bar's bottom face above the floor until the bar starts; None: no bar
    contacts: int  # pairs of particles
    hash: str  # SHA-256 [hex] of packing.csv
    folder: Path
    twin: int = 0  # 0: as it was settled; k: one particle lies k SHIFT_M further to the right

    @classmethod
    def read(cls, folder: Path) -> "Packing":
        """Raises PackingError when a file is missing, torn or does not fit the other."""
        folder = Path(folder)
        try:
            refuse_special_files(folder)
            table = (folder / "packing.csv").read_bytes()
            about = json.loads((folder / "packing.json").read_bytes())
            particles = pd.read_csv(folder / "packing.csv", float_precision="round_trip")
            _check(particles, about)
            return cls(
                seed=int(about["seed"]),
                particles=particles,
                bar_tip_m=None if about["bar_tip_m"] is None else float(about["bar_tip_m"]),
                contacts=int(about["contacts"]),
                hash=hashlib.sha256(table).hexdigest(),
                folder=folder,
                twin=int(about.get("twin", 0)),
            )
        except (OSError, ValueError, KeyError, TypeError) as error:
            raise PackingError(f"{folder} holds no packing: {error}") from error


def make_packing(case: Case, seed: int, folder: Path, threads: int = 1) -> Packing:
    """The packing in `folder`, made there by the solver, on at most so many threads, unless it is there already.

    It appears whole or not at all. Raises CaseError when the bed cannot be made from this case,
    SolverError when the solver fails.
    """
    folder = Path(folder)
    try:
        return Packing.read(folder)
    except PackingError:
        shutil.rmtree(folder, ignore_errors=True)
    folder.parent.mkdir(parents=True, exist_ok=True)
    unfinished = Path(mkdtemp(prefix=f".{folder.name}-", dir=folder.parent))
    try:
        options = [f"--seed={seed}", f"--threads={threads}", f"--file-name={case.file_name}"]
        done = call_solver(["pack", "-", *options, f"--output={unfinished}"], stdin=case.canonical)
        if done.returncode:
            raise CaseError(messages(done.stderr))
        unfinished.chmod(0o755)  # mkdtemp keeps others out
        unfinished.rename(folder)
    finally:
        shutil.rmtree(unfinished, ignore_errors=True)
    return Packing.read(folder)


def make_twin(packing: Packing, number: int, folder: Path) -> Packing:
    """The `number`th twin of a settled packing, made in `folder` unless it is there already, whole or not at all.

    Its particle in the middle of the bed lies number x SHIFT_M further to the right. 0 is the packing itself.
    """
    if number == 0:
        return packing
    try:
        return Packing.read(folder)
    except PackingError:
        shutil.rmtree(folder, ignore_errors=True)
    particles = packing.particles.copy()
    place_m = particles[["x_m", "y_m"]].to_numpy()
    middle = int(np.argmin(np.hypot(*(place_m - place_m.mean(axis=0)).T)))
    particles.loc[middle, "x_m"] += number * SHIFT_M
    about = json.loads((packing.folder / "packing.json").read_bytes()) | {"twin": number}
    unfinished = Path(mkdtemp(prefix=f".{folder.name}-", dir=folder.parent))
    try:
        particles.to_csv(unfinished / "packing.csv", index=False)
        (unfinished / "packing.json").write_text(json.dumps(about) + "\n", encoding="utf-8")
        unfinished.chmod(0o755)
        unfinished.rename(folder)
    finally:
        shutil.rmtree(unfinished, ignore_errors=True)
    return Packing.read(folder)


def packing_key(case: Case, seed: int) -> str:
    """Names a packing by all it is made from [hex]: the case, the seed and the program that settles it."""
    return hashlib.sha256(f"{case.run_hash} {seed} {solver_sha256()}".encode()).hexdigest()


def _check(particles: pd.DataFrame, about: dict) -> None:
    if tuple(particles.columns) != COLUMNS:
        raise ValueError(f"packing.csv has columns {', '.join(particles.columns)}")
    if len(particles) != about["particles"] or len(particles) == 0:
        raise ValueError(
            f"packing.csv has {len(particles)} rows for {about['particles']} particles"
        )
    if not np.isfinite(particles.to_numpy(dtype=float)).all():
        raise ValueError("packing.csv has values that are not finite")
    if not np.array_equal(particles["id"], np.arange(len(particles))):
        raise ValueError("packing.csv does not count its ids from 0")
