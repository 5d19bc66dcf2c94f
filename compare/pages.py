"""Pages from templates, and files that are there whole or not at all."""

from __future__ import annotations

import os
import re
from pathlib import Path

import jinja2
from markupsafe import Markup, escape

from .wording import MINUS, printable

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
    environment.filters |= {"cell": _cell, "glued": _glued, "shown": _shown}
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


def _glued(text: str) -> str:
    """Numbers that do not break from their units, only at "to", "/" and before the scatter."""
    return re.sub(r"(?<!to)(?<!/) (?!to\b|/|±)", "\N{NO-BREAK SPACE}", text)


def _shown(value: object) -> str:
    """A value of a manifest: numbers short, whatever else as it is."""
    return f"{value:.3g}".replace("-", MINUS) if isinstance(value, float) else str(value)


def write_whole(path: Path, content: bytes) -> None:
    """Replace `path` by `content`, whole or not at all."""
    partial = path.with_name(f".{path.name}.partial")
    with partial.open("wb") as file:
        file.write(content)
        file.flush()
        os.fsync(file.fileno())
    partial.replace(path)
