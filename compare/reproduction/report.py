"""A reproduction for people and programs: reproduce.html (self-contained), .csv, .json, every figure, the terminal."""

from __future__ import annotations

from collections import Counter
from dataclasses import asdict
from pathlib import Path

from markupsafe import Markup
from rich.console import Console
from rich.table import Table
from rich.text import Text

import pandas as pd

from crossdem.adapters.files import write_whole
from crossdem.adapters.gates import REFERENCE

from ..drawing import png_figure, svg_figure, svg_file
from ..pages import render, write_record
from ..provenance import provenance
from ..record import libraries
from ..wording import plural, printable
from .reproduce import Reproduction
from .study import VERDICTS, Picture


def write_reproduction(reproduction: Reproduction, folder: Path) -> Path:
    """Write all files into `folder`, each whole or not at all; returns the path of the page, written last."""
    case = reproduction.found.case
    folder.mkdir(parents=True, exist_ok=True)
    claims = pd.DataFrame([asdict(claim) for claim in reproduction.claims])
    write_whole(folder / "claims.csv", claims.to_csv(index=False).encode())
    drawings = {
        picture.name: _write_picture(picture, folder)
        for findings in reproduction.findings
        for picture in findings.pictures
    }
    write_record(case, folder / "reproduce.json", _record(reproduction))
    values = {
        "title": case.resolved["title"],
        "case": case,
        "headline": headline(reproduction),
        "findings": reproduction.findings,
        "drawings": drawings,
        "claims": reproduction.claims,
        "size": size_in_words(reproduction),
        "left_out": left_out(reproduction),
        "samples": sample_rows(reproduction),
        "provenance": provenance(_manifests(reproduction)),
        "libraries": libraries(),
    }
    write_whole(folder / "reproduce.html", render("reproduce.html", values).encode())
    return folder / "reproduce.html"


def print_reproduction(
    reproduction: Reproduction, page: Path, console: Console | None = None
) -> None:
    """The claims as a table, what went otherwise, and where the page is."""
    console = console or Console()
    table = Table(box=None, pad_edge=False, header_style="dim")
    for title in ("here", "the paper says", "the number that tells"):
        table.add_column(title)
    for claim in reproduction.claims:
        table.add_row(
            *(Text(printable(cell)) for cell in (claim.verdict, claim.says, claim.number))
        )
    console.print(table)
    for name, why in left_out(reproduction):
        console.print(Text(printable(f"{name}: {why}"), style="magenta"))
    console.print(Text(headline(reproduction), style="bold"))
    console.print(Text(f"Report: {page}"), soft_wrap=True)


def headline(reproduction: Reproduction) -> str:
    """ "Of 14 claims 8 are reproduced, 2 reproduced with a correction, ..."."""
    counts = Counter(claim.verdict for claim in reproduction.claims)
    parts = [f"{counts[verdict]} {verdict}" for verdict in VERDICTS if counts[verdict]]
    return f"Of {plural(len(reproduction.claims), 'claim')}: {', '.join(parts)}."


def size_in_words(reproduction: Reproduction) -> str:
    size = reproduction.found.size
    others = [engine for engine in size.engines if engine != REFERENCE]
    beside = f", {' and '.join(others)} {plural(size.of(others[0]), 'packing')}" if others else ""
    return f"{REFERENCE} {plural(size.seeds, 'packing')} of each setting{beside}"


def left_out(reproduction: Reproduction) -> list[tuple[str, str]]:
    """Runs that are in no number: setting and engine, how many they are, and what the first of them says."""
    return [
        (
            f"{name} in {engine}",
            f"{plural(len(sample.left_out), 'run')} left out: {sample.left_out[0]}",
        )
        for (name, engine), sample in reproduction.found.samples.items()
        if sample.left_out
    ]


def sample_rows(reproduction: Reproduction) -> list[tuple[str, str, int]]:
    """Setting, engine, packings that count."""
    return [
        (name, engine, sample.packings)
        for (name, engine), sample in reproduction.found.samples.items()
    ]


def _write_picture(picture: Picture, folder: Path) -> Markup:
    """NAME.svg, .png and .csv; the drawing for the page."""
    write_whole(folder / f"{picture.name}.svg", svg_file(picture.draw, picture.size_px))
    write_whole(folder / f"{picture.name}.png", png_figure(picture.draw, picture.size_px))
    if picture.table is not None:
        write_whole(folder / f"{picture.name}.csv", picture.table.to_csv(index=False).encode())
    return Markup(svg_figure(picture.draw, picture.size_px))


def _manifests(reproduction: Reproduction) -> list[dict]:
    return [one for sample in reproduction.found.samples.values() for one in sample.manifests]


def _record(reproduction: Reproduction) -> dict:
    """Every number of every run that counts, for other programs."""
    return {
        "headline": headline(reproduction),
        "claims": [asdict(claim) for claim in reproduction.claims],
        "samples": [
            {
                "setting": name,
                "engine": engine,
                "values": sample.endpoints.reset_index(names="seed").to_dict("records"),
                "left_out": sample.left_out,
            }
            for (name, engine), sample in reproduction.found.samples.items()
        ],
        "libraries": libraries(),
        "provenance": asdict(provenance(_manifests(reproduction))),
    }
