"""The stability map for people and programs: stability.html (self-contained), .png, .csv, .json, and the terminal."""

from __future__ import annotations

import json
from functools import partial
from pathlib import Path

from markupsafe import Markup
from rich.console import Console
from rich.table import Table
from rich.text import Text

from . import stability_tables as tables
from .drawing import png_figure, svg
from .pages import render, write_whole
from .record import libraries, plain
from .stability import FAILED, StabilityMap
from .stability_figure import draw_map
from .wording import plural, printable

WIDE_PX, NARROW_PX = (900, 340), (420, 380)


def write_stability(found: StabilityMap, folder: Path) -> Path:
    """Write the four files into `folder`, each whole or not at all; returns the path of the page, written last."""
    folder.mkdir(parents=True, exist_ok=True)
    case = found.case
    write_whole(folder / "stability.csv", tables.table(found).to_csv(index=False).encode())
    about = {"name": case.name, "title": case.resolved["title"], "hash": case.hash}
    content = plain({"schema_version": 1, "case": about} | tables.record(found))
    text = json.dumps(content, indent=2, ensure_ascii=False, allow_nan=False)
    write_whole(folder / "stability.json", (text + "\n").encode())
    draw = partial(draw_map, found)
    picture = png_figure(lambda figure: draw(figure.add_subplot()), WIDE_PX)
    write_whole(folder / "stability.png", picture)
    values = {
        "title": case.resolved["title"],
        "case": case,
        "sentence": tables.sentence(found),
        "titles": tables.TITLES,
        "rows": tables.rows(found),
        "schemes": [scheme.name for scheme in found.schemes],
        "trial_rows": tables.trial_rows(found),
        "map_wide": Markup(svg(draw, WIDE_PX)),
        "map_narrow": Markup(svg(draw, NARROW_PX)),
        "beds": plural(len({trial.seed for trial in found.trials}), "packing"),
        "rest": f"{found.rest_s:.3g}",
        "gate": f"{case.resolved['gates']['rest_kinetic_energy_J']:g}",
        "libraries": libraries(),
    }
    write_whole(folder / "stability.html", render("stability.html", values).encode())
    return folder / "stability.html"


def print_stability(found: StabilityMap, page: Path, console: Console | None = None) -> None:
    console = console or Console()
    table = Table(box=None, pad_edge=False, header_style="dim")
    for title in tables.TITLES:
        table.add_column(title)
    for row in tables.rows(found):
        table.add_row(*row)
    console.print(table)
    for trial in found.trials:
        if trial.outcome == FAILED:
            console.print(Text(printable(f"{trial.scheme}: {trial.why}"), style="magenta"))
    console.print(Text(tables.sentence(found), style="bold"))
    console.print(Text(f"Report: {page}"), soft_wrap=True)
