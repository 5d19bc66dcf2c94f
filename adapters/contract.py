"""The contract with a user's code: the files that it leaves, read as a Dataset. docs/own_engine.md says it to people.

motion.csv, resistance.csv and run.json, in SI units. Other names of columns, other units and other files are told by
Columns. Whatever is not as it must be is said in one go.
"""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import pandas as pd

from .case import Case
from .dataset import RESISTANCE_COLUMNS, Dataset, Motion
from .dataset_faults import bar_speed_m_s
from .engine import EngineFailure
from .packing import Packing

MOTION_COLUMNS = (
    "time_s",  # 0 at the end of the rest, when the bar starts
    "id",  # as in packing.csv
    "x_m",
    "y_m",
    "velocity_x_m_s",
    "velocity_y_m_s",
    "angular_velocity_rad_s",  # counter-clockwise > 0
)
ANGLE = "angle_rad"  # where the code keeps one; 0 at the packing
TABLES = {
    "motion": ("motion.csv", (*MOTION_COLUMNS, ANGLE)),
    "resistance": ("resistance.csv", RESISTANCE_COLUMNS),
}
RUN_JSON = "run.json"
TIMES_APART_S = 1e-9  # rows of one frame
# By the last part of a column's name, which is its unit here: others, and how many of it they are.
UNITS = {
    "s": {"s": 1.0, "ms": 1e-3, "us": 1e-6},
    "m": {"m": 1.0, "cm": 1e-2, "mm": 1e-3, "um": 1e-6},
    "m_s": {"m/s": 1.0, "cm/s": 1e-2, "mm/s": 1e-3},
    "rad_s": {"rad/s": 1.0, "deg/s": np.pi / 180, "rpm": np.pi / 30},
    "rad": {"rad": 1.0, "deg": np.pi / 180},
    "N": {"N": 1.0, "kN": 1e3, "mN": 1e-3, "dyn": 1e-5},
    "J": {"J": 1.0, "mJ": 1e-3, "uJ": 1e-6, "erg": 1e-7},
}


@dataclass(frozen=True)
class Column:
    """Where a column of the contract is found."""

    name: str
    factor: float = 1.0  # from its unit to SI


@dataclass(frozen=True)
class Columns:
    """How a table of a code is read."""

    files: str | None = None  # pattern, in the output folder; None: the contract's
    separator: str = ","  # " ": any white space
    columns: Mapping[str, Column] = field(
        default_factory=dict
    )  # those that have other names or units


def unit_of(column: str) -> str | None:
    """The key of UNITS that `column` of the contract is in; None for a plain number."""
    return next(
        (unit for unit in sorted(UNITS, key=len, reverse=True) if column.endswith(f"_{unit}")), None
    )


def read_contract(
    engine: str,
    tables: Mapping[str, Columns],
    case: Case,
    packing: Packing,
    output: Path,
    manifest: dict,
) -> Dataset:
    """What a code left in `output`. Raises EngineFailure, DatasetError with all that is wrong of a kind."""
    faults = _run_faults(output / RUN_JSON, manifest)
    found = {}
    for name, (file, columns) in TABLES.items():
        try:
            found[name] = _read(output, tables.get(name, Columns()), file, columns)
        except ValueError as error:
            faults.append(str(error))
    if not faults:
        try:
            motion = _motion(found["motion"], case, packing)
        except ValueError as error:
            faults.append(str(error))
    if faults:
        raise EngineFailure(f"does not keep the contract: {'; '.join(faults)}")
    radius_m = packing.particles["radius_m"].to_numpy(dtype=float)
    return Dataset(case.resolved, manifest, radius_m, motion, found["resistance"])


