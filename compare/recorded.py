"""The recorded ensemble: what the judge reads of finished runs, small enough to stand beside the case.

A folder of plain files with SHA256SUMS, which `sha256sum -c` reads. Runs on its packings made elsewhere are compared with
it by the judge as if all had been made here.
"""

from __future__ import annotations

import hashlib
import json
import shutil
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from crossdem.adapters.case import Case, CaseError
from crossdem.adapters.dataset import Dataset
from crossdem.adapters.files import write_whole
from crossdem.adapters.packing import Packing, PackingError
from crossdem.adapters.workspace import WorkspaceError

from . import recorded_tables as tables
from .ensemble import Ensemble

RECORDS = Path(__file__).resolve().parent.parent / "reference_cases" / "expected"
SUMS = "SHA256SUMS"
SCHEMA_VERSION = 1  # of manifest.json and all beside it
CONTENT = "content_sha256"  # of a run's manifest as recorded: fingerprint.content_sha256
DATE = "recorded_utc"  # of a run's manifest as read, from the record's own


def check_writable(folder: Path) -> None:
    """Raises WorkspaceError where no record can be written into `folder`, before there are runs; leaves nothing."""
    made = []
    try:
        partial = _partial(folder).absolute()
        made = [place for place in (partial, *partial.parents) if not place.exists()]
        partial.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise WorkspaceError(
            f"{folder}: cannot be written: {error.strerror}; choose another folder with --record"
        ) from error
    finally:
        for place in made:
            with suppress(OSError):
                place.rmdir()


class RecordError(CaseError):
    """A folder that holds no usable record, or none of this case."""


@dataclass(frozen=True)
class Record:
    """Runs of one case. The ensemble's manifests hold CONTENT beside what those of an ensemble hold."""

    case: Case
    ensemble: Ensemble
    packings: Mapping[int, str]  # packing.csv by seed
    about_packings: Mapping[int, dict]  # packing.json by seed
    about: dict  # manifest.json: what, when, with what
    source: str = "the record"  # for people
    # Of runs that lie there whole: a package has them, a record of small tables has none.
    folders: Mapping[tuple[str, int, int], Path] = field(default_factory=dict)

    @property
    def seeds(self) -> tuple[int, ...]:
        return tuple(sorted(self.packings))

    @property
    def datasets(self) -> Iterator[Dataset]:
        """The ensemble's runs that lie there whole, twin 0 of each packing: what pictures are drawn of."""
        whole = (run for run in self.ensemble.manifests if run in self.folders and run[2] == 0)
        return (Dataset.read(self.folders[run]) for run in whole)

    def selected(self, runs: Iterable[tuple[str, int, int]]) -> Record:
        """With these of its runs alone, and all its packings."""
        return replace(self, ensemble=self.ensemble.selected(runs))

    def write(self, folder: Path) -> None:
        """Into `folder`, in place of what was there: whole or not at all."""
        partial = _partial(folder)
        shutil.rmtree(partial, ignore_errors=True)
        partial.mkdir(parents=True)
        contents = self._contents()
        for name, content in contents.items():
            write_whole(partial / name, content)
        sums = (f"{_sha256(content)}  {name}\n" for name, content in sorted(contents.items()))
        write_whole(partial / SUMS, "".join(sums).encode())
        old = folder.with_name(f".{folder.name}.old")  # until the new one is there
        shutil.rmtree(old, ignore_errors=True)
        if folder.exists():
            folder.rename(old)
        partial.rename(folder)
        shutil.rmtree(old, ignore_errors=True)

    @classmethod
    def read(cls, folder: Path) -> Record:
        """Raises RecordError when a file was changed, is missing, or was added."""
        contents = _verified(Path(folder))
        try:
            layout = json.loads(contents["manifest.json"])["schema_version"]
            if layout != SCHEMA_VERSION:
                raise ValueError(
                    f"its layout is {layout}, and this crossdem reads {SCHEMA_VERSION}"
                )
            values = {name: _READERS[name](contents[name]) for name in _READERS}
            about, manifests = values["manifest.json"], values["runs.json"]
            manifests = {run: facts | {DATE: about[DATE]} for run, facts in manifests.items()}
            about_packings = {int(seed): entry for seed, entry in values["packings.json"].items()}
        except (LookupError, ValueError, TypeError, AttributeError, OSError) as error:
            said = f"lacks {error}" if isinstance(error, KeyError) else str(error)
            raise RecordError(
                [
                    f"{folder}: holds no recorded ensemble that can be read: {said}. `crossdem record` makes it anew"
                ]
            ) from error
        ensemble = Ensemble(
            values["endpoints.csv"], values["profiles.csv.gz"], values["fields.csv.gz"], manifests
        )
        return cls(values["case.json"], ensemble, values["packings.csv.gz"], about_packings, about)

    def restore(self, seed: int, folder: Path) -> Packing:
        """The packing of `seed`, made in `folder` unless it is there already. Raises WorkspaceError for another one there."""
        text = self.packings[seed]
        try:
            there = Packing.read(folder)
        except PackingError:
            shutil.rmtree(folder, ignore_errors=True)
        else:
            if there.hash != _sha256(text.encode()):
                raise WorkspaceError(
                    f"{folder}: another packing than the recorded one of seed {seed}; choose another folder with --out"
                )
            return there
        folder.parent.mkdir(parents=True, exist_ok=True)
        unfinished = folder.with_name(f".{folder.name}.partial")
        shutil.rmtree(unfinished, ignore_errors=True)
        unfinished.mkdir()
        (unfinished / "packing.csv").write_bytes(text.encode())
        about = json.dumps(self.about_packings[seed])
        (unfinished / "packing.json").write_text(about + "\n", encoding="utf-8")
        unfinished.rename(folder)
        return Packing.read(folder)

    def _contents(self) -> dict[str, bytes]:
        about = {DATE: self.about[DATE]} | self.about
        manifests = {
            run: {key: value for key, value in facts.items() if key != DATE}
            for run, facts in self.ensemble.manifests.items()
        }
        return {
            "manifest.json": _json(about),
            "case.json": self.case.canonical + b"\n",
            "packings.csv.gz": tables.compressed(tables.packings_text(dict(self.packings))),
            "packings.json": _json(dict(self.about_packings)),
            "runs.json": tables.runs_text(manifests).encode(),
            "endpoints.csv": tables.endpoints_text(self.ensemble.endpoints).encode(),
            "profiles.csv.gz": tables.compressed(tables.profiles_text(self.ensemble.profiles)),
            "fields.csv.gz": tables.compressed(tables.fields_text(self.ensemble.fields)),
        }


