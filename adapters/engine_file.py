"""An engine from a TOML file, as docs/own_engine.md describes it."""

from __future__ import annotations

import subprocess
from functools import cached_property
from pathlib import Path

from .case import Case
from .contract import TABLES, UNITS, Column, Columns, unit_of
from .engine import INPUTS, OUTPUT, EngineNotFound
from .engine_file_faults import PLACEHOLDER, faults
from .external import External
from .toml_text import TextError, read_tables

VERSION_LIMIT_S = 60.0
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
        self.difference = table.get("difference", ())
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
    if found := faults(table, path):
        raise EngineFileError("\n".join(found))
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
