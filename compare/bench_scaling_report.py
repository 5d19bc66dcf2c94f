"""How the native solver scales, for people and programs: scaling.json and scaling.png, and the terminal."""

from __future__ import annotations

from dataclasses import asdict
from functools import partial
from pathlib import Path

from matplotlib.figure import Figure

from crossdem.adapters.files import write_whole
from crossdem.adapters.gates import REFERENCE

from . import bench_tables as tables
from .bench import Bench, Contender
from .bench_figure import WIDE_PX
from .bench_report import print_notes, text_table, wide_console
from .bench_scaling import Size
from .colours import engine_styles
from .drawing import png_figure
from .pages import write_record
from .wording import listed, number, plural


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
    console = wide_console()
    console.print(text_table(_titles(sizes), [_row(size) for size in sizes]))
    for line in _settling_lines(sizes):
        console.print(line, highlight=False, soft_wrap=True)
    print_notes(bench, about, console)
    console.print(f"Files: {folder / 'scaling.json'}, scaling.png", soft_wrap=True)


def _titles(sizes: list[Size]) -> tuple[str, ...]:
    first, *others = sizes[0].speeds if sizes else [None]
    speeds = [f"ns per particle-step, {plural(first.threads, 'thread')}"] if first else []
    for speed in others:
        speeds += [f"{plural(speed.threads, 'thread')}", "speed-up"]
    return ("particles", "bytes per particle", "steps", *speeds)


def _row(size: Size) -> tuple[str, ...]:
    first, *others = size.speeds
    speeds = [tables.spread(first.ns_per_particle_step)]
    for speed in others:
        speeds += [tables.spread(speed.ns_per_particle_step), tables.spread(speed.speed_up)]
    return (
        f"{size.particles:,}",
        f"{size.bytes_per_particle:.0f}",
        f"{size.steps:,}",
        *speeds,
    )


def _settling_lines(sizes: list[Size]) -> list[str]:
    """ "settled on 2 threads: 1,000 particles in 0.197 s, 13.0 ns per particle-step"."""
    known = [(f"{size.particles:,}", size.settling) for size in sizes]
    said = [
        f"settled on {plural(made.threads, 'thread')}: {particles} particles in {number(made.wall_s)} s, "
        f"{number(made.ns_per_particle_step)} ns per particle-step"
        for particles, made in known
        if made
    ]
    if unknown := [particles for particles, made in known if not made]:
        said.append(
            f"settled by another build of the solver: {listed(unknown)} particles; in a new folder of "
            "--out they are settled and timed anew"
        )
    return said


def _draw(sizes: list[Size], figure: Figure) -> None:
    speed, memory = figure.subplots(1, 2)
    particles = [size.particles for size in sizes]
    names = {speed.threads: str(Contender(REFERENCE, speed.threads)) for speed in sizes[0].speeds}
    styles = engine_styles(list(names.values()))
    for place, (threads, name) in enumerate(names.items()):
        spreads = [size.speeds[place].ns_per_particle_step for size in sizes]
        medians = [spread.median for spread in spreads]
        style = {"color": styles[name].colour, "marker": styles[name].marker}
        speed.plot(particles, medians, label=plural(threads, "thread"), **style)
        speed.vlines(particles, [s.low for s in spreads], [s.high for s in spreads], color="black")
    speed.legend(loc="lower left")  # the axis begins at 0, far below the lines
    speed.set_ylabel("ns per particle-step")
    bytes_each = [size.bytes_per_particle for size in sizes]
    first = styles[next(iter(names.values()))]
    memory.plot(particles, bytes_each, color=first.colour, marker=first.marker)
    memory.set_ylabel("bytes per particle")
    for axes in (speed, memory):
        axes.set_xscale("log")
        axes.set_ylim(0, 1.1 * axes.get_ylim()[1])
        axes.set_xlabel("particles")
