"""An engine from a TOML file, as docs/own_engine.md describes it: every fault of it is told at once."""

from __future__ import annotations

import re
import subprocess
from collections.abc import Iterator
from functools import cached_property
from pathlib import Path

from .case import Case
from .contract import TABLES, UNITS, Column, Columns, unit_of
from .engine import INPUTS, OUTPUT, EngineNotFound
from .external import External
from .toml_text import TextError, read_tables

RUN_INPUTS = ("case.json", "packing.csv", "packing.json")
NAME = re.compile(r"[a-z][a-z0-9-]{0,31}")
PLACEHOLDER = re.compile(r"\{(\w*)\}")
VERSION_LIMIT_S = 60.0
MOST = 1e15  # of a number, in its unit: far above any use
LONGEST_VERSION = 200  # characters


class EngineFileError(Exception):
    """A description of an engine that cannot be used; the text has a line per fault."""


class Described(External):
    """The engine of a TOML file."""

    def __init__(self, source: Path, table: dict):
        super().__init__(source)
        self.name = table["name"]
        self._version_words = table["version"]
        self._run_words = table["run"]
        self.program = self._run_words[0]
        self.files = table.get("files", ())
        self.substeps = table.get("substeps", 1)
        self.scheme = table.get("scheme", {})
        self.twin_limit_m = table.get("twin_limit_m")
        self.cost_s = table.get("cost_s", self.cost_s)
        self.differences = table.get("difference", ())
        self.columns = {name: _columns(table[name]) for name in TABLES if name in table}
        if "progress" in table:
            self.samples_file = f"{OUTPUT}/{table['progress']}"

    def version(self) -> str:
        return self._version

    def command(self, case: Case, run_dir: Path) -> list[str]:
        values = {
            "case": f"{INPUTS}/case.json",
            "packing": f"{INPUTS}/packing.csv",
            "inputs": INPUTS,
            "out": OUTPUT,
            "step_s": repr(self.step_s(case)),
        }
        return [PLACEHOLDER.sub(lambda found: values[found[1]], word) for word in self._run_words]

    @cached_property
    def _version(self) -> str:
        """The first line that it prints; asked once, in the folder of its description."""
        self.executable()
        words = self._version_words
        try:
            asked = subprocess.run(
                words,
                cwd=self.source.parent,
                capture_output=True,
                stdin=subprocess.DEVNULL,
                timeout=VERSION_LIMIT_S,
            )
        except (OSError, subprocess.TimeoutExpired) as error:
            raise EngineNotFound(f"{self.name} does not say its version: {error}") from error
        lines = (asked.stdout or asked.stderr).decode(errors="replace").split("\n")
        said = " ".join(next((line for line in lines if line.strip()), "").split())
        if asked.returncode or not said.isprintable() or not 0 < len(said) <= LONGEST_VERSION:
            raise EngineNotFound(
                f"{self.name} does not say its version: {' '.join(words)} ended with status {asked.returncode} and "
                f"the line {said[:LONGEST_VERSION]!r}"
            )
        return said


def read_engine(path: Path) -> Described:
    """Raises EngineFileError with every fault there is to tell."""
    try:
        table = read_tables(path)
    except TextError as error:
        raise EngineFileError(str(error)) from error
    if found := list(_faults(table)):
        raise EngineFileError("\n".join(f"{path}: {fault}" for fault in found))
    return Described(path, table)


def _columns(table: dict) -> Columns:
    columns = {}
    for name, source in table.get("columns", {}).items():
        if isinstance(source, str):
            columns[name] = Column(source)
        else:
            unit = source.get("unit")
            factor = UNITS[unit_of(name)][unit] if unit else 1.0
            columns[name] = Column(source.get("column", name), factor)
    return Columns(table.get("files"), table.get("separator", ","), columns)


def _faults(table: dict) -> Iterator[str]:
    for key, (needed, is_right, expected) in KEYS.items():
        if key not in table:
            if needed:
                yield f"{key}: is missing: {expected}"
        elif not is_right(table[key]):
            yield f"{key}: {expected}"
    for key in table.keys() - KEYS.keys():
        yield f"{key}: no such key; there are {', '.join(KEYS)}"
    for key, allowed in (
        ("run", {"case", "packing", "inputs", "out", "step_s"}),
        ("version", set()),
    ):
        if _is_words(table.get(key)):
            for word in table[key]:
                for name in PLACEHOLDER.findall(word):
                    if name not in allowed:
                        said = ", ".join(f"{{{one}}}" for one in sorted(allowed)) or "none"
                        yield f"{key}: {{{name}}} stands for nothing; placeholders here: {said}"
    for name, (_, columns) in TABLES.items():
        if isinstance(table.get(name), dict):
            yield from (f"{name}.{fault}" for fault in _table_faults(table[name], columns))


