"""An attribution for people and programs: explain.html (self-contained), .png, .csv, .json, and the terminal."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path

from markupsafe import Markup
from rich.console import Console
from rich.table import Table
from rich.text import Text

from crossdem.adapters.engines import get_engine

from . import explain_tables as tables
from .attribution import Attribution
from .drawing import png_figure, svg_figure
from .explain_figure import cut_off, draw_attribution, size_px
from .pages import write_finding
from .provenance import provenance
from .wording import plural, printable

WIDE, NARROW = (4, 1140), (1, 400)  # columns of the chart, and its width in pixels
NAME_WIDTH, CELL_WIDTH = 30, 17  # of the terminal's tables, in letters


def write_explanation(attribution: Attribution, folder: Path) -> Path:
    """Write the four files into `folder`; returns the path of the page."""
    return write_finding(
        attribution.case,
        folder,
        "explain",
        tables.table(attribution),
        _record(attribution),
        _chart(attribution, png_figure, *WIDE),
        _values(attribution),
    )


def print_explanation(attribution: Attribution, page: Path, console: Console | None = None) -> None:
    """The changes as tables no wider than the terminal, what they say, and where the page is."""
    console = console or Console()
    titles = [endpoint.check.quantity.title for endpoint in attribution.endpoints]
    rows = tables.change_rows(attribution)
    at_a_time = max(1, (console.width - NAME_WIDTH) // CELL_WIDTH)
    for start in range(0, len(titles), at_a_time):
        shown = slice(start, start + at_a_time)
        table = Table(box=None, pad_edge=False, header_style="dim")
        table.add_column("change \N{PLUS-MINUS SIGN} half the 95 % interval", width=NAME_WIDTH - 2)
        for title in titles[shown]:
            table.add_column(title, justify="right", width=CELL_WIDTH - 2)
        for name, changes, cells in rows:
            marked = [
                Text(cell, style="bold" if step and step.clear else "")
                for step, cell in zip(changes[shown], cells[shown])
            ]
            table.add_row(name, *marked)
        console.print(table)
        console.print()
    for station in attribution.stations:
        for remark in tables.remarks(station):
            console.print(Text(printable(f"{station.name}: {remark}"), style="magenta"))
    console.print(Text(tables.headline(attribution), style="bold"))
    for sentence in tables.sentences(attribution):
        console.print(Text(sentence))
    console.print(Text(f"Report: {page}"), soft_wrap=True)


def _values(attribution: Attribution) -> dict:
    """What the page shows."""
    stations = attribution.stations
    seeds, engine_seeds = len(stations[0].seeds), len(stations[-1].seeds)
    fewer = f", {attribution.target} itself on {engine_seeds}" if engine_seeds < seeds else ""
    return {
        "headline": tables.headline(attribution),
        "sentences": tables.sentences(attribution),
        "stations": stations,
        "remarks": [(one.name, remark) for one in stations for remark in tables.remarks(one)],
        "checks": [endpoint.check for endpoint in attribution.endpoints],
        "change_rows": tables.change_rows(attribution),
        "restless": any(change.restless for change in attribution.steps),
        "cut_off": cut_off(attribution),
        "value_rows": tables.value_rows(attribution),
        "step_s": get_engine(attribution.target).step_s(attribution.case),
        "chart_wide": Markup(_chart(attribution, svg_figure, *WIDE)),
        "chart_narrow": Markup(_chart(attribution, svg_figure, *NARROW)),
        "seeds": plural(seeds, "packing"),
        "engine_seeds": fewer,
        "provenance": provenance(manifests(attribution)),
    }


def manifests(attribution: Attribution) -> list[dict]:
    """Of all runs."""
    return [manifest for station in attribution.stations for manifest in station.manifests]


def _chart(attribution: Attribution, render_figure, columns: int, width_px: int):
    columns = min(columns, len(attribution.endpoints))
    return render_figure(
        lambda figure: draw_attribution(attribution, columns, figure),
        size_px(attribution, columns, width_px),
    )


def _record(attribution: Attribution) -> dict:
    """Every number, for other programs."""
    return {
        "target": attribution.target,
        "headline": tables.headline(attribution),
        "sentences": tables.sentences(attribution),
        "stations": [
            {
                "name": station.name,
                "says": station.ingredient.says,
                "overrides": station.ingredient.overrides,
                "values": station.values.reset_index().to_dict("records"),
                "failures": station.failures,
                "failed_gates": station.failed_gates,
            }
            for station in attribution.stations
        ],
        "changes": tables.table(attribution).to_dict("records"),
        "left_over": {
            endpoint.check.quantity.name: endpoint.left_over for endpoint in attribution.endpoints
        },
        "provenance": asdict(provenance(manifests(attribution))),
    }
