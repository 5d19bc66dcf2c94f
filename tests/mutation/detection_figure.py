"""The detection matrix as a heat map: a row per fault, a column per layer and endpoint."""

from __future__ import annotations

import pandas as pd
from detection import OUTCOME, endpoints_of
from matplotlib.figure import Figure
from matplotlib.patches import Patch, Rectangle

from crossdem.compare.checks import DIFFERENT, EQUIVALENT, INCONCLUSIVE
from crossdem.compare.drawing import png_figure
from crossdem.compare.quantities import QUANTITIES
from crossdem.compare.wording import MINUS

# Of one hue, so that they differ on any screen and in grey.
NOTICED, UNDECIDED, UNSEEN, NOTHING = "#9c2f1f", "#eec9a8", "#eef2f5", "#c5ccd3"
COLOURS = {DIFFERENT: NOTICED, INCONCLUSIVE: UNDECIDED, EQUIVALENT: UNSEEN}
LAYERS = ("ladder", "closed forms", "runs fail", "gates fail")
ROW_PX, COLUMN_PX, BESIDE_PX, ABOVE_PX = 19, 50, 260, 170
LARGEST = 99.0  # shown in full


def figure(table: pd.DataFrame) -> bytes:
    columns = len(LAYERS) + len(endpoints_of(table))
    size = (BESIDE_PX + COLUMN_PX * columns, ABOVE_PX + ROW_PX * len(table))
    return png_figure(lambda drawn: _draw(drawn, table), size)


def _draw(drawn: Figure, table: pd.DataFrame) -> None:
    axes = drawn.add_subplot()
    endpoints = endpoints_of(table)
    titles = [*LAYERS, *(QUANTITIES[name].title for name in endpoints)]
    for y, (_, row) in enumerate(table.iterrows()):
        for x, (text, colour) in enumerate(_cells(row, endpoints)):
            axes.add_patch(Rectangle((x, y), 1, 1, facecolor=colour, edgecolor="white"))
            ink = "white" if colour == NOTICED else "#30363d"
            axes.text(x + 0.5, y + 0.54, text, ha="center", va="center", fontsize=7, color=ink)
    axes.axvline(len(LAYERS), color="#30363d", linewidth=1)
    axes.set(xlim=(0, len(titles)), ylim=(len(table), 0))
    axes.set_xticks([x + 0.5 for x in range(len(titles))], titles, rotation=50, ha="left")
    axes.set_yticks([y + 0.5 for y in range(len(table))], table["fault"])
    axes.tick_params(length=0, labelsize=8)
    axes.xaxis.tick_top()
    axes.grid(False)
    axes.spines[:].set_visible(False)
    said = {
        "noticed": NOTICED,
        "inconclusive": UNDECIDED,
        "not noticed": UNSEEN,
        "no value": NOTHING,
    }
    handles = [Patch(facecolor=colour, label=label) for label, colour in said.items()]
    axes.legend(
        handles=handles,
        loc="upper left",
        bbox_to_anchor=(0, 0),
        ncols=len(handles),
        fontsize=8,
    )


def _cells(row: pd.Series, endpoints: list[str]) -> list[tuple[str, str]]:
    counts = ("rungs_failing", "answers_failing", "runs_failed", "gates_failed")
    cells = [
        (str(int(row[name])) if row[name] else "", NOTICED if row[name] else UNSEEN)
        for name in counts
    ]
    if row["ladder"] == "caught" and not row["rungs_failing"]:
        cells[0] = ("fails", NOTICED)
    for name in endpoints:
        value = row[name]
        cells.append((_shown(value), COLOURS.get(row[name + OUTCOME], NOTHING)))
    return cells


def _shown(value: float) -> str:
    if pd.isna(value):
        return ""
    text = f"{value:+.1f}" if abs(value) < LARGEST else f"{value:+.0e}".replace("e+0", "e")
    return text.replace("-0.0", "+0.0").replace("-", MINUS)
