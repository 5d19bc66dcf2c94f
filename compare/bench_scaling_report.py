"""How the native solver scales, for people and programs: scaling.json and scaling.png, and the terminal."""

from __future__ import annotations

from dataclasses import asdict
from functools import partial
from pathlib import Path

from matplotlib.figure import Figure
from rich.console import Console

from crossdem.adapters.files import write_whole
from crossdem.adapters.gates import REFERENCE

from . import bench_tables as tables
from .bench import Bench
from .bench_figure import WIDE_PX
from .bench_report import print_notes, text_table
from .bench_scaling import Size
from .colours import KNOWN
from .drawing import png_figure
from .pages import write_record
from .wording import DASH, number

TITLES = ("particles", "steps", "ns per particle-step", "bytes per particle", "settling the bed, s")


def write_scaling(
    bench: Bench, sizes: list[Size], folder: Path, json_file: Path | None, about: dict
) -> None:
    """scaling.json, also as `json_file` if that is given, and scaling.png where there is something to draw."""
    record = {"sizes": [asdict(size) for size in sizes]} | tables.record(bench, about)
    for path in filter(None, (folder / "scaling.json", json_file)):
        write_record(bench.case, path, record)
    if sizes:
        write_whole(folder / "scaling.png", png_figure(partial(_draw, sizes), WIDE_PX))


def print_scaling(bench: Bench, sizes: list[Size], folder: Path, about: dict) -> None:
    console = Console()
    console.print(text_table(TITLES, [_row(size) for size in sizes]))
    print_notes(bench, about, console)
    console.print(f"Files: {folder / 'scaling.json'}, scaling.png", soft_wrap=True)


def _row(size: Size) -> tuple[str, ...]:
    return (
        f"{size.particles:,}",
        f"{size.steps:,}",
        tables.spread(size.ns_per_particle_step),
        f"{size.bytes_per_particle:.0f}",
        DASH if size.packing_s is None else number(size.packing_s),
    )


def _draw(sizes: list[Size], figure: Figure) -> None:
    speed, memory = figure.subplots(1, 2)
    particles = [size.particles for size in sizes]
    style = KNOWN[REFERENCE]
    spreads = [size.ns_per_particle_step for size in sizes]
    speed.plot(particles, [s.median for s in spreads], color=style.colour, marker=style.marker)
    speed.vlines(particles, [s.low for s in spreads], [s.high for s in spreads], color="black")
    speed.set_ylabel("ns per particle-step")
    bytes_each = [size.bytes_per_particle for size in sizes]
    memory.plot(particles, bytes_each, color=style.colour, marker=style.marker)
    memory.set_ylabel("bytes per particle")
    for axes in (speed, memory):
        axes.set_xscale("log")
        axes.set_ylim(0, 1.1 * axes.get_ylim()[1])
        axes.set_xlabel("particles")
