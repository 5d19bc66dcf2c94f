"""The stability map drawn: a row for each scheme, a mark for each bed at each time step, a line for each bound."""

from __future__ import annotations

import math

from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.ticker import FixedLocator, FuncFormatter, NullLocator

from .drawing import INK
from .stability import AGITATED, BLOWN_UP, FAILED, QUIET, StabilityMap

US = 1e6  # microseconds per second
MARKS = {  # told apart by shape too
    QUIET: {"marker": "o", "color": "#1fa187", "markersize": 7},
    AGITATED: {"marker": "D", "color": "#e0a030", "markersize": 6},
    BLOWN_UP: {"marker": "X", "color": "#d6455d", "markersize": 8},
    FAILED: {"marker": "1", "color": "#8a8f98", "markersize": 8},
}
TICKS_US = [step * 10.0**decade for decade in range(-2, 5) for step in (1, 2, 3, 5)]
SPREAD = 0.5  # of the beds of one row, in rows


def draw_map(found: StabilityMap, axes: Axes) -> None:
    rows = {scheme.name: row for row, scheme in enumerate(found.schemes)}
    seeds = sorted({trial.seed for trial in found.trials})
    for trial in found.trials:
        aside = (seeds.index(trial.seed) - (len(seeds) - 1) / 2) * SPREAD / len(seeds)
        place = rows[trial.scheme] + aside
        axes.plot(US * trial.step_s, place, linestyle="", **MARKS[trial.outcome])
    _draw_bounds(found, axes)
    axes.set_xscale("log")
    axes.xaxis.set_major_locator(FixedLocator(TICKS_US))
    axes.xaxis.set_minor_locator(NullLocator())
    axes.xaxis.set_major_formatter(FuncFormatter(lambda tick, _: f"{tick:g}"))
    steps = [US * trial.step_s for trial in found.trials]
    axes.set_xlim(min(steps) / 1.08, max(steps) * 1.08)
    axes.set_yticks(list(rows.values()), list(rows))
    axes.set_ylim(len(rows) - 0.4, -0.6)
    axes.grid(axis="x", visible=False)
    axes.tick_params(axis="y", length=0)
    axes.set_xlabel("time step, \N{MICRO SIGN}s")
    present = [outcome for outcome in MARKS if any(t.outcome == outcome for t in found.trials)]
    axes.legend(
        handles=[
            Line2D([], [], linestyle="", label=outcome, **MARKS[outcome]) for outcome in present
        ],
        loc="upper right",
        bbox_to_anchor=(1, -0.14),
        ncol=len(present),
        handletextpad=0.2,
    )


def _draw_bounds(found: StabilityMap, axes: Axes) -> None:
    named = (
        (found.bounds.conventional_s, "leap-frog:\ngain 2"),
        (found.bounds.averaged_s, "averaged:\ngain 6"),
        (found.bounds.eq32_s, "the paper:\nEq (32)"),
    )
    for bound_s, says in named:
        if math.isfinite(bound_s):
            axes.axvline(US * bound_s, color=INK, linewidth=1, linestyle="--", alpha=0.7)
            text = f"{says}\n{US * bound_s:.3g} \N{MICRO SIGN}s"
            axes.annotate(
                text,
                (US * bound_s, 1),
                xycoords=("data", "axes fraction"),
                xytext=(0, 3),
                textcoords="offset points",
                ha="center",
                va="bottom",
                fontsize=8,
                annotation_clip=False,
            )