_READERS: dict[str, Callable[[bytes], Any]] = {
    "manifest.json": json.loads,
    "case.json": lambda content: Case.from_canonical(content.rstrip(b"\n")),
    "packings.csv.gz": lambda content: tables.packings_of(tables.expanded(content)),
    "packings.json": json.loads,
    "runs.json": lambda content: tables.runs_of(content.decode()),
    "endpoints.csv": lambda content: tables.endpoints_of(content.decode()),
    "profiles.csv.gz": lambda content: tables.profiles_of(tables.expanded(content)),
    "fields.csv.gz": lambda content: tables.fields_of(tables.expanded(content)),
}


def find_record(case: Case, folder: Path) -> Record:
    """The record of `case` among those that `folder` holds by case and variant. Raises RecordError."""
    variants = sorted(path.parent for path in (folder / case.name).glob(f"[!.]*/{SUMS}"))
    for variant in variants:
        if _run_hash(variant) == case.run_hash:
            return Record.read(variant)
    for variant in variants:
        _verified(variant)  # that of this case may be one whose case.json was changed
    there = ", ".join(variant.name for variant in variants)
    say = f"there are records of {there}" if there else f"there is no record of {case.name}"
    raise RecordError(
        [
            f"no recorded ensemble of this case in {folder}: {say}, and runs depend on every value but title and "
            "checks. Use a recorded case or variant (--set), or record this one with `crossdem record`"
        ]
    )


def _partial(folder: Path) -> Path:
    """Of a record on its way to `folder`."""
    return folder.with_name(f".{folder.name}.partial")


def _run_hash(variant: Path) -> str | None:
    """Of the case in a record's folder; None where there is none."""
    try:
        return _READERS["case.json"]((variant / "case.json").read_bytes()).run_hash
    except (OSError, ValueError, AttributeError):
        return None


def _verified(folder: Path) -> dict[str, bytes]:
    """The files of `folder` that SUMS lists, each as it lists it, and no other."""
    try:
        lines = (folder / SUMS).read_text(encoding="utf-8").splitlines()
        listed = dict(reversed(line.split("  ", 1)) for line in lines)
        there = {path.name: path.read_bytes() for path in folder.iterdir() if path.name != SUMS}
    except (OSError, ValueError) as error:
        raise RecordError([f"{folder}: holds no recorded ensemble: {error}"]) from error
    faults = [f"{name} is missing" for name in sorted(listed.keys() - there.keys())]
    faults += [f"{name} was added" for name in sorted(there.keys() - listed.keys())]
    faults += [
        f"{name} was changed"
        for name in sorted(there.keys() & listed.keys())
        if _sha256(there[name]) != listed[name]
    ]
    if faults:
        raise RecordError(
            [
                f"{folder}: not as it was recorded: {'; '.join(faults)}. `crossdem record` makes it anew"
            ]
        )
    return there


def _sha256(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()


def _json(value: dict) -> bytes:
    return (json.dumps(value, indent=2, ensure_ascii=False) + "\n").encode()
