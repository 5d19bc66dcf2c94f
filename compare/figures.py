"""What the report's plots show, drawn on Matplotlib's axes; drawing.py makes pictures of them.

No text of a case or a dataset is drawn: titles and legends belong to the page.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import matplotlib
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.colors import BoundaryNorm
from matplotlib.patches import Rectangle

from . import motion, resistance
from .colours import EngineStyle, engine_styles
from .comparison import Comparison
from .drawing import INK

COLOUR_STEPS = 8


def draw_resistance(axes: Axes, comparison: Comparison) -> None:
    """Resistance against depth: thin for each packing (means of 1 mm; of recorded ones per cm), thick for their mean."""
    for engine, style in engine_styles(comparison.engines).items():
        packings = comparison.packings(engine)
        lines = [
            resistance.resistance_profile(run.resistance, resistance.FINE_BIN_M)["mean_N"]
            for run in comparison.of(engine)
        ] or [profile for _, profile in packings.iterrows()]
        faint = min(0.55, 4 / max(1, len(lines)))
        for fine in lines:
            axes.plot(100 * fine.index, fine, color=style.colour, linewidth=0.8, alpha=faint)
        if len(packings):
            mean = packings.mean()
            _thick(axes, 100 * mean.index, mean, style)
    axes.set(xlabel="depth of the tip, cm", ylabel="resistance, N")
    axes.set_xlim(left=0)


def draw_movement(axes: Axes, comparison: Comparison) -> None:
    """Mean downward displacement of the particles near the bar against depth, mean of all packings."""
    speed_m_s = comparison.case.resolved["bar"]["speed_m_s"]
    for engine, style in engine_styles(comparison.engines).items():
        runs = comparison.of(engine)
        if runs:
            history = pd.concat(
                [motion.near_bar_history(run)["downward_m"] for run in runs], axis="columns"
            )
            depth_cm = 100 * speed_m_s * history.index.to_numpy()
            _thick(axes, depth_cm, 1000 * history.mean(axis="columns"), style)
    axes.set(xlabel="depth of the tip, cm", ylabel="downward movement, mm")
    axes.set_xlim(left=0)


def draw_surface(axes: Axes, comparison: Comparison) -> None:
    """Surface of the bed at the end, mean of all packings; grey: at t = 0, mean of all runs."""
    before = [motion.surface_profile(run, 0) for run in comparison.datasets]
    start = pd.concat(before, axis="columns").mean(axis="columns")
    axes.plot(100 * start.index, 100 * start, color=INK, alpha=0.5, linewidth=1)
    for engine, style in engine_styles(comparison.engines).items():
        after = [motion.surface_profile(run) for run in comparison.of(engine)]
        if after:
            end = pd.concat(after, axis="columns").mean(axis="columns")
            _thick(axes, 100 * end.index, 100 * end, style)
    bar = comparison.case.resolved["bar"]
    left_cm = 100 * (bar["centre_x_m"] - bar["width_m"] / 2)
    axes.axvspan(left_cm, left_cm + 100 * bar["width_m"], color=INK, alpha=0.15, linewidth=0)
    axes.set(xlabel="x, cm", ylabel="height of the surface, cm")


def displacement_fields(comparison: Comparison) -> dict[str, pd.DataFrame]:
    """Displacement field at the end of each engine with datasets, mean of all packings."""
    return {
        engine: motion.field_over_seeds([motion.displacement_field(run) for run in runs])
        for engine in comparison.engines
        if (runs := comparison.of(engine))
    }


def draw_fields(
    comparison: Comparison, fields: dict[str, pd.DataFrame]
) -> dict[str, Callable[[Axes], None]]:
    """What draws each of the `fields`, in one scale of colours."""
    if not fields:
        return {}
    levels_mm = _levels_mm(max(_length_mm(field).max() for field in fields.values()))
    tip_m = comparison.datasets[0].motion.bar_tip_m[-1]
    return {
        engine: partial(
            _draw_field, field=field, comparison=comparison, tip_m=tip_m, levels_mm=levels_mm
        )
        for engine, field in fields.items()
    }


def _draw_field(axes: Axes, field: pd.DataFrame, comparison: Comparison, tip_m, levels_mm) -> None:
    case = comparison.case.resolved
    cell_cm = 100 * case["marks"]["cell_size_m"]
    x_cm, y_cm = (100 * field.index.get_level_values(name).to_numpy() for name in ("x_m", "y_m"))
    colours = matplotlib.colormaps["viridis"]
    norm = BoundaryNorm(levels_mm, colours.N)
    length_mm = _length_mm(field)
    for x, y, value in zip(x_cm - cell_cm / 2, y_cm - cell_cm / 2, length_mm):
        axes.add_patch(
            Rectangle((x, y), cell_cm, cell_cm, color=colours(norm(value)), linewidth=0.4)
        )
    axes.quiver(
        x_cm,
        y_cm,
        100 * field["displacement_x_m"],
        100 * field["displacement_y_m"],
        facecolor="white",
        edgecolor="black",
        linewidth=0.4,
        angles="xy",
        scale_units="xy",
        scale=1,
        width=0.005,
    )
    bar = case["bar"]
    width_cm, top_cm = 100 * case["container"]["width_m"], 100 * case["container"]["height_m"]
    axes.add_patch(
        Rectangle(
            (100 * (bar["centre_x_m"] - bar["width_m"] / 2), 100 * tip_m),
            100 * bar["width_m"],
            100 * bar["length_m"],
            facecolor="#8a8f98",
            edgecolor=INK,
        )
    )
    axes.set(xlim=(0, width_cm), ylim=(0, top_cm), aspect="equal", xlabel="x, cm", ylabel="y, cm")
    axes.grid(False)
    scale = matplotlib.cm.ScalarMappable(norm, colours)
    axes.figure.colorbar(
        scale,
        ax=axes,
        orientation="horizontal",
        label="displacement, mm",
        aspect=30,
        pad=0.03,
        format="%g",
    )


def _levels_mm(largest_mm: float) -> list[float]:
    """Limits of the colours, 1-2-5 in each decade: near the bar the bed moves ten times as far as elsewhere."""
    series = [step * 10.0**decade for decade in range(-3, 4) for step in (1, 2, 5)]
    top = next(
        (place for place, level in enumerate(series) if level >= largest_mm), len(series) - 1
    )
    return [0.0, *series[max(0, top - COLOUR_STEPS + 2) : max(top, COLOUR_STEPS - 2) + 1]]


def _length_mm(field: pd.DataFrame) -> np.ndarray:
    return 1000 * np.hypot(field["displacement_x_m"], field["displacement_y_m"]).to_numpy()


def _thick(axes: Axes, x, y, style: EngineStyle) -> None:
    """The line of one engine; its marker tells it apart without colour."""
    axes.plot(
        x,
        y,
        color=style.colour,
        linewidth=2.2,
        marker=style.marker,
        markersize=5,
        markevery=max(1, len(x) // 12),
        dashes=style.dash or (None, None),
    )
