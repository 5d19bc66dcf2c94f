"""The command line `crossdem`: its options and exit codes. What the commands do is in commands.py."""

import os
import signal
import sys
import traceback
from pathlib import Path

import click

from crossdem import ExitCode, __version__
from crossdem.adapters.case import CaseError
from crossdem.adapters.dataset import DatasetError
from crossdem.adapters.engines import ENGINES
from crossdem.adapters.solver import SolverError
from crossdem.adapters.workspace import WorkspaceError

from . import commands
from .doctor import doctor as examine


def _engine_names(context, parameter, text: str) -> list[str]:
    names = list(dict.fromkeys(name.strip() for name in text.split(",")))
    for name in names:
        if name not in ENGINES:
            raise click.BadParameter(f"no engine {name!r}; there are {', '.join(ENGINES)}")
    return names


_case = click.argument("case_file", metavar="CASE", type=click.Path(path_type=Path))
_overrides = click.option(
    "--set",
    "overrides",
    metavar="KEY=VALUE",
    multiple=True,
    help="Change one value of the case, such as contact.particle_wall.friction=0.5. May be repeated.",
)
_engines = click.option(
    "--engines",
    default=",".join(ENGINES),
    show_default=True,
    callback=_engine_names,
    help="Which engines to run, separated by commas.",
)
_seeds = click.option(
    "--seeds",
    type=click.IntRange(1, 1000),
    default=2,
    show_default=True,
    help="How many packings; every engine runs each of them.",
)
_out = click.option(
    "--out",
    type=click.Path(path_type=Path),
    help="Output folder. [default: results/NAME of the case, results/NAME-HASH with --set, "
    "results/NAME-compare for compare]",
)
_jobs = click.option(
    "--jobs",
    type=click.IntRange(1),
    default=len(os.sched_getaffinity(0)),
    help="How many processes at a time. [default: one per core]",
)


def _with(*options):
    """Adds these arguments and options to a command, in this order."""

    def add(function):
        for option in reversed(options):
            function = option(function)
        return function

    return add


@click.group(context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100})
@click.version_option(__version__, prog_name="crossdem")
def cli():
    """Runs one granular case through several discrete element codes and compares what they say."""


@cli.command()
@_with(_case, _engines, _seeds, _out, _overrides, _jobs)
def check(**options):
    """Run CASE in every engine, compare, and end with a verdict and a report."""
    return commands.check(**options)


@cli.command()
@_with(_case, _engines, _seeds, _out, _overrides, _jobs)
def run(**options):
    """Run CASE in every engine, without comparing."""
    return commands.run(**options)


@cli.command()
@_with(_case, _engines, _seeds, _out, _overrides, _jobs)
def generate(**options):
    """Only write the engines' input for CASE, to run it elsewhere."""
    return commands.generate(**options)


@cli.command()
@_with(_case, _overrides)
def resolve(**options):
    """Validate CASE and print all of it, defaults included, as JSON."""
    return commands.resolve(**options)


@cli.command()
@click.argument(
    "folders", metavar="DATASET...", nargs=-1, required=True, type=click.Path(path_type=Path)
)
@_out
def compare(**options):
    """Compare runs that exist: folders such as results/bar_penetration/runs/*."""
    return commands.compare(**options)


@cli.command()
def doctor():
    """Say which engines are here, and what to install."""
    return examine()


def main(arguments: list[str] | None = None) -> int:
    """Runs a command; returns its exit code. No exception leaves it."""
    signal.signal(signal.SIGTERM, signal.default_int_handler)  # end the engines then, too
    try:
        return cli.main(arguments, prog_name="crossdem", standalone_mode=False) or ExitCode.AGREES
    except click.Abort:
        click.echo("interrupted", err=True)
        return ExitCode.INTERRUPTED
    except click.ClickException as error:
        error.show()
        return ExitCode.BAD_INPUT
    except (CaseError, DatasetError, WorkspaceError) as error:
        click.echo(error, err=True)
        return ExitCode.BAD_INPUT
    except SolverError as error:
        click.echo(error, err=True)
        return ExitCode.ENGINE_FAILED
    except Exception:
        traceback.print_exc()
        click.echo(
            "crossdem: this is a bug in crossdem; please report it with these lines", err=True
        )
        return ExitCode.BUG


if __name__ == "__main__":
    sys.exit(main())
