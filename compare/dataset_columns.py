"""What every table and every dataset of a package means: from the definitions by which the code writes and checks them."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import h5py

from crossdem.adapters.contract import unit_of
from crossdem.adapters.dataset_faults import RESISTANCE
from crossdem.adapters.motion_file import DATASETS
from crossdem.adapters.packing import PACKING

from .quantities import QUANTITIES

WHOLE_NUMBERS = {"seed", "twin", "id", "contacts", "particles", "frames", "samples"}
TEXTS = {"engine", "engine_version", "folder", "content_sha256", "packing_sha256"}
RUN_COLUMNS = {
    "engine": "the code that ran",
    "seed": "number of the packing, from 1",
    "twin": "0: started from the packing itself; k: with one particle k x 1e-12 m further to the right",
}
ABOUT_COLUMNS = {
    "folder": "where the run lies in this package",
    "engine_version": "as the code names itself",
    "time_step_s": "of the integration",
    "particles": "discs in the bed",
    "frames": "in motion.h5",
    "samples": "rows of resistance.csv",
    "packing_sha256": "of the packing.csv that it started from",
    "content_sha256": "of all numbers in motion.h5 and resistance.csv, whatever wrote these files",
}
BIN = "mean resistance over 1 cm of depth about this depth [m]"


@dataclass(frozen=True)
class Column:
    """One column of a table, or one dataset of an HDF5 file."""

    name: str
    unit: str  # "1" for a plain number, "" for what is no number
    definition: str

    @property
    def type(self) -> str:
        """Of a Table Schema."""
        if self.name in TEXTS:
            return "string"
        return "integer" if self.name in WHOLE_NUMBERS else "number"


def tables(depths_m: list[float]) -> dict[str, list[Column]]:
    """The columns of each kind of table, by the pattern of its path. `depths_m`: middles of the bins of a profile."""
    run = _columns(RUN_COLUMNS)
    return {
        "packings/*/packing.csv": _columns(PACKING),
        "runs/*/inputs/packing.csv": _columns(PACKING),
        "runs/*/resistance.csv": _columns(RESISTANCE),
        "tables/runs.csv": run + _columns(ABOUT_COLUMNS),
        "tables/endpoints.csv": run
        + [Column(one.name, one.unit or "1", one.definition) for one in QUANTITIES.values()],
        "tables/resistance_per_cm.csv": run
        + [Column(str(depth_m), "N", BIN) for depth_m in depths_m],
    }


def motion_columns(path: Path) -> list[Column]:
    """The datasets of a motion file, each with the unit that stands beside it there."""
    with h5py.File(path, "r") as file:
        return [
            Column(name, file[name].attrs.get("unit", "1"), text)
            for name, text in DATASETS.items()
            if name in file
        ]


def _columns(definitions: dict[str, str]) -> list[Column]:
    return [Column(name, _unit(name), text) for name, text in definitions.items()]


def _unit(name: str) -> str:
    if name in TEXTS:
        return ""
    return (unit_of(name) or "1").replace("_", "/")
