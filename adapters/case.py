"""The Python front of a case: TOML text in, the solver's resolved case out. It knows no key of the schema."""

import copy
import hashlib
import json
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

from .overrides import OverrideError, apply_override
from .solver import call_solver, messages
from .toml_text import TextError, read_tables


# Tables and keys that say how runs are judged: no engine reads them.
JUDGED_BY = ("title", "check")


class CaseError(Exception):
    """A case that cannot be used; `faults` holds one printable line per fault."""

    def __init__(self, faults: Sequence[str]):
        super().__init__("\n".join(faults))
        self.faults = list(faults)


@dataclass(frozen=True)
class Case:
    """A validated case: every default filled in, SI units."""

    resolved: dict
    canonical: bytes  # the solver's JSON: keys sorted, no white space
    warnings: tuple[str, ...] = field(default=(), compare=False)  # printable lines
    file_name: str = field(default="case.json", compare=False)  # as messages name it
    changes: tuple[str, ...] = field(default=(), compare=False)  # overrides of what the file says

    @property
    def hash(self) -> str:
        """SHA-256 [hex] of the canonical JSON: the case's identity."""
        return hashlib.sha256(self.canonical).hexdigest()

    @property
    def run_hash(self) -> str:
        """SHA-256 [hex] of all that runs depend on: another margin needs no other runs."""
        read = {key: value for key, value in self.resolved.items() if key not in JUDGED_BY}
        return hashlib.sha256(_canonical(read)).hexdigest()

    @property
    def name(self) -> str:
        return self.resolved["name"]

    @classmethod
    def from_canonical(cls, canonical: bytes) -> "Case":
        return cls(json.loads(canonical), canonical)

    @classmethod
    def from_resolved(cls, resolved: dict) -> "Case":
        """From a resolved case at hand as a dict, such as a dataset's."""
        return cls(resolved, _canonical(resolved))


def _canonical(values: dict) -> bytes:
    return json.dumps(values, sort_keys=True, separators=(",", ":"), ensure_ascii=False).encode()


def load_case(
    path: Path | str,
    overrides: Sequence[str] = (),
    further_faults: Callable[[dict], list[str]] = lambda raw: [],
) -> Case:
    """Reads a case file, applies `key.path=value` overrides and has the solver validate the whole.

    `further_faults` tells what the solver cannot know: fault lines of the case as it was read, whatever that holds.
    Raises CaseError with every fault there is to tell, SolverError where there is no solver to ask.
    """
    try:
        raw = read_tables(Path(path))
    except TextError as error:
        raise CaseError([str(error)]) from error
    if faults := _apply(raw, overrides):
        raise CaseError(faults)
    further = [f"{path}: {fault}" for fault in further_faults(raw)]
    try:
        case = _resolve(raw, str(path))
    except CaseError as error:
        raise CaseError(error.faults + further) from error
    if further:
        raise CaseError(further)
    return replace(case, changes=tuple(overrides))


def varied(case: Case, overrides: Sequence[str]) -> Case:
    """`case` with `key.path=value` overrides, validated anew. Every other value stays as it is, also where it had been
    filled in from one that now changes. Raises CaseError, SolverError.
    """
    values = copy.deepcopy(case.resolved)
    if faults := _apply(values, overrides):
        raise CaseError(faults)
    return _resolve(values, case.file_name)


def varied_table(case: Case, **tables: dict | None) -> Case:
    """`case` with whole tables of other values, what they leave out at its default; None takes a table away.

    Raises CaseError, SolverError.
    """
    values = copy.deepcopy(case.resolved) | tables
    kept = {key: value for key, value in values.items() if value is not None}
    return _resolve(kept, case.file_name)


def _apply(tables: dict, overrides: Sequence[str]) -> list[str]:
    """Sets each value in place; a fault line for each that cannot be."""
    faults = []
    for override in overrides:
        try:
            apply_override(tables, override)
        except OverrideError as error:
            faults.append(f"--set {override}: {error}")
    return faults


def _resolve(raw: dict, file_name: str) -> Case:
    try:
        text = json.dumps(_to_json(raw), ensure_ascii=False).encode()
    except RecursionError as error:
        raise CaseError([f"{file_name}: nested too deeply"]) from error
    except UnicodeEncodeError as error:  # JSON's escapes can say half a character
        half = f"\\u{ord(error.object[error.start]):04x}"
        raise CaseError(
            [f"{file_name}: {half} is half a character; give its other half, too"]
        ) from error
    done = call_solver(["resolve", "-", f"--file-name={file_name}"], stdin=text)
    said = messages(done.stderr)
    if done.returncode:
        raise CaseError(said or [f"{file_name}: refused by crossdem-solver without a word"])
    canonical = done.stdout.rstrip(b"\n")
    return Case(json.loads(canonical), canonical, tuple(said), file_name)


def _to_json(value):
    """TOML's values as JSON's. What JSON lacks becomes a string, which the solver refuses by its key path."""
    if isinstance(value, dict):
        return {key: _to_json(entry) for key, entry in value.items()}
    if isinstance(value, list):
        return [_to_json(entry) for entry in value]
    if isinstance(value, (bool, str)):
        return value
    if isinstance(value, int):
        return value if abs(value) < 2**63 else "an integer beyond 64 bits"
    if isinstance(value, float):
        return value if abs(value) < float("inf") else str(value)
    return value.isoformat()  # TOML's dates and times