def _table_faults(table: dict, known: tuple[str, ...]) -> Iterator[str]:
    for key in table.keys() - {"files", "separator", "columns"}:
        yield f"{key}: no such key; there are files, separator, columns"
    if "files" in table and not _is_below(table["files"]):
        yield 'files: the pattern of a file in {out}, such as "frame_*.csv"'
    if table.get("separator", ",") not in (",", ";", " ", "\t"):
        yield 'separator: one of ",", ";", " " (any white space), "\\t"'
    columns = table.get("columns", {})
    if not isinstance(columns, dict):
        yield "columns: a table, from a column of the contract to its name in the file"
        return
    for name, source in columns.items():
        if name not in known:
            yield f"columns.{name}: no such column; there are {', '.join(known)}"
        elif not isinstance(source, str) and not _is_source(source, UNITS.get(unit_of(name), {})):
            units = ", ".join(UNITS.get(unit_of(name), {})) or "none"
            yield (
                f'columns.{name}: the name of a column, or {{ column = "NAME", unit = "UNIT" }}; its units: {units}'
            )


def _is_source(source, units) -> bool:
    return (
        isinstance(source, dict)
        and source.keys() <= {"column", "unit"}
        and isinstance(source.get("column", ""), str)
        and source.get("unit", next(iter(units), None)) in tuple(units or (None,))
    )


def _is_words(value) -> bool:
    """Of a command: no system takes one with a zero byte."""
    return (
        isinstance(value, list)
        and value != []
        and all(isinstance(word, str) and word and "\0" not in word for word in value)
    )


def _is_below(value) -> bool:
    """A path or pattern that stays in its folder."""
    parts = Path(value).parts if isinstance(value, str) and "\0" not in value else ("..",)
    return parts != () and ".." not in parts and not Path(value).is_absolute()


def _have_places(files: list[str]) -> bool:
    """Whether each can lie in a run's inputs/ under its own name."""
    names = [*RUN_INPUTS, *(Path(file).name for file in files)]
    return all(map(_is_below, files)) and len(set(names)) == len(names)


def _is_number(value) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool) and 0 < value < MOST


def _is_difference(entry) -> bool:
    texts, numbers = ("case", "quantity", "reason"), ("value", "tolerance")
    return (
        isinstance(entry, dict)
        and entry.keys() == {*texts, *numbers}
        and all(isinstance(entry[key], str) for key in texts)
        and isinstance(entry["value"], (int, float))
        and _is_number(entry["tolerance"])
    )


# Of each key: whether it must be there, what it may be, and that in words.
KEYS = {
    "name": (
        True,
        lambda value: isinstance(value, str) and NAME.fullmatch(value),
        "small letters, digits and hyphens, a letter first, 32 at most",
    ),
    "version": (
        True,
        _is_words,
        'the command that prints its version, such as ["mycode", "--version"]',
    ),
    "run": (
        True,
        _is_words,
        'the command that runs it, such as ["mycode", "--case", "{case}", "--packing", "{packing}", "--out", "{out}"]',
    ),
    "files": (
        False,
        lambda value: value == [] or _is_words(value) and _have_places(value),
        "files beside this one, which are copied into {inputs} of every run, beside case.json, packing.csv and packing.json: no "
        "two of one name",
    ),
    "substeps": (
        False,
        lambda value: type(value) is int and 1 <= value <= 1000,
        "how many time steps it makes in one of the case's time.step_s: 1 to 1000",
    ),
    "progress": (False, _is_below, "a file in {out} that grows by one line per sample"),
    "cost_s": (False, _is_number, "seconds of CPU time per particle and time step, roughly"),
    "scheme": (
        False,
        lambda value: isinstance(value, dict)
        and all(isinstance(one, str) for one in value.values()),
        "readings of the native scheme whose contact law it has, as in the case's [scheme]",
    ),
    "twin_limit_m": (
        False,
        _is_number,
        "how far from that native scheme its particles may be on the ladder, in m",
    ),
    "difference": (
        False,
        lambda value: isinstance(value, list) and all(map(_is_difference, value)),
        "tables with the keys case, quantity, value, tolerance and reason, as in the cases of the ladder",
    ),
    **{
        name: (False, lambda value: isinstance(value, dict), "a table: files, separator, columns")
        for name in TABLES
    },
}
