"""The growth of a tiny disturbance in each engine, and its difference to the native scheme of its name."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes

from .colours import engine_styles
from .drawing import INK
from .horizon import LIMIT_M, LOST_SHARE, Horizon
from .wording import metres

LEAST_M = 1e-18  # below what doubles resolve here; what is equal to the last bit lies on this line
TOP_ROOM = 30  # above the largest drift, as a factor


def draw_growth(horizon: Horizon, axes: Axes, legend: bool = False) -> None:
    """Thick: drift of the twin; thin, dotted: difference to the native scheme; level lines: limit and horizon.

    A page has its own legend; a picture that stands alone needs one.
    """
    styles = engine_styles([one.engine for one in horizon.engines])
    top_m = LIMIT_M
    for one in horizon.engines:
        style = styles[one.engine]
        for curve, name, options in (
            (one.growth, "", {"linewidth": 2.2, "marker": style.marker, "markersize": 4}),
            (one.closeness, " less its native scheme", {"linewidth": 1.2, "linestyle": ":"}),
        ):
            if curve is None:
                continue
            values_m = curve.drift_m if curve is one.growth else curve.difference_m
            top_m = max(top_m, values_m.max())
            axes.plot(
                curve.time_s,
                np.maximum(values_m, LEAST_M),
                color=style.colour,
                label=one.engine + name,
                markevery=max(1, len(curve.time_s) // 12),
                **options,
            )
    levels = [(LIMIT_M, f"limit, {metres(LIMIT_M)}")]
    lost_m = next((one.growth.lost_m for one in horizon.engines if one.growth), None)
    if lost_m is not None:
        levels.append((lost_m, f"horizon, {100 * LOST_SHARE:g} % of a radius"))
    for level_m, says in levels:
        axes.axhline(level_m, color=INK, linewidth=0.8, linestyle="--", alpha=0.7)
        axes.text(0.01 * horizon.recorded_s, level_m * 1.5, says, fontsize=8, alpha=0.85)
    axes.set_yscale("log")
    axes.set_xlim(0, horizon.recorded_s)
    axes.set_ylim(LEAST_M / 2, TOP_ROOM * max(top_m, lost_m or 0))
    axes.set(xlabel="time from the packing, s", ylabel="largest distance of any particle, m")
    if legend:
        axes.legend(loc="lower right", fontsize=8, ncols=2)
