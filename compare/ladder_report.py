"""The ladder for people and programs: ladder.html (self-contained), ladder.json, junit.xml, and the terminal."""

from __future__ import annotations

import json
from itertools import compress
from pathlib import Path
from xml.etree import ElementTree

from rich import box
from rich.console import Console
from rich.table import Table
from rich.text import Text

from crossdem.adapters.files import write_whole

from . import ladder_tables as tables
from . import rungs
from .colours import engine_styles
from .junit import suite, to_bytes
from .ladder import Ladder
from .pages import render
from .record import libraries, plain
from .summary import COLOURS
from .wording import plural, printable

SCHEMA_VERSION = 1
WIDE = 170  # columns that the whole table needs
IN_NARROW = ("case", "engine", "twin, m", "answer", "order", "limit off", "verdict")
TONES = {
    rungs.AGREES: "green",
    rungs.DIFFERS: "red",
    rungs.NO_RESULT: "magenta",
    rungs.NOT_COMPARABLE: "yellow",
    rungs.NO_SUCH_LAW: "dim",
}
ENDS = {
    rungs.AGREES: None,
    rungs.DIFFERS: "failure",
    rungs.NO_RESULT: "error",
    rungs.NOT_COMPARABLE: "error",
    rungs.NO_SUCH_LAW: "skipped",
}


def write_ladder(ladder: Ladder, folder: Path) -> Path:
    """Write the three files into `folder`, each whole or not at all; returns the path of the page, written last."""
    folder.mkdir(parents=True, exist_ok=True)
    content = plain(
        {"schema_version": SCHEMA_VERSION} | tables.record(ladder) | {"libraries": libraries()}
    )
    text = json.dumps(content, indent=2, ensure_ascii=False, allow_nan=False)
    write_whole(folder / "ladder.json", (text + "\n").encode())
    write_whole(folder / "junit.xml", ladder_junit(ladder))
    write_whole(folder / "ladder.html", render("ladder.html", _values(ladder)).encode())
    return folder / "ladder.html"


def ladder_junit(ladder: Ladder) -> bytes:
    """A test for the verdict and one for each rung; only agreement passes."""
    root = ElementTree.Element("testsuites", name=printable(ladder.name))
    end = "failure" if ladder.exit_code else None
    suite(root, "verdict", [("verdict", ladder.word, end, ladder.sentence)])
    for case in ladder.cases:
        suite(
            root,
            case.name,
            [
                (rung.engine, rung.name, ENDS[rung.outcome], f"{rung.outcome}: {rung.sentence}")
                for rung in ladder.rungs
                if rung.case == case.name
            ],
        )
    return to_bytes(root)


def print_ladder(ladder: Ladder, page: Path, console: Console | None = None) -> None:
    """One row for each case and engine, what does not hold in full, and the verdict."""
    console = console or _console()
    table = Table(box=box.SIMPLE_HEAD, pad_edge=False, header_style="dim")
    shown = [console.width >= WIDE or title in IN_NARROW for title in tables.TITLES]
    for title in compress(tables.TITLES, shown):
        number = title not in ("case", "engine", "answer", "verdict")
        folded = title in ("case", "answer")
        table.add_column(
            title, justify="right" if number else "left", no_wrap=not folded, overflow="fold"
        )
    for cells, outcome in tables.summary_rows(ladder):
        *others, verdict = [Text(printable(cell)) for cell in compress(cells, shown)]
        verdict.stylize(TONES.get(outcome, "dim"))
        table.add_row(*others, verdict)
    console.print(table)
    console.print(
        Text("Of several answers the one that uses up most of its tolerance.", style="dim")
    )
    for line, outcome in dict.fromkeys(_said(rung) for rung in ladder.rungs):
        if outcome != rungs.AGREES:
            console.print(Text(printable(line), style=TONES[outcome]), soft_wrap=True)
    console.print(Text(ladder.word, style=f"bold {COLOURS[ladder.word]}"))
    console.print(Text(printable(ladder.sentence)), soft_wrap=True)
    console.print(Text(f"Next: {ladder.next_step}"), soft_wrap=True)
    console.print(Text(f"Report: {page}"), soft_wrap=True)


def _said(rung: rungs.Rung) -> tuple[str, str]:
    """A line and its tone's outcome; an engine that lacks the law of a case says so once."""
    whole = rung.outcome == rungs.NO_SUCH_LAW
    place = f"{rung.case}, {rung.engine}" + ("" if whole else f", {rung.name}")
    return f"{place}: {rung.sentence}", rung.outcome


def _console() -> Console:
    console = Console()
    return console if console.is_terminal else Console(width=WIDE)


def _values(ladder: Ladder) -> dict:
    styles = engine_styles(ladder.engines)
    blocks = []
    for case in ladder.cases:
        rows = []
        for engine in ladder.engines:
            found = ladder.of(case.name, engine)
            rows.append(
                (
                    engine,
                    f"{tables.tiny(case.steps_s[engine], 3)} s",
                    [tables.twin_cells(rung) for rung in found if rung.kind == rungs.TWIN],
                    [tables.answer_cells(rung) for rung in found if rung.kind != rungs.TWIN],
                )
            )
        blocks.append((case, rows))
    held = sum(rung.outcome == rungs.AGREES for rung in ladder.rungs)
    return {
        "ladder": ladder,
        "title": f"Ladder: {ladder.name}",
        "colours": {engine: style.colour for engine, style in styles.items()},
        "engines": ladder.engines,
        "held": f"{held} of {plural(len(ladder.compared), 'rung')}",
        "on": plural(len(ladder.cases), "case"),
        "outcomes": {(row[0][0], row[0][1]): row[1] for row in tables.summary_rows(ladder)},
        "blocks": blocks,
        "libraries": libraries(),
    }
