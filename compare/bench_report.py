"""Speed for people and programs: bench.json and bench.png, and the terminal."""

from __future__ import annotations

from functools import partial
from pathlib import Path

from rich.console import Console
from rich.table import Table
from rich.text import Text

from crossdem.adapters.files import write_whole

from . import bench_tables as tables
from .bench import Bench
from .bench_figure import WIDE_PX, draw_bench
from .drawing import png_figure
from .pages import write_record
from .wording import printable

WIDE = 130  # columns that the widest table needs


def write_bench(bench: Bench, folder: Path, json_file: Path | None, about: dict) -> None:
    """bench.json, also as `json_file` if that is given, and bench.png where there is something to draw."""
    for path in filter(None, (folder / "bench.json", json_file)):
        write_record(bench.case, path, tables.record(bench, about))
    if bench.timings:
        write_whole(folder / "bench.png", png_figure(partial(draw_bench, bench), WIDE_PX))


def print_bench(bench: Bench, folder: Path, about: dict) -> None:
    console = wide_console()
    console.print(text_table(tables.TITLES, tables.rows(bench)))
    for line in tables.workload_lines(bench):
        console.print(line, highlight=False, soft_wrap=True)
    print_notes(bench, about, console)
    console.print(f"Files: {folder / 'bench.json'}, bench.png", soft_wrap=True)


def print_notes(bench: Bench, about: dict, console: Console) -> None:
    """On what machine, by which versions, and what is to be said of it."""
    versions = [f"{name}: {version}" for name, version in bench.versions.items()]
    for line in (tables.machine_line(about), *versions):
        console.print(Text(printable(line)), soft_wrap=True)
    for remark in tables.remarks(bench):
        console.print(Text(printable(remark), style="magenta"), soft_wrap=True)


def wide_console() -> Console:
    """A file has room for a whole table, whatever its width."""
    console = Console()
    return console if console.is_terminal else Console(width=WIDE)


def text_table(titles: tuple[str, ...], rows: list[tuple[str, ...]]) -> Table:
    table = Table(box=None, pad_edge=False, header_style="dim")
    for title in titles:
        table.add_column(title, justify="left" if title in ("workload", "engine") else "right")
    for row in rows:
        table.add_row(*row)
    return table
