"""`crossdem doctor`: which engines are here and what runs them, and what to install."""

import os
import platform

import click

from crossdem import ExitCode, __version__
from crossdem.adapters.engine import EngineNotFound
from crossdem.adapters.engines import ENGINES, get_engine
from crossdem.adapters.mpi import check as check_mpi
from crossdem.adapters.workflow import snakemake

WIDTH = max(map(len, ENGINES))


def doctor() -> ExitCode:
    """Says of every engine and of Snakemake its version, or what to install, and whether MPI ranks can be had."""
    click.echo(f"{'crossdem':{WIDTH}} {__version__}")
    click.echo(f"{'python':{WIDTH}} {platform.python_version()}")
    versions = {name: get_engine(name).version for name in ENGINES}
    missing = [name for name, version in versions.items() if not _told(name, version)]
    workflow = _told("snakemake", snakemake.version)
    _told("mpi ranks", _mpi)  # optional
    if not workflow:
        click.echo("Nothing runs without Snakemake; scripts/quickstart installs it.")
    if missing:
        click.echo("The other engines run without; scripts/quickstart installs what it can.")
    if missing or not workflow:
        return ExitCode.ENGINE_FAILED
    click.echo("Every engine is here.")
    return ExitCode.AGREES


def _told(name: str, version) -> bool:
    try:
        click.echo(f"{name:{WIDTH}} {version()}")
    except (EngineNotFound, snakemake.WorkflowError) as error:
        click.echo(f"{name:{WIDTH}} missing: {error}")
        return False
    return True


def _mpi() -> str:
    check_mpi(os.environ.get("PATH"))
    return "by mpirun"
