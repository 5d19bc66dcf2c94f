"""Pages from templates, and what is written beside them."""

from __future__ import annotations

import base64
import hashlib
import json
from collections.abc import Iterable
from pathlib import Path

import jinja2
import pandas as pd
from markupsafe import Markup, escape

from crossdem.adapters.case import Case
from crossdem.adapters.files import write_whole

from .record import libraries, plain
from .wording import MINUS, glued, printable

TEMPLATES = Path(__file__).parent / "templates"
ASSETS = Path(__file__).parent / "assets"


def render(name: str, values: dict, assets: Iterable[str] = ()) -> str:
    """The template `name` with `values`; text among them is escaped, Markup is not.

    The scripts and styles among the `assets` become part of the page, which allows these scripts by their hash and no other.
    """
    assets = list(assets)
    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader(TEMPLATES),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        finalize=_printable,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters |= {"cell": _cell, "glued": glued, "shown": _shown, "css": _css}
    scripts = [_text(ASSETS / asset) for asset in assets if asset.endswith(".js")]
    styles = [_text(ASSETS / asset) for asset in assets if asset.endswith(".css")]
    own = {
        "style": Markup("\n").join([*styles, _text(TEMPLATES / "report.css")]),
        "scripts": scripts,
        "script_sources": Markup(" ".join(map(_source, scripts))) or Markup("'none'"),
    }
    return environment.get_template(name).render(values | own)


def embedded(data: object) -> Markup:
    """`data` as JSON that can stand in a <script> element, whatever texts are in it."""
    text = json.dumps(data, ensure_ascii=False, allow_nan=False, separators=(",", ":"))
    return Markup(text.replace("<", "\\u003c"))


def _text(path: Path) -> Markup:
    return Markup(path.read_text(encoding="utf-8"))


def _source(script: str) -> str:
    """What a content security policy calls this very script."""
    return f"'sha256-{base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()}'"


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
