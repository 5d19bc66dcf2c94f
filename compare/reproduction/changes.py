"""What settings change of a few quantities in the native solver: ratios to the case as the paper has it."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

import pandas as pd
from matplotlib.figure import Figure

from ..drawing import INK
from ..quantities import QUANTITIES
from .estimates import Estimate, ratio_of
from .observation import FLUCTUATION, SHARE, WAVELENGTH
from .runs import Found
from .study import AS_PRINTED, RESISTANCE, Picture, Setting

SHOWN = {
    RESISTANCE: QUANTITIES[RESISTANCE].title,
    FLUCTUATION: QUANTITIES[FLUCTUATION].title,
    SHARE: "fluctuation over resistance",
    WAVELENGTH: "median wavelength",
    "near_bar_movement_m": QUANTITIES["near_bar_movement_m"].title,
}
UP, DOWN, UNCLEAR = "#e0752d", "#3b82d6", "#8a8f98"


def ratios(found: Found, quantity: str, settings: Sequence[Setting]) -> dict[str, Estimate]:
    """Of each setting, by its name."""
    base = found.of(AS_PRINTED)[quantity]
    return {one.name: ratio_of(found.of(one)[quantity], base) for one in settings}


def change_picture(
    name: str, title: str, says: str, found: Found, settings: Sequence[Setting]
) -> Picture:
    """A panel per quantity of SHOWN, a row per setting, and both as a table. `says` goes on after what is drawn."""
    rows = [
        {"setting": setting, "quantity": quantity, **vars(ratio)}
        for quantity in SHOWN
        for setting, ratio in ratios(found, quantity, settings).items()
    ]
    table = pd.DataFrame(rows).rename(columns={"mean": "ratio"})
    drawn = (
        "Native: ratio to the case as the paper has it, and its 95 % interval; no point where a mean is not above 0, such as "
        f"of particles that move up. {says}"
    ).rstrip()
    size_px = (960, 90 + 34 * len(settings))
    return Picture(name, title, drawn, size_px, partial(_draw, table), table)


def _draw(table: pd.DataFrame, figure: Figure) -> None:
    """Coloured where the interval leaves out no change."""
    names = list(table["setting"].unique())
    panels = figure.subplots(1, len(SHOWN), sharey=True)
    for panel, (quantity, title) in zip(panels, SHOWN.items()):
        panel.axvline(1, color=INK, linewidth=0.8)
        for place, (_, row) in enumerate(table[table["quantity"] == quantity].iterrows()):
            colour = UP if row["low"] > 1 else DOWN if row["high"] < 1 else UNCLEAR
            panel.plot([row["low"], row["high"]], [place, place], color=colour, linewidth=2)
            panel.plot(row["ratio"], place, "o", color=colour, markersize=5)
        panel.set_title(title, fontsize=9)
        panel.set_yticks(range(len(names)), names)
        panel.set_ylim(len(names) - 0.5, -0.5)
        panel.set_xlabel("ratio")
