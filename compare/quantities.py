"""The quantities that a check can name: one number per run, each with its unit and definition."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import pandas as pd

from crossdem.adapters.dataset import Dataset
from crossdem.adapters.names import unknown_name

from . import motion, resistance


SHOWN_UNITS = {
    "m": (1e3, "mm"),
    "J": (1e3, "mJ"),
}  # SI unit: factor and unit of a size that reads well


@dataclass(frozen=True)
class Quantity:
    """One number of a run: a function of its resistance table, or of the whole dataset."""

    title: str  # as people say it
    unit: str  # "" for a plain number
    function: Callable[..., float]
    of_table: bool = False
    own_shown_unit: tuple[float, str] | None = None  # where SHOWN_UNITS has none that reads well

    @property
    def shown_unit(self) -> tuple[float, str]:
        """The factor from `unit` to the unit that people read, and that unit."""
        return self.own_shown_unit or SHOWN_UNITS.get(self.unit, (1.0, self.unit))

    @property
    def name(self) -> str:
        """As in the case's [[check]] tables, unit included."""
        return self.function.__name__

    @property
    def definition(self) -> str:
        return " ".join((self.function.__doc__ or "").split())

    def of(self, dataset: Dataset) -> float:
        with np.errstate(
            all="ignore"
        ):  # where it has no value, such as a share of nothing, it is NaN
            return self.function(dataset.resistance if self.of_table else dataset)


QUANTITIES = {
    quantity.name: quantity
    for quantity in (
        Quantity("mean resistance", "N", resistance.mean_resistance_N, of_table=True),
        Quantity("work of the bar", "J", resistance.work_J, of_table=True),
        Quantity("slope over depth", "N/m", resistance.resistance_slope_N_m, of_table=True),
        Quantity("exponent over depth", "", resistance.resistance_exponent, of_table=True),
        Quantity("bearing factor", "", resistance.bearing_factor),
        Quantity("tip share", "", resistance.tip_share, of_table=True),
        Quantity("shaft share", "", resistance.shaft_share, of_table=True),
        Quantity("fluctuation", "N", resistance.fluctuation_N, of_table=True),
        Quantity("contacts per particle", "", resistance.contacts_per_particle),
        Quantity("kinetic energy", "J", resistance.kinetic_energy_J, True, (1e6, "µJ")),
        Quantity("surface heave", "m", motion.surface_heave_m),
        Quantity("surface bump", "m", motion.surface_bump_m),
        Quantity("movement near the bar", "m", motion.near_bar_movement_m),
    )
}


def check_tables(case: dict) -> list[tuple[int, dict]]:
    """The [[check]] tables of a case, numbered."""
    return numbered_tables(case, "check")


def numbered_tables(case: dict, key: str) -> list[tuple[int, dict]]:
    """The tables of a list in a case, numbered; what stands there and is no table is the schema's business."""
    entries = case.get(key, [])
    numbered = enumerate(entries if isinstance(entries, list) else [])
    return [(number, entry) for number, entry in numbered if isinstance(entry, dict)]


def unknown_quantities(case: dict) -> list[str]:
    """A fault line for each check of `case`, resolved or as read, that names no quantity known here."""
    lines = []
    for number, check in check_tables(case):
        name = check.get("quantity")
        if name in QUANTITIES or not isinstance(name, str):
            continue
        lines.append(f"check[{number}].quantity: {unknown_name('quantity', name, QUANTITIES)}")
    return lines
