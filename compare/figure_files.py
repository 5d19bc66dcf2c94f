"""The report's figures as files, for papers: figures/NAME.svg and .png beside report.html, and their data as NAME.csv."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from crossdem.adapters.files import write_whole

from . import figures
from .colours import engine_styles
from .comparison import Comparison
from .curve_data import curve_tables
from .drawing import png_figure, svg_file

FOLDER = "figures"
SIZE_PX, PANEL_PX = (720, 420), (360, 420)  # of a plot; of the field of one engine


def write_figures(comparison: Comparison, out_dir: Path) -> None:
    """Write them, each file whole or not at all; figures of an earlier report that this one has not are removed."""
    folder = Path(out_dir) / FOLDER
    found = _plots(comparison) | _fields(comparison)
    for name in ("resistance", "movement", "surface", "displacement"):
        files = {ending: folder / f"{name}.{ending}" for ending in ("svg", "png", "csv")}
        if name not in found:
            for file in files.values():
                file.unlink(missing_ok=True)
            continue
        draw, size_px, table = found[name]
        folder.mkdir(parents=True, exist_ok=True)
        write_whole(files["csv"], table.to_csv(float_format="%.6g").encode())
        write_whole(files["svg"], svg_file(draw, size_px))
        write_whole(files["png"], png_figure(draw, size_px))


Found = dict[str, tuple[Callable[[Figure], None], tuple[int, int], pd.DataFrame]]


def _plots(comparison: Comparison) -> Found:
    draws = {
        "resistance": figures.draw_resistance,
        "movement": figures.draw_movement,
        "surface": figures.draw_surface,
    }
    return {
        name: (_with_legend(draws[name], comparison), SIZE_PX, _flat(table))
        for name, (table, _) in curve_tables(comparison).items()
        if len(table)
    }


def _flat(table: pd.DataFrame) -> pd.DataFrame:
    """One row of headings: engine and what it is."""
    return table.set_axis([" ".join(column) for column in table.columns], axis="columns")


def _fields(comparison: Comparison) -> Found:
    fields = figures.displacement_fields(comparison)
    if not fields:
        return {}

    def draw(figure: Figure) -> None:
        panels = figure.subplots(1, len(fields), squeeze=False)[0]
        draws = figures.draw_fields(comparison, fields)
        for axes, (engine, draw_field) in zip(panels, draws.items()):
            draw_field(axes)
            axes.set_title(engine, parse_math=False)

    table = pd.concat(fields, names=["engine"])
    return {"displacement": (draw, (PANEL_PX[0] * len(fields), PANEL_PX[1]), table)}


def _with_legend(
    draw: Callable[[Axes, Comparison], None], comparison: Comparison
) -> Callable[[Figure], None]:
    def draw_figure(figure: Figure) -> None:
        axes = figure.add_subplot()
        draw(axes, comparison)
        styles = engine_styles(comparison.engines)
        lines = [
            Line2D(
                [], [], color=style.colour, marker=style.marker, dashes=style.dash or (None, None)
            )
            for style in styles.values()
        ]
        for text in axes.legend(lines, styles).get_texts():
            text.set_parse_math(False)  # an engine's name is text

    return draw_figure
