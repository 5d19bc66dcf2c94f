"""Speed drawn: a bar for each contender on each workload."""

from __future__ import annotations

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from .bench import Bench, Row
from .colours import engine_styles
from .wording import number

WIDE_PX = (900, 360)
ROOM = 1.5  # of the longest bar, for the text behind it


def draw_bench(bench: Bench, figure: Figure) -> None:
    """Cost of a particle-step where all make the same steps; time to solution, where there is any, beside it."""
    solved = [row for row in bench.rows() if row.workload == "time-to-solution"]
    stepped = [row for row in bench.rows() if row.workload != "time-to-solution"]
    panels = [
        (stepped, "ns_per_particle_step", "ns per particle-step, at equal time steps"),
        (solved, "wall_s", "s to solution, each at its own time step"),
    ]
    panels = [panel for panel in panels if panel[0]]
    widths = [3 if rows is stepped else 2 for rows, _, _ in panels]
    for axes, panel in zip(
        figure.subplots(1, max(1, len(panels)), squeeze=False, width_ratios=widths or [1])[0],
        panels,
    ):
        _bars(axes, *panel)


def _bars(axes: Axes, rows: list[Row], value: str, label: str) -> None:
    workloads = list(dict.fromkeys(row.workload for row in rows))
    contenders = list(dict.fromkeys(row.contender for row in rows))
    styles = engine_styles(contenders)
    height = 0.8 / len(contenders)
    for row in rows:
        spread = getattr(row, value)
        place = (
            workloads.index(row.workload) - 0.4 + height * (contenders.index(row.contender) + 0.5)
        )
        axes.barh(place, spread.median, 0.9 * height, color=styles[row.contender].colour)
        axes.plot([spread.low, spread.high], [place, place], color="black", linewidth=1.2)
        ratio = f"  ×{number(row.ratio.median, 2)}" if row.ratio else ""
        axes.annotate(
            f"{row.contender} {number(spread.median)}{ratio}",
            (max(spread.median, spread.high), place),
            xytext=(4, 0),
            textcoords="offset points",
            va="center",
            fontsize=8,
        )
    axes.set_yticks(range(len(workloads)), workloads)
    axes.invert_yaxis()
    axes.grid(axis="y", visible=False)
    axes.set_axisbelow(True)
    axes.tick_params(axis="y", length=0)
    axes.set_xlim(0, ROOM * max(getattr(row, value).high for row in rows))
    axes.set_xlabel(label)
