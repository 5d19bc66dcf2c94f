"""A calibration for people and programs: calibrate.html (self-contained), .png, .csv, .json, and the terminal."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from pathlib import Path

from markupsafe import Markup
from rich.console import Console
from rich.table import Table
from rich.text import Text

from crossdem.adapters.case import Case

from . import calibration_tables as tables
from .calibration import POWER, STATE, TRUE_SHIFT, Calibration
from .calibration_figure import draw, size_px
from .drawing import png_figure, svg_figure
from .pages import write_finding
from .provenance import provenance
from .recorded import DATE, Record

WIDE, NARROW = 4, 2  # panels side by side


def write_calibration(
    case: Case, recorded: Record, found: Sequence[Calibration], splits: int, folder: Path
) -> Path:
    """Write the four files into `folder`; returns the path of the page."""
    manifests = [
        about for (engine, _, _), about in recorded.ensemble.manifests.items() if engine == "native"
    ]
    pictures = {
        name: Markup(svg_figure(partial(draw, found, columns), size_px(found, columns)))
        for name, columns in (("wide", WIDE), ("narrow", NARROW))
    }
    values = {
        "sentence": tables.sentence(found, splits),
        "misses": tables.misses(found),
        "design_titles": tables.DESIGN_TITLES,
        "design_rows": tables.design_rows(found),
        "endpoint_titles": tables.ENDPOINT_TITLES,
        "endpoint_rows": tables.endpoint_rows(found),
        "splits": splits,
        "state": STATE,
        "recorded": recorded.about[DATE].split("T")[0],
        "packings_recorded": len(recorded.seeds),
        "pictures": pictures,
        "provenance": provenance(manifests),
    }
    return write_finding(
        case,
        folder,
        "calibrate",
        tables.table(found),
        tables.record(found, splits),
        png_figure(partial(draw, found, WIDE), size_px(found, WIDE)),
        values,
    )


def print_calibration(
    found: Sequence[Calibration], splits: int, page: Path | None, console: Console | None = None
) -> None:
    console = console or Console()
    for titles, rows in (
        (tables.DESIGN_TITLES, tables.design_rows(found)),
        (tables.brief_titles(found), tables.brief_rows(found)),
    ):
        table = Table(box=None, pad_edge=False, header_style="dim")
        for title in titles:
            table.add_column(title)
        for row in rows:
            table.add_row(*row)
        console.print(table)
        console.print()
    console.print(
        Text(
            f"Of each check: % EQUIVALENT of equal codes / % EQUIVALENT at {TRUE_SHIFT:g} margins / smallest shift, in "
            f"margins, that {100 * POWER:.0f} % of comparisons find.",
            style="dim",
        )
    )
    for miss in tables.misses(found):
        console.print(Text(miss, style="red"))
    console.print(Text(tables.sentence(found, splits), style="bold"))
    console.print(Text(f"Random state {STATE}. Splits of the same packings overlap.", style="dim"))
    if page:
        console.print(Text(f"Report: {page}"), soft_wrap=True)
