"""`crossdem doctor`: which engines are here, and what to install."""

import platform

import click

from crossdem import ExitCode, __version__
from crossdem.adapters.engine import EngineNotFound
from crossdem.adapters.engines import ENGINES, get_engine


def doctor() -> ExitCode:
    """Says of every engine its version, or what to install."""
    click.echo(f"crossdem   {__version__}")
    click.echo(f"python     {platform.python_version()}")
    missing = []
    for name in ENGINES:
        try:
            click.echo(f"{name:10} {get_engine(name).version()}")
        except EngineNotFound as error:
            click.echo(f"{name:10} missing: {error}")
            missing.append(name)
    if not missing:
        click.echo("Every engine is here.")
        return ExitCode.AGREES
    click.echo("The other engines run without; scripts/quickstart installs what it can.")
    return ExitCode.ENGINE_FAILED
