"""What the studies read of runs: one row per packing, a few hundred numbers, and the folder for pictures of the bed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import pandas as pd

from crossdem.adapters.dataset import Dataset

from .. import motion
from ..quantities import QUANTITIES
from ..resistance import FINE_BIN_M, resistance_profile
from ..variants import VariantRun
from .spectrum import fluctuation_share, median_wavelength_m, spectrum

FLUCTUATION = "fluctuation_N"  # of the QUANTITIES
SHARE, WAVELENGTH = "fluctuation_share", "median_wavelength_m"  # beside them


@dataclass(frozen=True)
class Sample:
    """The runs of one setting in one engine. Tables have a row per packing, indexed by its seed."""

    # A column per quantity of QUANTITIES, SHARE and WAVELENGTH; `with_restless` also of the runs that failed a gate.
    endpoints: pd.DataFrame
    with_restless: pd.DataFrame
    profiles: pd.DataFrame  # mean resistance [N]; columns: depth [m]
    spectra: pd.DataFrame  # [N^2 m]; columns: cycles per m of depth
    layers: pd.DataFrame  # as layer_movement() gives it, mean of the packings
    folders: dict[int, Path]
    manifests: tuple[dict, ...]
    failures: tuple[str, ...]  # runs without result, for people
    restless: tuple[str, ...]  # runs that failed a gate, for people; they are in no other table

    def __getitem__(self, quantity: str) -> pd.Series:
        return self.endpoints[quantity]

    @property
    def packings(self) -> int:
        return len(self.endpoints)

    @property
    def left_out(self) -> tuple[str, ...]:
        return self.failures + self.restless

    def first(self) -> Dataset | None:
        """Of the first packing."""
        return Dataset.read(self.folders[min(self.folders)]) if self.folders else None


def observe(runs: Sequence[VariantRun], unsettled: Sequence[str] = ()) -> Sample:
    """Reads each dataset once and keeps none. A run that failed a gate is left out. `unsettled`: beds without runs."""
    every, sound, profiles, spectra, layers, folders = {}, [], {}, {}, [], {}
    manifests, failures, restless = [], list(unsettled), []
    for run in runs:
        seed = run.packing.seed
        if run.failure:
            failures.append(f"seed {seed}: {run.failure}")
            continue
        dataset = run.dataset()
        manifests.append(dataset.manifest)
        table = dataset.resistance
        every[seed] = {name: one.of(dataset) for name, one in QUANTITIES.items()} | {
            SHARE: fluctuation_share(table),
            WAVELENGTH: median_wavelength_m(table),
        }
        failed = [gate["message"] for gate in dataset.manifest["gates"] if not gate["passed"]]
        if failed:
            restless.append(f"seed {seed}: {'; '.join(failed)}")
            continue
        sound.append(seed)
        profiles[seed] = resistance_profile(table, FINE_BIN_M)["mean_N"]
        spectra[seed] = spectrum(table)
        layers.append(layer_movement(dataset))
        folders[seed] = run.folder
    columns = [*QUANTITIES, SHARE, WAVELENGTH]
    endpoints = pd.DataFrame.from_dict(every, orient="index", columns=columns, dtype=float)
    return Sample(
        endpoints.loc[sound].rename_axis("seed"),
        endpoints.rename_axis("seed"),
        _by_seed(profiles),
        _by_seed(spectra),
        pd.concat(layers, axis="columns").T.groupby(level=0).mean().T if layers else pd.DataFrame(),
        folders,
        tuple(manifests),
        tuple(failures),
        tuple(restless),
    )


def layer_movement(dataset: Dataset) -> pd.DataFrame:
    """Mean downward movement [m] of the particles near the bar since t = 0; a column per layer in which they started,
    from 0 at the floor, indexed by time_s."""
    near, layers = motion.near_bar(dataset), motion.layers(dataset)
    height_m = dataset.motion.position_m[:, :, 1]
    columns = {
        int(layer): (height_m[0, chosen] - height_m[:, chosen]).mean(axis=1)
        for layer in sorted(set(layers[near]))
        for chosen in [near & (layers == layer)]
    }
    return pd.DataFrame(columns, index=pd.Index(dataset.motion.time_s, name="time_s"))


def _by_seed(rows: dict[int, dict | pd.Series]) -> pd.DataFrame:
    return pd.DataFrame.from_dict(rows, orient="index").rename_axis("seed").sort_index()
