"""`crossdem init-ci`: a workflow of GitHub Actions and a CTest snippet that ask crossdem at every push."""

from __future__ import annotations

import re
import subprocess
from contextlib import suppress
from pathlib import Path

import click
import jinja2

from crossdem import ExitCode, __version__
from crossdem.adapters.case import load_case
from crossdem.adapters.engines import attach, unknown_engines
from crossdem.adapters.files import write_whole

from .comparison import case_faults
from .pages import TEMPLATES
from .recorded import RECORDS

WORKFLOW, SNIPPET = ".github/workflows/crossdem.yml", "cmake/crossdem.cmake"
REFERENCE_CASE = "reference_cases/bar_penetration.toml"
CLONED = "crossdem"  # folder into which a workflow clones
# What goes into the files as text must mean nothing to YAML, a shell, CMake or the workflow's own expressions.
PLAIN = re.compile(r"[\w./@:+~ -]*[\w./]")


def init_ci(
    case: str | None, engine: str | None, source: str | None, tier: str, folder: Path, force: bool
) -> ExitCode:
    """Write both files below `folder`, the top of a repository in which `case` and `engine` are, if they are given.

    Raises UsageError where that would replace one, a text is not PLAIN, or a path leads out of the repository; CaseError,
    EngineFileError and SolverError as a run would.
    """
    address, version, crossdem = _whence(source)
    values = {
        "case": case,
        "reference_case": REFERENCE_CASE,
        "engine": engine,
        "tier": tier,
        "crossdem": crossdem,
        "pattern": "" if crossdem == "." else f"{crossdem}/",
        "git_address": address,
        "git_version": version,
    }
    for name, value in values.items():
        if value and not PLAIN.fullmatch(value):
            raise click.UsageError(
                f"{name.replace('_', ' ')}: {value!r} cannot stand in a workflow; keep to letters, digits, blanks and ./@:+~-_"
            )
    _check_paths(
        folder, {"CASE": case, "--engine": engine, "--source": None if address else source}
    )
    if engine:
        attach(str(folder / engine))
    if case and not (address and Path(case).is_relative_to(crossdem)):  # which a workflow clones
        _check_case(folder / case, may_be_folder=not engine)
    texts = {
        folder / WORKFLOW: _filled("workflow.yml", values),
        folder / SNIPPET: _filled("crossdem.cmake", values),
    }
    others = [
        path
        for path, text in texts.items()
        if path.exists() and not (path.is_file() and path.read_bytes() == text.encode())
    ]
    if others and not force:
        raise click.UsageError(
            f"{', '.join(map(str, others))}: there already, and not as this would write it; --force replaces it"
        )
    for path, text in texts.items():
        path.parent.mkdir(parents=True, exist_ok=True)
        write_whole(path, text.encode())
        click.echo(f"wrote {path}")
    if not (folder / ".git").exists():
        click.echo(
            f"warning: {folder} is not the top of a git repository, and GitHub reads a workflow only there: choose it with --out"
        )
    if address and not (source or "").partition("#")[2]:
        click.echo(
            f"assumed: the tag {version} of {address}. It must exist there; --source ADDRESS#TAG names another."
        )
    click.echo(_next_steps(engine))
    return ExitCode.AGREES


def _check_paths(folder: Path, paths: dict[str, str | None]) -> None:
    """Raises UsageError for the first of `paths`, by what it was given as, that is not one below `folder`."""
    for name, path in paths.items():
        if path and (
            Path(path).is_absolute()
            or not (folder / path).resolve().is_relative_to(folder.resolve())
        ):
            raise click.UsageError(
                f"{name}: {path} is not in the repository: give a path from its top folder, which is that of --out"
            )


def _check_case(place: Path, may_be_folder: bool) -> None:
    """Raises CaseError or UsageError unless `place` is a case or a folder of them, SolverError where there is no solver."""
    paths = sorted(place.glob("*.toml")) if may_be_folder and place.is_dir() else [place]
    if not paths:
        raise click.UsageError(f"CASE: {place} holds no case: give FILE.toml, or a folder of them")
    for path in paths:
        load_case(path, (), lambda raw: case_faults(raw) + unknown_engines(raw))


def _whence(source: str | None) -> tuple[str | None, str | None, str]:
    """Address and version to clone, if it is to be cloned; and the folder of crossdem in the workflow."""
    if source and "://" not in source and not source.startswith("git@"):
        return None, None, source.rstrip("/") or "."
    address, _, version = (source or _own_address()).partition("#")
    return address, version or f"v{__version__}", CLONED


def _own_address() -> str:
    """Where this checkout was cloned from. Raises UsageError where that is not known."""
    checkout = RECORDS.parent.parent
    asked = ["git", "-C", checkout, "config", "--get", "remote.origin.url"]
    told = ""
    if (checkout / ".git").exists():  # else git may tell of a repository around an installation
        with suppress(OSError):
            told = subprocess.run(asked, capture_output=True, text=True).stdout.strip()
    if "://" not in told and not told.startswith("git@"):
        raise click.UsageError(
            "it is not known where a workflow gets crossdem from: give --source ADDRESS#TAG of its repository, or the folder "
            "in which your repository has it"
        )
    return told


def _filled(name: str, values: dict) -> str:
    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader(TEMPLATES),
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
    )
    return environment.get_template(name).render(values)


def _next_steps(engine: str | None) -> str:
    steps = [
        f"Put include({SNIPPET}) behind enable_testing() in CMakeLists.txt for `ctest -L crossdem`.",
        "Commit both; the next push runs them.",
    ]
    if engine:
        steps.insert(0, f'Say in {WORKFLOW}, at "Your code", how it is built.')
    return "\n".join(steps)
