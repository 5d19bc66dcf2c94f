"""`crossdem dataset`: what its commands do, and what they end with."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import click
from rich.console import Console

from crossdem import ExitCode
from crossdem.adapters.case import Case
from crossdem.adapters.dataset import Dataset
from crossdem.adapters.engines import get_engine
from crossdem.adapters.external import External
from crossdem.adapters.gates import REFERENCE
from crossdem.adapters.workspace import Workspace, WorkspaceError

from .comparison import compare_runs
from .dataset_archive import archive_of, write_archive
from .dataset_documents import command_of
from .dataset_package import Origin, place_of, refuse_taken, write_package
from .dataset_sums import SUMS, sha256_of
from .dataset_verify import faults_of_package
from .horizon_runs import horizon_of_runs
from .record_command import refuse_failures
from .runs import here, run_engines
from .wording import plural


def refuse_places(output: Path, archive: bool) -> None:
    """Raises WorkspaceError where the package, or its archive, cannot appear, before there are runs."""
    refuse_taken(output)
    if archive and archive_of(output).exists():
        raise WorkspaceError(f"{archive_of(output)}: there already; choose another --output")


def build(
    case: Case,
    overrides: Sequence[str],
    engines: Sequence[str],
    seeds: int,
    native_seeds: int,
    twins: int,
    output: Path,
    archive: bool,
    authors: Sequence[str],
    workspace: Workspace,
    jobs: int | None,
    profile: str | None,
    ranks: int,
) -> ExitCode:
    """Run what is not there, compare, and write the package. Raises SolverError when a run has no result."""
    folders: dict[Path, None] = {}
    batches = [(list(engines), seeds)]
    if REFERENCE in engines and native_seeds > seeds:
        batches.append(([REFERENCE], native_seeds))
    for names, count in batches:
        runs = run_engines(case, names, count, workspace, jobs, Console(), twins, profile, ranks)
        refuse_failures(runs, f"{output}: not built")
        folders |= dict.fromkeys(runs.folders)
    horizon = horizon_of_runs(case, engines, {}, workspace, here(jobs, profile), Console())
    comparison = compare_runs(case, map(Dataset.read, folders), horizon=horizon)
    own = tuple(one for one in map(get_engine, engines) if isinstance(one, External))
    ours = [name for name in engines if name not in {one.name for one in own}]
    words = ["--engines", ",".join(ours) or "none"]
    words += [word for one in own for word in ("--engine", place_of(one))]
    words += ["--seeds", seeds, "--native-seeds", native_seeds, "--twins", twins]
    words += ["--mpi-ranks", ranks] if ranks > 1 else []
    words += [word for name in authors for word in ("--author", name)]
    command = command_of(["dataset", "build", "case.json", *words, "--output", output.name])
    origin = Origin(command, tuple(overrides), own, tuple(authors))
    identity = write_package(case, list(folders), comparison, origin, output)
    click.echo(f"{output}: {plural(len(folders), 'run')}, verdict {comparison.verdict.word}")
    click.echo(f"identity (SHA-256 of {SUMS}): {identity}")
    if archive:
        click.echo(write_archive(output))
    return ExitCode.AGREES


def verify(folder: Path, identity: str | None) -> ExitCode:
    faults = faults_of_package(folder, identity)
    for fault in faults:
        click.echo(fault)
    if (folder / SUMS).is_file():
        click.echo(f"identity (SHA-256 of {SUMS}): {sha256_of(folder / SUMS)}")
    click.echo(f"{folder}: {plural(len(faults), 'fault') if faults else 'as it was built'}")
    return ExitCode.DIFFERS if faults else ExitCode.AGREES
