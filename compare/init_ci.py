"""`crossdem init-ci`: a workflow of GitHub Actions and a CTest snippet that ask crossdem at every push."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import click
import jinja2

from crossdem import ExitCode, __version__
from crossdem.adapters.files import write_whole

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
    """Write both files below `folder`. Raises UsageError where that would replace one, or a text is not PLAIN."""
    address, version, crossdem = _whence(source)
    case = case or str(Path(crossdem) / REFERENCE_CASE)
    values = {
        "case": case,
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
    texts = {
        folder / WORKFLOW: _filled("workflow.yml", values),
        folder / SNIPPET: _filled("crossdem.cmake", values),
    }
    others = [path for path, text in texts.items() if path.exists() and path.read_text() != text]
    if others and not force:
        raise click.UsageError(
            f"{', '.join(map(str, others))}: there already, and not as this would write it; --force replaces it"
        )
    for path, text in texts.items():
        path.parent.mkdir(parents=True, exist_ok=True)
        write_whole(path, text.encode())
        click.echo(f"wrote {path}")
    click.echo(_next_steps(engine))
    return ExitCode.AGREES


def _whence(source: str | None) -> tuple[str | None, str | None, str]:
    """Address and version to clone, if it is to be cloned; and the folder of crossdem in the workflow."""
    if source and "://" not in source and not source.startswith("git@"):
        return None, None, source.rstrip("/") or "."
    address, _, version = (source or _own_address()).partition("#")
    return address, version or f"v{__version__}", CLONED


def _own_address() -> str:
    """Where this checkout was cloned from. Raises UsageError where that is not known."""
    asked = ["git", "-C", RECORDS.parent, "config", "--get", "remote.origin.url"]
    try:
        told = subprocess.run(asked, capture_output=True, text=True).stdout.strip()
    except OSError:
        told = ""
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
