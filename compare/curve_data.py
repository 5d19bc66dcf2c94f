"""The curves that can be zoomed in the report (assets/curves.js): mean and scatter of each engine's packings."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pandas as pd

from . import motion, resistance
from .colours import engine_styles
from .comparison import Comparison

ROUND_OFF = 6  # digits that count: the depths of two engines differ by round-off


def curve_data(comparison: Comparison) -> dict[str, dict]:
    """By the name of the plot: the texts of its axes, x, and of each engine mean, low and high at each x.

    low and high: the mean -+ the standard deviation from packing to packing; null for a single one.
    """
    return {
        name: {
            "x_label": table.index.name,
            "y_label": y_label,
            "spans_gaps": name
            == "resistance",  # where engines have other depths; a surface ends at the bar
            "x": table.index.to_numpy().tolist(),
            "engines": [
                {"engine": engine, "colour": style.colour}
                | {column: _numbers(table[engine][column]) for column in ("mean", "low", "high")}
                for engine, style in engine_styles(comparison.engines).items()
                if engine in table
            ],
        }
        for name, (table, y_label) in curve_tables(comparison).items()
        if len(table)
    }


def curve_tables(comparison: Comparison) -> dict[str, tuple[pd.DataFrame, str]]:
    """By the name of the plot: a table indexed by x, with columns (engine, mean | low | high), and what they are."""
    depth = "depth of the tip, cm"
    return {
        "resistance": (_table(comparison, _resistance_N, depth), "resistance, N"),
        "movement": (_table(comparison, _movement_mm, depth), "downward movement, mm"),
        "surface": (_table(comparison, _surface_cm, "x, cm"), "height of the surface, cm"),
    }


def _resistance_N(comparison: Comparison, engine: str) -> list[pd.Series]:
    """Means of 1 mm of depth of the first run of each packing; of recorded packings per cm, mean of their twins."""
    profiles = [
        resistance.resistance_profile(run.resistance, resistance.FINE_BIN_M)["mean_N"]
        for run in comparison.of(engine)
    ] or [profile for _, profile in comparison.packings(engine).iterrows()]
    return [_curve(100 * profile.index, profile) for profile in profiles]


def _movement_mm(comparison: Comparison, engine: str) -> list[pd.Series]:
    speed_cm_s = 100 * comparison.case.resolved["bar"]["speed_m_s"]
    histories = [motion.near_bar_history(run)["downward_m"] for run in comparison.of(engine)]
    return [_curve(speed_cm_s * history.index, 1000 * history) for history in histories]


def _surface_cm(comparison: Comparison, engine: str) -> list[pd.Series]:
    """At the end."""
    profiles = [motion.surface_profile(run) for run in comparison.of(engine)]
    return [_curve(100 * profile.index, 100 * profile) for profile in profiles]


def _curve(x, values: pd.Series) -> pd.Series:
    return pd.Series(values.to_numpy(), np.round(x.to_numpy(dtype=float), ROUND_OFF))


def _table(comparison: Comparison, curves_of: Callable, x_label: str) -> pd.DataFrame:
    found = {
        engine: _mean_and_scatter(pd.concat(curves, axis="columns"))
        for engine in comparison.engines
        if (curves := curves_of(comparison, engine))
    }
    if not found:
        return pd.DataFrame()
    return pd.concat(found, axis="columns").sort_index().rename_axis(x_label)


def _mean_and_scatter(curves: pd.DataFrame) -> pd.DataFrame:
    mean, scatter = curves.mean(axis="columns"), curves.std(axis="columns", ddof=1)
    return pd.DataFrame({"mean": mean, "low": mean - scatter, "high": mean + scatter})


def _numbers(values: pd.Series) -> list[float | None]:
    """As JSON has them: no NaN, and no more digits than a screen shows."""
    return [None if np.isnan(value) else float(f"{value:.6g}") for value in values]
