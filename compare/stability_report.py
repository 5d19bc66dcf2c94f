"""The stability map for people and programs: stability.html (self-contained), .png, .csv, .json, and the terminal."""

from __future__ import annotations

from functools import partial
from pathlib import Path

from markupsafe import Markup
from rich.console import Console
from rich.table import Table
from rich.text import Text

from . import stability_tables as tables
from .drawing import png_figure, svg
from .pages import write_finding
from .provenance import provenance
from .stability import StabilityMap
from .stability_figure import draw_map
from .wording import plural, printable

WIDE_PX, NARROW_PX = (900, 370), (420, 410)


def write_stability(found: StabilityMap, folder: Path) -> Path:
    """Write the four files into `folder`; returns the path of the page."""
    draw = partial(draw_map, found)
    values = {
        "sentence": tables.sentence(found),
        "remarks": tables.remarks(found),
        "titles": tables.TITLES,
        "rows": tables.rows(found),
        "schemes": [scheme.name for scheme in found.schemes],
        "trial_rows": tables.trial_rows(found),
        "map_wide": Markup(svg(draw, WIDE_PX)),
        "map_narrow": Markup(svg(draw, NARROW_PX)),
        "beds": plural(len({trial.seed for trial in found.trials}), "packing"),
        "rest": f"{found.rest_s:.3g}",
        "gate": f"{found.case.resolved['gates']['rest_kinetic_energy_J']:g}",
        "provenance": provenance(found.manifests),
    }
    picture = png_figure(lambda figure: draw(figure.add_subplot()), WIDE_PX)
    table, record = tables.table(found), tables.record(found)
    return write_finding(found.case, folder, "stability", table, record, picture, values)


def print_stability(found: StabilityMap, page: Path, console: Console | None = None) -> None:
    console = console or Console()
    table = Table(box=None, pad_edge=False, header_style="dim")
    for title in tables.TITLES:
        table.add_column(title)
    for row in tables.rows(found):
        table.add_row(*row)
    console.print(table)
    for name, remark in tables.remarks(found):
        console.print(Text(printable(f"{name}: {remark}"), style="magenta"))
    console.print(Text(tables.sentence(found), style="bold"))
    console.print(Text(f"Report: {page}"), soft_wrap=True)
