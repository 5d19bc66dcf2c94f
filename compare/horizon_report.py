"""The horizon for people and programs: horizon.html (self-contained), .png, .csv, .json, and the terminal."""

from __future__ import annotations

from functools import partial
from pathlib import Path

from markupsafe import Markup
from rich.console import Console
from rich.table import Table
from rich.text import Text

from crossdem import ExitCode
from crossdem.adapters.case import Case
from crossdem.adapters.files import write_whole

from . import horizon_tables as tables
from .colours import engine_styles
from .drawing import png_figure, svg
from .horizon import Horizon
from .horizon_figure import draw_growth
from .pages import render, write_record
from .record import libraries
from .wording import printable

# How the sentence looks, by the exit code: classes of report.css.
TONES = {
    ExitCode.AGREES: "finding",
    ExitCode.DIFFERS: "differs",
    ExitCode.ENGINE_FAILED: "failed",
    ExitCode.INCONCLUSIVE: "inconclusive",
}
WIDE_PX, NARROW_PX = (900, 420), (380, 340)


def write_horizon(case: Case, horizon: Horizon, folder: Path) -> Path:
    """Write the files into `folder`, each whole or not at all, the picture only where there are curves.

    Returns the path of the page, written last.
    """
    folder.mkdir(parents=True, exist_ok=True)
    write_whole(folder / "horizon.csv", tables.curves(horizon).to_csv(index=False).encode())
    write_record(case, folder / "horizon.json", tables.record(horizon))
    draw = partial(draw_growth, horizon)
    if _has_curves(horizon):
        picture = png_figure(lambda figure: draw(figure.add_subplot(), legend=True), WIDE_PX)
        write_whole(folder / "horizon.png", picture)
    else:
        (folder / "horizon.png").unlink(missing_ok=True)
    engines = [one.engine for one in horizon.engines]
    values = {
        "horizon": page_values(horizon),
        "title": case.resolved["title"],
        "case": case,
        "tone": TONES[horizon.exit_code],
        "engines": engines,
        "runs": horizon.runs,
        "colours": {name: style.colour for name, style in engine_styles(engines).items()},
        "libraries": libraries(),
    }
    write_whole(folder / "horizon.html", render("horizon.html", values).encode())
    return folder / "horizon.html"


def page_values(horizon: Horizon) -> dict:
    """What any page shows of a horizon; without curves there are no pictures of them."""
    if not _has_curves(horizon):
        return tables.values(horizon) | {"growth_wide": "", "growth_narrow": ""}
    draw = partial(draw_growth, horizon)
    return tables.values(horizon) | {
        "growth_wide": Markup(svg(draw, WIDE_PX)),
        "growth_narrow": Markup(svg(draw, NARROW_PX)),
    }


def print_horizon(horizon: Horizon, page: Path, console: Console | None = None) -> None:
    console = console or Console()
    table = Table(box=None, pad_edge=False, header_style="dim")
    for title in tables.COLUMNS:
        table.add_column(title)
    for row in tables.rows(horizon):
        table.add_row(*(Text(printable(cell)) for cell in row[:-1]))
    console.print(table)
    for row in tables.rows(horizon):
        if row.remark:
            console.print(Text(printable(f"{row.engine}: {row.remark}"), style="dim"))
    console.print(Text(printable(tables.sentence(horizon)), style="bold"))
    console.print(Text(f"Report: {page}"), soft_wrap=True)


def _has_curves(horizon: Horizon) -> bool:
    return any(one.growth for one in horizon.engines)
