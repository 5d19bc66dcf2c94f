"""What is wrong with a description of an engine: every fault of it, at once."""

from __future__ import annotations

import json
import os
import re
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

from .case import CaseError, load_case, varied_table
from .contract import TABLES, UNITS, unit_of
from .names import unknown_name
from .solver import SolverError
from .toml_text import read_tables

LADDER = Path(__file__).resolve().parent.parent / "reference_cases" / "micro"
SMALL_CASE = LADDER / "free_fall.toml"  # where a [scheme] is tried: any case would do
RUN_INPUTS = ("case.json", "packing.csv", "packing.json")
NAME = re.compile(r"[a-z][a-z0-9-]{0,31}")
PLACEHOLDER = re.compile(r"\{(\w*)\}")
MOST = 1e15  # of a number, in its unit: far above any use


def faults(table: dict, path: Path) -> list[str]:
    """A line for each of the description `table` in the file `path`; none of a sound one."""
    return _told(table, path, path.parent, KEYS)


def class_faults(said: dict, description: str, folder: Path) -> list[str]:
    """Likewise of what a class says with CLASS_KEYS; `description` names it, `folder` is that of its file."""
    plain = {key: list(value) if isinstance(value, tuple) else value for key, value in said.items()}
    return _told(plain, description, folder, CLASS_KEYS)


def _told(table: dict, path: Path | str, folder: Path, keys: dict) -> list[str]:
    found = [f"{path}: {fault}" for fault in _faults(table, folder, keys)]
    if _is_scheme(table.get("scheme")):
        found += _scheme_faults(path, table["scheme"])
    return found


def _faults(table: dict, folder: Path, keys: dict) -> Iterator[str]:
    """Of all but what its [scheme] means; `folder` is that of the description."""
    yield from _key_faults(table, keys)
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
    if _is_words(table.get("files")):
        yield from _file_faults(table["files"], folder)
    if _is_tables(table.get("difference")):
        yield from _difference_faults(table["difference"])


def _key_faults(table: dict, keys: dict) -> Iterator[str]:
    """Of `table`, which may have the `keys`: of each, what KEYS says of it."""
    for key, (needed, is_right, expected) in keys.items():
        if key not in table:
            if needed:
                yield f"{key}: is missing: {expected}"
        elif not is_right(table[key]):
            yield f"{key}: {expected}"
    for key in table.keys() - keys.keys():
        yield f"{key}: no such key; there are {', '.join(keys)}"


def _file_faults(files: list[str], folder: Path) -> Iterator[str]:
    """Of `files`, which come to lie in a run's inputs/, each under its own name."""
    first: dict[str, int] = {}
    for number, file in enumerate(files):
        name = Path(file).name
        said = f"files[{number}]: {_quoted(file)}"
        if not _is_below(file):
            yield f"{said} does not lie below the folder of this description; give a path from there, without .."
        elif name in RUN_INPUTS:
            yield f"{said} is the name of crossdem's own input; give it another name"
        elif name in first:
            yield f"{said} has the name of files[{first[name]}], and both are copied into one folder; give it another name"
        elif not os.path.isfile(folder / file):
            yield f"{said} is no file beside this description; put it there, or correct its name"
        first.setdefault(name, number)


def _difference_faults(entries: list[dict]) -> Iterator[str]:
    cases = {path.stem: path for path in sorted(LADDER.glob("*.toml"))}
    first: dict[tuple[str, str], int] = {}
    for number, entry in enumerate(entries):
        faults = list(_key_faults(entry, DIFFERENCE_KEYS))
        if not faults and entry["tolerance"] >= abs(entry["value"]):
            faults.append("tolerance: one that includes 0 says nothing; give one below |value|")
        name, quantity = entry.get("case"), entry.get("quantity")
        if isinstance(name, str) and isinstance(quantity, str):
            if cases and name not in cases:
                faults.append(f"case: {unknown_name('case', name, cases)}")
            elif cases and quantity not in (asked := _answers_asked(cases[name])):
                faults.append(f"quantity: {unknown_name(f'answer of {name}', quantity, asked)}")
            elif (same := first.setdefault((name, quantity), number)) != number:
                faults.append(f"quantity: difference[{same}] has the same; leave one")
        yield from (f"difference[{number}].{fault}" for fault in faults)


def _answers_asked(path: Path) -> list[str]:
    """The quantities that the case in `path`, one of the ladder, has closed forms for."""
    return [entry["quantity"] for entry in read_tables(path).get("answer", [])]


def _scheme_faults(path: Path | str, scheme: dict) -> list[str]:
    """The solver's lines on `scheme`; none where there is no solver, or no case, to ask with."""
    if not SMALL_CASE.exists():
        return []
    try:
        varied_table(replace(load_case(SMALL_CASE), file_name=str(path)), scheme=scheme)
    except CaseError as error:
        return error.faults
    except SolverError:
        return []
    return []


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
        elif not isinstance(source, str):
            units = UNITS.get(unit_of(name), {})
            told = f"its units: {', '.join(units) or 'none'}"
            if not _is_source(source):
                yield f'columns.{name}: the name of a column, or {{ column = "NAME", unit = "UNIT" }}; {told}'
            elif "unit" in source and source["unit"] not in units:
                yield f"columns.{name}: no such unit {_quoted(source['unit'])}; {told}"


def _is_source(value) -> bool:
    return (
        isinstance(value, dict)
        and value.keys() <= {"column", "unit"}
        and all(isinstance(said, str) for said in value.values())
    )


def _quoted(text: str) -> str:
    return json.dumps(text, ensure_ascii=False)


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


def _is_number(value) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool) and 0 < value < MOST


def _is_text(value) -> bool:
    return isinstance(value, str)


def _is_scheme(value) -> bool:
    return isinstance(value, dict) and all(map(_is_text, value.values()))


def _is_tables(value) -> bool:
    return isinstance(value, list) and all(isinstance(entry, dict) for entry in value)


# Of each key of a description, and of its [[difference]] tables: whether it must be there, what it may be, and that in words.
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
        lambda value: value == [] or _is_words(value),
        "names of files beside this one, which are copied into {inputs} of every run",
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
        _is_scheme,
        "readings of the native scheme whose contact law it has, as in the case's [scheme]",
    ),
    "twin_limit_m": (
        False,
        _is_number,
        "how far from that native scheme its particles may be on the ladder, in m",
    ),
    "difference": (
        False,
        _is_tables,
        "tables with the keys case, quantity, value, tolerance and reason, as in the cases of the ladder",
    ),
    **{
        name: (False, lambda value: isinstance(value, dict), "a table: files, separator, columns")
        for name in TABLES
    },
}
# What a class of Python, derived from External, says of itself beside its methods.
CLASS_KEYS = {
    key: KEYS[key]
    for key in ("files", "substeps", "cost_s", "scheme", "twin_limit_m", "difference")
}
DIFFERENCE_KEYS = {
    "case": (True, _is_text, "the name of a case of the ladder"),
    "quantity": (True, _is_text, "the answer of that case that differs"),
    "value": (
        True,
        lambda value: _is_number(value) or type(value) in (int, float) and _is_number(-value),
        "by how much it is above the exact value, a number other than 0; < 0: below",
    ),
    "tolerance": (True, _is_number, "how far from `value` the difference may be, a number above 0"),
    "reason": (True, _is_text, "why it differs, for the reader of a report"),
}
