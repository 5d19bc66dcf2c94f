"""`crossdem dataset`: what its commands do, and what they end with."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import click
from rich.console import Console

from crossdem import ExitCode
from crossdem.adapters.case import Case
from crossdem.adapters.dataset import Dataset
from crossdem.adapters.engines import attached
from crossdem.adapters.gates import REFERENCE
from crossdem.adapters.workspace import Workspace, WorkspaceError

from .comparison import compare_runs
from .dataset_archive import archive_of, write_archive
from .dataset_documents import command_of
from .dataset_package import Origin, refuse_taken, write_package
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
    case_file: Path,
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
    given = ["--seeds", seeds, "--native-seeds", native_seeds, "--twins", twins]
    given += [word for change in overrides for word in ("--set", change)]
    given += ["--mpi-ranks", ranks] if ranks > 1 else []
    given += [word for name in authors for word in ("--author", name)]
    words = ["dataset", "build", case_file.name, *_named(engines), *given, "--output", output.name]
    command = command_of(words)
    origin = Origin(command, tuple(overrides), tuple(authors))
    identity = write_package(case, list(folders), comparison, origin, output)
    click.echo(f"{output}: {plural(len(folders), 'run')}, verdict {comparison.verdict.word}")
    click.echo(f"identity (SHA-256 of {SUMS}): {identity}")
    if archive:
        click.echo(write_archive(output))
    return ExitCode.AGREES


def _named(engines: Sequence[str]) -> list[str]:
    """The words of a command that name `engines`; a file of a user's engine by its name alone, for any machine."""
    own = {name: description for name in engines for description in attached([name])}
    words = ["--engines", ",".join(name for name in engines if name not in own)]
    return words + [word for file in own.values() for word in ("--engine", Path(file).name)]


def verify(folder: Path, identity: str | None) -> ExitCode:
    faults = faults_of_package(folder, identity)
    for fault in faults:
        click.echo(fault)
    if (folder / SUMS).is_file():
        click.echo(f"identity (SHA-256 of {SUMS}): {sha256_of(folder / SUMS)}")
    click.echo(f"{folder}: {plural(len(faults), 'fault') if faults else 'as it was built'}")
    return ExitCode.DIFFERS if faults else ExitCode.AGREES
