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
IMPULSE = "impulse that the particles have received since the start"
_WALLS = {
    "left_wall": "from the left wall",
    "right_wall": "from the right wall",
    "floor": "from the floor",
    "bar": "from the bar",
    "weight": "from their weight",
}
LEDGER = {
    "time_s": "since the rest was over, as in resistance.csv; the ledgers count from the start of the rest",
    **{f"momentum_change_{axis}_Ns": f"of the sum of m v, {axis}" for axis in "xy"},
    **{
        f"{name}_{axis}_Ns": f"{IMPULSE} {whence}, {axis}"
        for name, whence in _WALLS.items()
        for axis in "xy"
    },
    **{
        f"residual_{axis}_Ns": f"momentum_change less all impulses, {axis}: rounding"
        for axis in "xy"
    },
    "kinetic_J": "energy of translation and rotation, now",
    "spring_J": "energy in the springs of all contacts, now",
    "potential_change_J": "of the sum of m g y, since the start",
    "bar_work_J": "done by the bar on the particles, since the start",
    "contact_work_J": "taken up by contacts, since the start: sum of force times relative displacement",
    "dissipated_J": "contact_work less the change of spring: lost in dashpots and in slip",
    "integration_J": "added by the integrator itself: change of kinetic, potential_change and contact_work less bar_work",
}
MANIFEST = {
    "schema_version": "of this file",
    "case_name": "name in case.json",
    "case_hash": "SHA-256 of inputs/case.json",
    "packing_hash": "SHA-256 of inputs/packing.csv",
    "seed": RUN_COLUMNS["seed"],
    "twin": RUN_COLUMNS["twin"],
    "engine": RUN_COLUMNS["engine"],
    "engine_version": ABOUT_COLUMNS["engine_version"],
    "compiler": "and its flags, where the code tells them",
    "time_step_s": ABOUT_COLUMNS["time_step_s"],
    "command": "that made the run, in its folder",
    "started_utc": "when it was started",
    "wall_s": "how long it ran by the clock",
    "cpu_s": "processor time of all its processes",
    "particles": ABOUT_COLUMNS["particles"],
    "frames": ABOUT_COLUMNS["frames"],
    "samples": ABOUT_COLUMNS["samples"],
    "machine": "kind of processor and C library",
    "limitations": "in which the code departs from the paper's scheme",
    "gates": "what the run had to pass before it was compared",
    "run_key": "names the run: a hash of case, packing, code and adapter",
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
        "runs/*/ledger.csv": _columns(LEDGER),
        "tables/runs.csv": run + _columns(ABOUT_COLUMNS),
        "tables/endpoints.csv": run
        + [Column(one.name, one.unit or "1", one.definition) for one in QUANTITIES.values()],
        "tables/resistance_per_cm.csv": run
        + [Column(str(depth_m), "N", BIN) for depth_m in depths_m],
    }


def manifest_keys() -> list[Column]:
    """The keys of a run's manifest.json."""
    return [
        Column(name, _unit(name) if name.endswith("_s") else "", text)
        for name, text in MANIFEST.items()
    ]


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
    if name.endswith("_Ns"):
        return "N s"
    return (unit_of(name) or "1").replace("_", "/")
