"""The bar chart of an attribution: a panel for each quantity, a bar for each step, its 95 % interval across it."""

from __future__ import annotations

import math
import textwrap

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from .attribution import Attribution, Change, Endpoint
from .checks import Check
from .drawing import INK
from .explain_tables import LEFT_OVER, change_rows

UP, DOWN, UNCLEAR = "#e0752d", "#3b82d6", "#8a8f98"  # an increase, a decrease, neither
BAR_HEIGHT = 0.62
WHOLE_FROM = 4  # packings from which on an interval is shown whole: that of fewer dwarfs all else
GAP = 0.6  # between the steps and the sums of them
NAME_LETTERS = 34  # of a line
ROW_PX, FRAME_PX = 21, 92  # of a panel: each bar, and what stands around them


def size_px(attribution: Attribution, columns: int, width_px: int) -> tuple[int, int]:
    """Width and height of the chart in `columns` columns."""
    rows = math.ceil(len(attribution.endpoints) / columns)
    bars = len(attribution.endpoints[0].steps) + 2 + GAP
    return width_px, round(rows * (bars * ROW_PX + FRAME_PX))


def draw_attribution(attribution: Attribution, columns: int, figure: Figure) -> None:
    rows = math.ceil(len(attribution.endpoints) / columns)
    figure.get_layout_engine().set(h_pad=0.08)
    panels = figure.subplots(rows, columns, sharey=True, squeeze=False).flat
    names = [row.name for row in change_rows(attribution) if row.name != LEFT_OVER]
    for panel, endpoint in zip(panels, attribution.endpoints):
        _draw(panel, endpoint, [textwrap.fill(name, NAME_LETTERS) for name in names])
    for unused in list(panels):
        unused.set_visible(False)


def cut_off(attribution: Attribution) -> bool:
    """Whether some interval is of too few packings to be shown whole beside others."""
    return any(
        change.interval and change not in _telling(changes)
        for endpoint in attribution.endpoints
        for changes in [_changes(endpoint)]
        for change in changes
    )


def percent_or_unit(check: Check, change: float) -> float:
    """A change on the check's scale, as the axis has it."""
    if check.kind == "ratio":
        return 100 * math.expm1(change)
    return change * (100 if check.kind == "relative" else check.quantity.shown_unit[0])


def _draw(panel: Axes, endpoint: Endpoint, names: list[str]) -> None:
    check = endpoint.check
    changes = _changes(endpoint)
    places = [float(row) for row in range(len(endpoint.steps))]
    places += [places[-1] + 1 + GAP, places[-1] + 2 + GAP]
    for place, change in zip(places, changes):
        if not math.isfinite(change.mean):
            panel.text(0, place, "no result", va="center", fontsize=8, alpha=0.7)
            continue
        mean = percent_or_unit(check, change.mean)
        panel.barh(place, mean, height=BAR_HEIGHT, color=_colour(change), linewidth=0)
        if change.interval:
            ends = [percent_or_unit(check, end) for end in change.interval]
            panel.plot(ends, [place, place], color=INK, linewidth=1.3, solid_capstyle="butt")
            panel.plot(ends, [place, place], "|", color=INK, markersize=6)
    panel.axvline(0, color=INK, linewidth=0.8)
    panel.axhline((places[-3] + places[-2]) / 2, color=INK, linewidth=0.6, alpha=0.4)
    panel.set_yticks(places, names)
    panel.set_ylim(places[-1] + 0.6, -0.6)
    unit = check.quantity.shown_unit[1] if check.kind == "absolute" else "%"
    panel.set_xlim(*_limits(check, changes))
    panel.set_title(check.quantity.title, fontsize=9, loc="left", fontweight="bold")
    panel.set_xlabel(f"change, {unit}" if unit else "change")
    panel.tick_params(axis="y", length=0)
    panel.grid(axis="y", visible=False)


def _limits(check: Check, changes: list[Change]) -> tuple[float, float]:
    """Of the axis: every bar, and every interval that says something."""
    ends = [end for change in _telling(changes) for end in change.interval or ()]
    shown = [percent_or_unit(check, end) for end in ends + [0.0]]
    shown += [
        percent_or_unit(check, change.mean) for change in changes if math.isfinite(change.mean)
    ]
    low, high = min(shown), max(shown)
    room = 0.08 * (high - low) or 1.0
    return low - room, high + room


def _changes(endpoint: Endpoint) -> list[Change]:
    return [*endpoint.steps, endpoint.to_scheme, endpoint.total]


def _telling(changes: list[Change]) -> list[Change]:
    """Those whose intervals the axis has room for."""
    return [change for change in changes if len(change.seeds) >= WHOLE_FROM] or changes


def _colour(change: Change) -> str:
    if not change.clear:
        return UNCLEAR
    return UP if change.mean > 0 else DOWN
