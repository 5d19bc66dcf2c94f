"""What settings change of a few quantities: ratios to the case as the paper has it, as a table and drawn."""

from __future__ import annotations

from collections.abc import Sequence

import pandas as pd
from matplotlib.figure import Figure

from ..drawing import INK
from ..quantities import QUANTITIES
from .estimates import ratio_of
from .observation import SHARE, WAVELENGTH
from .runs import Found
from .study import Setting

SHOWN = {
    "mean_resistance_N": QUANTITIES["mean_resistance_N"].title,
    SHARE: "fluctuation over resistance",
    WAVELENGTH: "median wavelength",
    "near_bar_movement_m": QUANTITIES["near_bar_movement_m"].title,
}
UP, DOWN, UNCLEAR = "#e0752d", "#3b82d6", "#8a8f98"


def change_table(found: Found, base: Setting, settings: Sequence[Setting]) -> pd.DataFrame:
    """A row per setting and quantity: the ratio to `base` in the native solver, its interval, the packings."""
    rows = [
        {
            "setting": setting.name,
            "quantity": quantity,
            **vars(ratio_of(found.of(setting)[quantity], found.of(base)[quantity])),
        }
        for setting in settings
        for quantity in SHOWN
    ]
    return pd.DataFrame(rows).rename(columns={"mean": "ratio"})


def draw_changes(found: Found, base: Setting, settings: Sequence[Setting], figure: Figure) -> None:
    """A panel per quantity, a row per setting; coloured where the interval leaves out no change."""
    table = change_table(found, base, settings)
    panels = figure.subplots(1, len(SHOWN), sharey=True)
    for panel, (quantity, title) in zip(panels, SHOWN.items()):
        panel.axvline(1, color=INK, linewidth=0.8)
        for place, (_, row) in enumerate(table[table["quantity"] == quantity].iterrows()):
            colour = UP if row["low"] > 1 else DOWN if row["high"] < 1 else UNCLEAR
            panel.plot([row["low"], row["high"]], [place, place], color=colour, linewidth=2)
            panel.plot(row["ratio"], place, "o", color=colour, markersize=5)
        panel.set_title(title, fontsize=9)
        panel.set_yticks(range(len(settings)), [setting.name for setting in settings])
        panel.set_ylim(len(settings) - 0.5, -0.5)
        panel.set_xlabel("ratio")