def _run_faults(path: Path, manifest: dict) -> list[str]:
    """Why the code's own account of its run is none of this run."""
    try:
        said = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError, RecursionError) as error:
        return [f"no readable {path.name} ({error})"]
    if not isinstance(said, dict):
        return [f"{path.name} holds no object"]
    expected = {
        "completed": True,
        "frames": manifest["frames"],
        "particles": manifest["particles"],
        "engine": manifest["engine"],
        "version": manifest["engine_version"],
    }
    return [
        f"{path.name}: {key} is {json.dumps(said[key]) if key in said else 'missing'}, expected {json.dumps(value)}"
        for key, value in expected.items()
        if key not in said or type(said[key]) is not type(value) or said[key] != value
    ]


def _read(output: Path, table: Columns, file: str, wanted: tuple[str, ...]) -> pd.DataFrame:
    """The columns that the contract names, in SI units. Raises ValueError."""
    paths = sorted(output.glob(table.files or file), key=_by_number)
    if not paths:
        raise ValueError(f"there is no {table.files or file}")
    separator = r"\s+" if table.separator == " " else table.separator
    parts = []
    for path in paths:
        try:
            parts.append(pd.read_csv(path, sep=separator, float_precision="round_trip"))
        except (OSError, ValueError) as error:
            raise ValueError(
                f"{path.name} cannot be read ({' '.join(str(error).split())})"
            ) from error
    found = pd.concat(parts, ignore_index=True)
    sources = {name: table.columns.get(name, Column(name)) for name in wanted}
    if ANGLE in sources and sources[ANGLE].name not in found:
        del sources[ANGLE]
    missing = [source.name for source in sources.values() if source.name not in found]
    if missing:
        there = ", ".join(map(str, found.columns))
        raise ValueError(f"{paths[0].name} lacks the columns {', '.join(missing)}; it has {there}")
    taken = {}
    for name, source in sources.items():
        values = pd.to_numeric(found[source.name], errors="coerce")
        if bad := int((~np.isfinite(values)).sum()):
            raise ValueError(
                f"{paths[0].name}: {bad} values of {source.name} are not finite numbers"
            )
        taken[name] = values if source.factor == 1.0 else values * source.factor
    return pd.DataFrame(taken)


def _by_number(path: Path) -> tuple:
    """Files of frames in the order of the numbers in their names, whatever zeros these start with."""
    return tuple(int(part) if part.isdigit() else part for part in re.split(r"(\d+)", path.name))


def _motion(table: pd.DataFrame, case: Case, packing: Packing) -> Motion:
    """Raises ValueError where the frames do not hold every particle of the packing once."""
    particles = len(packing.particles)
    ids = table["id"]
    if (ids != np.rint(ids)).any() or not ids.between(0, particles - 1).all():
        raise ValueError(f"motion: its ids are not those of the packing, 0 to {particles - 1}")
    frames, rest = divmod(len(table), particles)
    table = table.sort_values(["time_s", "id"], kind="stable")
    time_s = table["time_s"].to_numpy()
    if rest or not np.array_equal(table["id"], np.tile(np.arange(particles), frames)):
        times = table.groupby("time_s")["id"].nunique()
        torn = times[times != particles]
        where = (
            f" (the frame at {torn.index[0]:.6g} s has {torn.iloc[0]} of {particles})"
            if len(torn)
            else ""
        )
        raise ValueError(f"motion: not every frame holds every particle once{where}")
    time_s = time_s.reshape(frames, particles)
    if np.ptp(time_s, axis=1).max(initial=0.0) > TIMES_APART_S:
        raise ValueError("motion: the rows of a frame are of different times")

    def values(*names: str) -> np.ndarray:
        return np.stack([table[name].to_numpy().reshape(frames, particles) for name in names], -1)

    time_s = time_s[:, 0]
    speed_m_s = bar_speed_m_s(case.resolved)
    return Motion(
        time_s=time_s,
        position_m=values("x_m", "y_m"),
        velocity_m_s=values("velocity_x_m_s", "velocity_y_m_s"),
        angular_velocity_rad_s=values("angular_velocity_rad_s")[..., 0],
        angle_rad=values(ANGLE)[..., 0] if ANGLE in table else None,
        bar_tip_m=packing.bar_tip_m - speed_m_s * time_s if "bar" in case.resolved else None,
    )
