"""Pages from templates, and what is written beside them."""

from __future__ import annotations

import json
from pathlib import Path

import jinja2
import pandas as pd
from markupsafe import Markup, escape

from crossdem.adapters.case import Case
from crossdem.adapters.files import write_whole

from .record import libraries, plain
from .wording import MINUS, glued, printable

TEMPLATES = Path(__file__).parent / "templates"


def render(name: str, values: dict) -> str:
    """The template `name` with `values`; text among them is escaped, Markup is not."""
    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader(TEMPLATES),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        finalize=_printable,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters |= {"cell": _cell, "glued": glued, "shown": _shown, "css": _css}
    style = Markup((TEMPLATES / "report.css").read_text(encoding="utf-8"))
    return environment.get_template(name).render(values | {"style": style})


def _printable(value: object) -> object:
    return printable(value) if isinstance(value, str) and not isinstance(value, Markup) else value


def _cell(text: object) -> Markup:
    """Text for Markdown: one line, with none of HTML's or Markdown's own characters at work."""
    line = " ".join(printable(str(text)).split())
    for character in "\\`*_[]|~#":
        line = line.replace(character, f"\\{character}")
    return escape(line)


def _shown(value: object) -> str:
    """A value of a manifest: numbers short, whatever else as it is."""
    return f"{value:.3g}".replace("-", MINUS) if isinstance(value, float) else str(value)


def _css(words: str) -> str:
    """The class in report.css that a verdict or an outcome is shown in."""
    return words.lower().replace(" ", "-")


def write_finding(
    case: Case,
    folder: Path,
    name: str,
    table: pd.DataFrame,
    record: dict,
    picture: bytes,
    values: dict,
) -> Path:
    """NAME.csv, .json, .png and .html in `folder`, each whole or not at all; returns the path of the page, written last."""
    folder.mkdir(parents=True, exist_ok=True)
    write_whole(folder / f"{name}.csv", table.to_csv(index=False).encode())
    write_record(case, folder / f"{name}.json", record | {"libraries": libraries()})
    write_whole(folder / f"{name}.png", picture)
    page = {"title": case.resolved["title"], "case": case, "libraries": libraries()} | values
    write_whole(folder / f"{name}.html", render(f"{name}.html", page).encode())
    return folder / f"{name}.html"


def write_record(case: Case, path: Path, record: dict) -> None:
    """What was found of `case`, as JSON."""
    about = {"name": case.name, "title": case.resolved["title"], "hash": case.hash}
    content = plain({"schema_version": 1, "case": about} | record)
    text = json.dumps(content, indent=2, ensure_ascii=False, allow_nan=False)
    write_whole(path, (text + "\n").encode())
