"""The ensemble: what the judge reads of the runs of a case, a few hundred numbers a run and no particle.

Design: packings (seeds), and on each of them the same number of runs that start SHIFT_M apart, its twins. Twins scatter
by chaos alone, packings by their beds, too; only packings are independent of one another, so a packing counts once.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import pandas as pd

from crossdem.adapters.dataset import Dataset
from crossdem.adapters.gates import CONTACTS_AT_REST, contacts_at_rest

from .motion import displacement_field
from .quantities import QUANTITIES
from .resistance import resistance_profile

RUN = ["engine", "seed", "twin"]  # what names a run of one case
PACKING = ["engine", "seed"]  # what names the mean over its twins


@dataclass(frozen=True)
class Ensemble:
    """Each table has one row per run, indexed by RUN, in the order of engines, then seeds, then twins."""

    endpoints: pd.DataFrame  # a column per quantity
    profiles: pd.DataFrame  # mean resistance [N] per cm; columns: depth_m, the middles of the bins
    fields: pd.DataFrame  # displacement [m] at the end; columns: (component, x_m, y_m) of the cells; NaN: empty cell
    manifests: dict[tuple[str, int, int], dict]  # by RUN; with CONTACTS_AT_REST

    @classmethod
    def of(cls, datasets: Iterable[Dataset]) -> "Ensemble":
        """Reads each dataset once and keeps none."""
        endpoints, profiles, fields, manifests = {}, {}, {}, {}
        for dataset in datasets:
            run = (dataset.engine, dataset.seed, dataset.twin)
            endpoints[run] = pd.Series({name: one.of(dataset) for name, one in QUANTITIES.items()})
            profiles[run] = resistance_profile(dataset.resistance)["mean_N"]
            fields[run] = _field(dataset)
            manifests[run] = dataset.manifest | {CONTACTS_AT_REST: contacts_at_rest(dataset)}
        return cls(_table(endpoints), _table(profiles), _table(fields), manifests)

    @property
    def engines(self) -> tuple[str, ...]:
        return tuple(dict.fromkeys(engine for engine, _, _ in self.manifests))

    @property
    def runs_each(self) -> list[int]:
        """How many runs each packing of each engine has: the packing as it was settled, and its twins."""
        return self.endpoints.groupby(level=PACKING).size().tolist()

    def joined(self, other: "Ensemble") -> "Ensemble":
        """The runs of both, which must have none in common."""
        tables = (
            pd.concat([getattr(one, name) for one in (self, other)], verify_integrity=True)
            for name in ("endpoints", "profiles", "fields")
        )
        return Ensemble(*tables, self.manifests | other.manifests)

    def selected(self, runs: Iterable[tuple[str, int, int]]) -> "Ensemble":
        """These of its runs, in this order."""
        runs = list(runs)
        tables = (getattr(self, name).loc[runs] for name in ("endpoints", "profiles", "fields"))
        return Ensemble(*tables, {run: self.manifests[run] for run in runs})


def of_engine(table: pd.DataFrame, engine: str) -> pd.DataFrame:
    """The rows of one engine, without that level of their index; none for an engine without runs."""
    return table[table.index.get_level_values("engine") == engine].droplevel("engine")


def packing_means(table: pd.DataFrame) -> pd.DataFrame:
    """The mean over the twins of each packing, indexed by PACKING; NaN where it is NaN for one of them."""
    by_packing = table.groupby(level=PACKING, sort=False)
    return by_packing.mean().mask(table.isna().groupby(level=PACKING, sort=False).any())


def _field(dataset: Dataset) -> pd.Series:
    field = displacement_field(dataset)
    components = {c: field[f"displacement_{c}_m"] for c in ("x", "y")}
    return pd.concat(components, names=["component"])


def _table(rows: dict[tuple[str, int, int], pd.Series]) -> pd.DataFrame:
    if not rows:
        return pd.DataFrame(index=pd.MultiIndex.from_arrays([[], [], []], names=RUN))
    table = pd.concat(rows, axis="columns", names=RUN).T
    return table.sort_index(axis="columns") if table.columns.nlevels > 1 else table
