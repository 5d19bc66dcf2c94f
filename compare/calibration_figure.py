"""The operating characteristics drawn: of each check, the share of comparisons that end either way, against the truth."""

from __future__ import annotations

import math
from collections.abc import Sequence

from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from .calibration import POWER, Calibration
from .drawing import INK

EQUIVALENT, DIFFERENT = "#1fa187", "#d6455d"
LINES = ("-", "--", ":", "-.")  # designs
PANEL_PX = (225, 190)


def size_px(found: Sequence[Calibration], columns: int) -> tuple[int, int]:
    rows = _rows(len(found[0].endpoints), columns)
    return columns * PANEL_PX[0], rows * PANEL_PX[1]


def draw(found: Sequence[Calibration], columns: int, figure: Figure) -> None:
    """A panel per check; a line style per design."""
    checks = [endpoint.check for endpoint in found[0].endpoints]
    rows = _rows(len(checks), columns)
    panels = figure.subplots(rows, columns, sharex=True, sharey=True, squeeze=False)
    for number, axes in enumerate(panels.flat):
        if number >= len(checks):
            axes.axis("off")
            continue
        for one, style in zip(found, LINES):
            points = one.endpoints[number].points
            shifts = [point.shift for point in points]
            for colour, shares in (
                (EQUIVALENT, [100 * point.equivalent.share for point in points]),
                (DIFFERENT, [100 * point.different.share for point in points]),
            ):
                axes.plot(shifts, shares, style, color=colour, linewidth=1.4)
        axes.axvline(1, color=INK, linewidth=0.8, alpha=0.6)
        axes.axhline(100 * POWER, color=INK, linewidth=0.8, alpha=0.25)
        axes.set_title(checks[number].quantity.title, fontsize=9)
        axes.set_ylim(-3, 103)
        axes.set_xlim(left=0)
        below = number + columns >= len(checks)
        axes.tick_params(axis="x", labelbottom=below)
    figure.supxlabel("true shift, margins", fontsize=9)
    figure.supylabel("share of comparisons, %", fontsize=9)
    words = [Line2D([], [], color=EQUIVALENT, label="EQUIVALENT")]
    words += [Line2D([], [], color=DIFFERENT, label="DIFFERENT")]
    words += [
        Line2D([], [], color=INK, linestyle=style, label=str(one.design))
        for one, style in zip(found, LINES)
    ]
    panels.flat[len(checks)].legend(handles=words, loc="center left")


def _rows(checks: int, columns: int) -> int:
    """With a place for the legend."""
    return math.ceil((checks + 1) / columns)
