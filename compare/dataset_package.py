"""A package: all runs of a case by all engines, with what it takes to read, verify and cite them. docs/datasets.md."""

from __future__ import annotations

import json
import shutil
import subprocess
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pandas as pd

from crossdem import __version__
from crossdem.adapters.case import Case
from crossdem.adapters.external import External
from crossdem.adapters.solver import solver_sha256
from crossdem.adapters.workspace import WorkspaceError

from . import dataset_documents as documents
from . import recorded_tables
from .comparison import Comparison
from .dataset_columns import ABOUT_COLUMNS, RUN_COLUMNS, manifest_keys, motion_columns, tables
from .dataset_crate import METADATA, crate, ended
from .dataset_sums import SUMS, files_in, sha256_of, write_sums
from .dataset_descriptor import DESCRIPTOR, data_package
from .ensemble import Ensemble
from .finished_runs import read_runs
from .provenance import provenance
from .record import libraries, record_text
from .recorded import CONTENT
from .wording import packings, plural


@dataclass(frozen=True)
class Origin:
    """What a package says of how it came about, beside its runs."""

    command: str  # makes it again, in its folder
    overrides: tuple[str, ...] = ()  # key.path=value, of what the file of its case said
    engines: tuple[External, ...] = ()  # users' own
    authors: tuple[str, ...] = ()


def place_of(engine: External) -> str:
    """Of the description of a user's engine in a package, as --engine takes it."""
    return f"engines/{engine.name}/{Path(engine.description).name}"


def refuse_taken(folder: Path) -> None:
    """Raises WorkspaceError where a package cannot appear as `folder`."""
    if folder.is_dir() and not any(folder.iterdir()):
        return
    if folder.exists() or folder.is_symlink():
        raise WorkspaceError(
            f"{folder}: there is something already; choose another place with --output"
        )


def write_package(
    case: Case,
    runs: Sequence[Path],
    comparison: Comparison,
    origin: Origin,
    folder: Path,
) -> str:
    """Into the new `folder`, whole or not at all; returns its identity."""
    refuse_taken(folder)
    folder = folder.absolute()
    folder.parent.mkdir(parents=True, exist_ok=True)
    partial = folder.with_name(f".{folder.name}.partial")
    shutil.rmtree(partial, ignore_errors=True)
    try:
        partial.mkdir()
        identity = _fill(partial, case, runs, comparison, origin)
        partial.rename(folder)
    finally:
        shutil.rmtree(partial, ignore_errors=True)
    return identity


def _fill(
    folder: Path, case: Case, runs: Sequence[Path], comparison: Comparison, origin: Origin
) -> str:
    ensemble, packings = read_runs(runs)
    for run in runs:
        shutil.copytree(run, folder / "runs" / run.name)
    for seed, packing in packings.items():
        place = folder / "packings" / f"seed{seed}"
        place.mkdir(parents=True)
        for name in ("packing.csv", "packing.json"):
            shutil.copyfile(packing.folder / name, place / name)
    for engine in origin.engines:
        engine.copy_to((folder / place_of(engine)).parent)
    manifests = _by_folder(ensemble, runs)
    about = _about(case, comparison, list(manifests.values()), origin)
    columns = tables(list(ensemble.profiles.columns))
    others = {
        "runs/*/motion.h5": motion_columns(runs[0] / "motion.h5"),
        "runs/*/manifest.json": manifest_keys(),
    }

    (folder / "case.json").write_bytes(case.canonical)
    _write(folder / "tables" / "runs.csv", _runs_table(manifests).to_csv(index=False))
    _write(folder / "tables" / "endpoints.csv", recorded_tables.endpoints_text(ensemble.endpoints))
    profiles = recorded_tables.profiles_text(ensemble.profiles)
    _write(folder / "tables" / "resistance_per_cm.csv", profiles)
    _write(folder / "comparison" / "report.json", record_text(comparison))
    _write(folder / "columns.csv", documents.dictionary(columns | others))
    _write(folder / "README.md", documents.readme(about))
    _write(folder / "LICENSE", documents.license_text())
    _write(folder / "CITATION.cff", documents.citation(about))
    programs = [vars(one) for one in provenance(manifests.values()).programs]
    to_come = ["provenance.json", METADATA, DESCRIPTOR, SUMS]
    names = sorted([*files_in(folder), *to_come])
    origins = documents.provenance(about, programs, libraries(), names)
    _write(folder / "provenance.json", documents.json_text(origins))
    sizes = {name: None if name in to_come[1:] else _size(folder / name) for name in names}
    _write(folder / METADATA, documents.json_text(crate(about, sizes, manifests)))
    facts = {name: (_size(folder / name), sha256_of(folder / name)) for name in files_in(folder)}
    descriptor = data_package(about, facts, columns)
    _write(folder / DESCRIPTOR, documents.json_text(descriptor))
    return write_sums(folder)


def _by_folder(ensemble: Ensemble, runs: Sequence[Path]) -> dict[str, dict]:
    """By its folder in the package, the manifest of each run, in the order of the ensemble."""
    names = {json.loads((run / "manifest.json").read_bytes())["run_key"]: run.name for run in runs}
    return {f"runs/{names[about['run_key']]}": about for about in ensemble.manifests.values()}


def _runs_table(manifests: Mapping[str, dict]) -> pd.DataFrame:
    """A row per run; its columns are those of tables/runs.csv in dataset_columns."""
    own = {"packing_sha256": "packing_hash", "content_sha256": CONTENT}
    rows = [about | {"folder": folder} for folder, about in manifests.items()]
    names = [*RUN_COLUMNS, *ABOUT_COLUMNS]
    return pd.DataFrame(
        [[row[own.get(name, name)] for name in names] for row in rows], columns=names
    )


def _write(path: Path, text: str) -> None:
    path.parent.mkdir(exist_ok=True)
    path.write_text(text, encoding="utf-8")


def _size(path: Path) -> int:
    return path.stat().st_size


def _about(
    case: Case, comparison: Comparison, manifests: Sequence[dict], origin: Origin
) -> dict[str, Any]:
    """What the texts say of a package; its date is that of its last run."""
    engines = ", ".join(dict.fromkeys(about["engine"] for about in manifests))
    seeds = len({about["seed"] for about in manifests})
    changed = f", changed: {', '.join(origin.overrides)}" if origin.overrides else ""
    return {
        "name": f"crossdem-{case.name}",
        "title": f"{case.resolved['title']}{changed}: reference runs of {engines}",
        "description": f"{plural(len(manifests), 'run')} of the case {case.name}{changed}, by {engines}, on {packings(seeds)} "
        "of the same particles: motion of every particle, forces on the bar, and the comparison of the codes.",
        "authors": origin.authors,
        "version": __version__,
        "date": max(map(ended, manifests)).date().isoformat(),
        "engines": engines,
        "verdict": comparison.verdict.word,
        "command": origin.command,
        "commit": _commit(),
        "solver": solver_sha256(),
    }


def _commit() -> str | None:
    """Of the checkout that this crossdem is of, marked where it was changed; None for an installation."""
    checkout = Path(__file__).resolve().parents[1]
    if not (checkout / ".git").exists():
        return None
    asked = ["git", "-C", checkout, "describe", "--always", "--dirty", "--abbrev=40"]
    try:
        return subprocess.run(asked, capture_output=True, text=True).stdout.strip() or None
    except OSError:
        return None
