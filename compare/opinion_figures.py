"""Where the curves and the fields of two codes differ, drawn; see drawing.py."""

from __future__ import annotations

import matplotlib
from markupsafe import Markup
from matplotlib.axes import Axes
from matplotlib.colors import BoundaryNorm
from matplotlib.patches import Rectangle

from .curves import CurveComparison
from .drawing import INK, svg
from .fields import FieldComparison
from .opinions import Opinions
from .pairing import ALPHA

BAND, STANDS_OUT, WAY = "#3b82d6", "#e5484d", "#7d8590"  # legible on white and on black
CURVE_PX, FIELD_PX = (440, 320), (400, 460)
T_LEVELS = [-6, -5, -4, -3, -2, -1, 1, 2, 3, 4, 5, 6]
COMPONENTS = {"x": "sideways", "y": "up and down"}


def pictures(opinions: Opinions, case: dict) -> dict:
    """For the page: (pair, SVG) of each pair of curves, and (pair, what, SVG) of each component of its fields."""
    return {
        "curve_pictures": [
            (" against ".join(one.pair), Markup(svg(lambda axes: draw_band(axes, one), CURVE_PX)))
            for one in opinions.curves
            if one.table is not None
        ],
        "field_pictures": [
            (
                " against ".join(one.pair),
                what,
                Markup(svg(lambda axes: draw_t(axes, one, component, case), FIELD_PX)),
            )
            for one in opinions.fields
            if one.cells is not None
            for component, what in COMPONENTS.items()
        ],
    }


def draw_band(axes: Axes, curves: CurveComparison) -> None:
    """Mean difference and its band over depth; grey: the margin; diamonds: where the band leaves out 0."""
    table = curves.table
    depth_cm = 100 * table.index.to_numpy()
    axes.fill_between(depth_cm, -table["margin_N"], table["margin_N"], color=INK, alpha=0.13, lw=0)
    axes.fill_between(depth_cm, table["low_N"], table["high_N"], color=BAND, alpha=0.35, lw=0)
    axes.axhline(0, color=INK, linewidth=0.8, alpha=0.7)
    axes.plot(depth_cm, table["difference_N"], color=BAND, linewidth=2.2, marker="o", markersize=4)
    axes.plot(
        depth_cm[table["differs"]],
        table["difference_N"][table["differs"]],
        color=STANDS_OUT,
        linestyle="none",
        marker="D",
        markersize=8,
    )
    axes.set(xlabel="depth of the tip, cm", ylabel="difference of the resistance, N")
    axes.set_xlim(left=0)


def draw_t(axes: Axes, fields: FieldComparison, component: str, case: dict) -> None:
    """t of each cell's mean difference; framed: the cells that stand out; dashed: where the bar goes down."""
    cell_cm = 100 * case["marks"]["cell_size_m"]
    colours = matplotlib.colormaps["RdBu_r"]
    norm = BoundaryNorm(T_LEVELS, colours.N, extend="both")
    cells = fields.cells.loc[component]
    corners = [(100 * x_m - cell_cm / 2, 100 * y_m - cell_cm / 2) for x_m, y_m in cells.index]
    for corner, t in zip(corners, cells["t"]):
        axes.add_patch(Rectangle(corner, cell_cm, cell_cm, color=colours(norm(t)), linewidth=0.4))
    for corner, p in zip(corners, cells["p"]):
        if p <= ALPHA:
            inset = 0.08 * cell_cm
            framed = [end + inset for end in corner]
            side = cell_cm - 2 * inset
            axes.add_patch(
                Rectangle(framed, side, side, fill=False, edgecolor="black", linewidth=2)
            )
    bar, box = case["bar"], case["container"]
    for side in (-1, 1):
        axes.axvline(
            100 * (bar["centre_x_m"] + side * bar["width_m"] / 2),
            color=WAY,
            linestyle="--",
            linewidth=1.2,
        )
    axes.set(xlim=(0, 100 * box["width_m"]), ylim=(0, 100 * box["height_m"]), aspect="equal")
    axes.set(xlabel="x, cm", ylabel="y, cm")
    axes.grid(False)
    axes.figure.colorbar(
        matplotlib.cm.ScalarMappable(norm, colours),
        ax=axes,
        orientation="horizontal",
        label="t of the mean difference",
        aspect=30,
        pad=0.03,
    )
