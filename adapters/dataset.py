"""The dataset: what one finished run leaves behind. The only definition of it; whatever reads results reads this."""

from __future__ import annotations

import hashlib
import json
import os
import shutil
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd

from .dataset_faults import RESISTANCE_COLUMNS, faults
from .files import refuse_special_files
from .motion_file import Motion, MotionFileError, read_motion, write_motion

__all__ = ["RESISTANCE_COLUMNS", "Dataset", "DatasetError", "Motion", "read_motion", "write_motion"]


class DatasetError(Exception):
    """Data that are not a whole, sane run of their case; the text lists every fault."""


@dataclass(frozen=True)
class Dataset:
    """A whole run of one engine on one packing; anything less cannot be constructed."""

    case: dict  # the resolved case, SI
    manifest: dict  # engine, versions, time step, provenance, gates
    radius_m: np.ndarray  # (N,)
    motion: Motion
    resistance: pd.DataFrame  # RESISTANCE_COLUMNS, one row per sample

    def __post_init__(self) -> None:
        found = faults(self.case, self.manifest, self.radius_m, self.motion, self.resistance)
        if found:
            raise DatasetError("; ".join(found))

    @property
    def engine(self) -> str:
        return self.manifest["engine"]

    @property
    def seed(self) -> int:
        return self.manifest["seed"]

    @property
    def twin(self) -> int:
        """Which of the packing's twins it started from: 0 is the packing as it was settled."""
        return self.manifest["twin"]

    def write(
        self, folder: Path, extra_files_from: Path | None = None, without: str | None = None
    ) -> None:
        """Write into the new `folder`, whole or not at all, with a copy of `extra_files_from` (inputs, log) `without`
        the entries of that name.

        It is written beside, forced to the disk and renamed: a kill leaves nothing that looks complete.
        """
        folder = Path(folder)
        folder.parent.mkdir(parents=True, exist_ok=True)
        partial = folder.with_name(f".{folder.name}.partial")
        shutil.rmtree(partial, ignore_errors=True)
        try:
            if extra_files_from is None:
                partial.mkdir()
            else:
                left_out = shutil.ignore_patterns(*filter(None, [without]))
                shutil.copytree(extra_files_from, partial, ignore=left_out)
            self._write_files(partial)
            _force_to_disk(partial)
            os.rename(partial, folder)  # refuses a folder that is there and not empty
        except OSError:
            shutil.rmtree(partial, ignore_errors=True)
            raise
        _sync(folder.parent)

    def _write_files(self, folder: Path) -> None:
        write_motion(
            folder / "motion.h5",
            self.motion,
            self.radius_m,
            self.engine,
            self.manifest["engine_version"],
            box_m=(self.case["container"]["width_m"], self.case["container"]["height_m"]),
            time_step_s=self.manifest["time_step_s"],
        )
        # to_csv writes the shortest digits that read back the same
        self.resistance.to_csv(folder / "resistance.csv", index=False)
        self._write_manifest(folder / "manifest.json")

    def write_manifest(self, folder: Path) -> None:
        """Replace the manifest of this run's `folder`, at once."""
        partial = Path(folder) / ".manifest.json.partial"
        self._write_manifest(partial)
        _sync(partial)
        os.rename(partial, Path(folder) / "manifest.json")
        _sync(Path(folder))

    def _write_manifest(self, path: Path) -> None:
        path.write_text(json.dumps(self.manifest, indent=2) + "\n", encoding="utf-8")

    @staticmethod
    def read(folder: Path) -> Dataset:
        """The run in `folder`. Raises DatasetError for a folder that is not one, is damaged, or was changed by hand."""
        folder = Path(folder)
        try:
            refuse_special_files(folder)
            manifest = json.loads((folder / "manifest.json").read_text(encoding="utf-8"))
            case_bytes = (folder / "inputs" / "case.json").read_bytes()
            packing_bytes = (folder / "inputs" / "packing.csv").read_bytes()
            case = json.loads(case_bytes)
            resistance = pd.read_csv(folder / "resistance.csv", float_precision="round_trip")
            motion, radius_m = read_motion(folder / "motion.h5")
        except (OSError, ValueError, RecursionError, MotionFileError) as error:
            raise DatasetError(
                f"{folder}: not a finished run ({error}); give run folders such as OUT/runs/*"
            ) from error
        if not isinstance(manifest, dict) or not isinstance(case, dict):
            raise DatasetError(
                f"{folder}: manifest.json and inputs/case.json must each hold an object"
            )
        for name, content, key in (
            ("case.json", case_bytes, "case_hash"),
            ("packing.csv", packing_bytes, "packing_hash"),
        ):
            if hashlib.sha256(content).hexdigest() != manifest.get(key):
                raise DatasetError(
                    f"{folder}: inputs/{name} is not what the manifest's {key} names"
                )
        try:
            return Dataset(case, manifest, radius_m, motion, resistance)
        except DatasetError as error:
            raise DatasetError(f"{folder}: {error}") from error


def _force_to_disk(folder: Path) -> None:
    for path in sorted(folder.rglob("*"), reverse=True):
        _sync(path)
    _sync(folder)


def _sync(path: Path) -> None:
    descriptor = os.open(path, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
