"""Where a user's code stands, for people and programs: conform.html, conform.md, conform.json, badge.json and badge.svg."""

from __future__ import annotations

import json
from pathlib import Path

from rich.console import Console
from rich.text import Text

from crossdem.adapters.files import write_whole

from . import rungs
from .conformity import Conformity, hint
from .pages import render
from .record import check_record, libraries, plain
from .summary import COLOURS
from .wording import explanation, plural, printable

SCHEMA_VERSION = 1
LABEL = "crossdem"
LETTER_PX, PAD_PX, HEIGHT_PX = 6.6, 12, 20
TONES = {
    "brightgreen": "#2f7d1f",
    "green": "#3d7a4a",
    "red": "#b3372a",
    "yellow": "#8a6d00",
    "lightgrey": "#656b73",
}


def write_conformity(found: Conformity, folder: Path) -> Path:
    """Write the five files into `folder`, each whole or not at all; returns the path of the page, written last."""
    folder.mkdir(parents=True, exist_ok=True)
    write_whole(folder / "conform.json", _json(_record(found)))
    write_whole(folder / "badge.json", _json(badge(found)))
    write_whole(folder / "badge.svg", render("badge.svg", _badge_values(found)).encode())
    values = _values(found)
    write_whole(folder / "conform.md", render("conform.md", values).encode())
    write_whole(folder / "conform.html", render("conform.html", values).encode())
    return folder / "conform.html"


def badge(found: Conformity) -> dict:
    """The endpoint that shields.io makes a badge of."""
    return {
        "schemaVersion": 1,
        "label": LABEL,
        "message": printable(found.message),
        "color": found.colour,
    }


def print_conformity(found: Conformity, page: Path, console: Console | None = None) -> None:
    console = console or Console()
    console.print(Text(found.word, style=f"bold {COLOURS[found.word]}"))
    console.print(
        Text(printable(f"{found.engine}, {found.version}: {found.message}")), soft_wrap=True
    )
    for rung in found.differing:
        console.print(
            Text(printable(f"{rung.case}, {rung.name}: {rung.sentence}"), style="red"),
            soft_wrap=True,
        )
    console.print(Text(printable(f"Look first: {found.look_first}")), soft_wrap=True)
    console.print(Text(f"Report: {page}"), soft_wrap=True)


def _record(found: Conformity) -> dict:
    return {
        "schema_version": SCHEMA_VERSION,
        "engine": found.engine,
        "version": found.version,
        "verdict": found.word,
        "exit_code": int(found.exit_code),
        "ladder": {
            "verdict": found.ladder.word,
            "held": found.rungs_held,
            "declared": [
                {
                    "case": rung.case,
                    "rung": rung.name,
                    "said": rung.sentence,
                    "reason": rung.reason,
                }
                for rung in found.declared
            ],
            "compared": len(found.ladder.compared),
            "not_offered": _declined(found),
            "differing": [
                {"case": rung.case, "rung": rung.name, "said": rung.sentence, "hint": hint(rung)}
                for rung in found.differing
            ],
        },
        "bed": {
            "tier": found.tier,
            "verdict": found.bed.verdict.word,
            "sentence": found.bed.verdict.sentence,
            "checks": [check_record(result) for result in found.own_results],
        }
        if found.bed
        else None,
        "look_first": found.look_first,
        "libraries": libraries(),
    }


def _declined(found: Conformity) -> dict[str, str]:
    """By case, what the code says that it lacks."""
    lacking = [rung for rung in found.ladder.rungs if rung.outcome == rungs.NO_SUCH_LAW]
    return {rung.case: rung.sentence.removeprefix("not comparable: ") for rung in lacking}


def _values(found: Conformity) -> dict:
    bed_rows = [
        (
            result.check.quantity.title,
            " against ".join(result.pair),
            result.outcome,
            explanation(result),
        )
        for result in found.own_results
    ]
    return {
        "found": found,
        "title": f"{found.engine}: where it stands",
        "differing": [(rung, hint(rung)) for rung in found.differing],
        "declined": _declined(found),
        "held": f"{found.rungs_held} of {plural(len(found.ladder.compared), 'rung')}",
        "on": plural(len({rung.case for rung in found.ladder.compared}), "case"),
        "bed_rows": bed_rows,
        "libraries": libraries(),
    }


def _badge_values(found: Conformity) -> dict:
    message = printable(found.message)
    left, right = (LETTER_PX * len(text) + PAD_PX for text in (LABEL, message))
    return {
        "label": LABEL,
        "message": message,
        "left": f"{left:.0f}",
        "right": f"{right:.0f}",
        "width": f"{left + right:.0f}",
        "height": HEIGHT_PX,
        "label_x": f"{left / 2:.1f}",
        "message_x": f"{left + right / 2:.1f}",
        "tone": TONES[found.colour],
    }


def _json(content: dict) -> bytes:
    return (
        json.dumps(plain(content), indent=2, ensure_ascii=False, allow_nan=False) + "\n"
    ).encode()
