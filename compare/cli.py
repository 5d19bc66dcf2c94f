"""The command line `crossdem`: its options and exit codes. What the commands do is in commands.py."""

import signal
import sys
import traceback
from pathlib import Path

import click
from click.core import ParameterSource

from crossdem import ExitCode, __version__
from crossdem.adapters.case import CaseError
from crossdem.adapters.dataset import DatasetError
from crossdem.adapters.engines import DEFAULT_ENGINES, ENGINES
from crossdem.adapters.gates import REFERENCE
from crossdem.adapters.solver import SolverError
from crossdem.adapters.workflow.snakemake import WorkflowError, profile_folder
from crossdem.adapters.workspace import WorkspaceError

from . import commands
from .ingredients import TARGETS
from .runs import TIERS, WITHOUT_TIER, cores
from .doctor import doctor as examine


def _engine_names(context, parameter, text: str) -> list[str]:
    if context.params.get("replay"):
        if text.strip() == "none":
            return []
        if context.get_parameter_source(parameter.name) is ParameterSource.DEFAULT:
            return [REFERENCE]
    names = list(dict.fromkeys(name.strip() for name in text.split(",")))
    for name in names:
        if name not in ENGINES:
            raise click.BadParameter(f"no engine {name!r}; there are {', '.join(ENGINES)}")
    return names


def _time_steps(context, parameter, text: str) -> list[float]:
    try:
        steps = sorted({float(step) for step in text.split(",") if step.strip()})
    except ValueError as error:
        raise click.BadParameter(f"{text!r} is not a list of numbers such as 5e-5,1e-4") from error
    if not all(0 < step < float("inf") for step in steps):
        raise click.BadParameter("a time step is a number above 0")
    return steps


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
    default=",".join(DEFAULT_ENGINES),
    show_default=True,
    callback=_engine_names,
    help="Which engines to run, separated by commas.",
)


def _seeds_of(default: int, help_text: str):
    return click.option(
        "--seeds",
        type=click.IntRange(1, 1000),
        default=default,
        show_default=True,
        help=help_text,
    )


def _of_tier(which: int):
    """Packings (0) or twins (1), as they were asked for, else as the tier has them."""

    def chosen(context, parameter, value: int | None) -> int:
        return (
            value if value is not None else TIERS.get(context.meta.get(_TIER), WITHOUT_TIER)[which]
        )

    return chosen


def _profile_name(context, parameter, name: str | None) -> str | None:
    if name:
        try:
            profile_folder(name)
        except WorkflowError as error:
            raise click.BadParameter(str(error)) from error
    return name


def _jobs_of(context, parameter, jobs: int | None) -> int | None:
    return jobs or (None if context.params.get("profile") else cores())


_seeds = _seeds_of(2, "How many packings; every engine runs each of them.")
_TIER = "crossdem.tier"
_tier = click.option(
    "--tier",
    type=click.Choice(list(TIERS)),
    is_eager=True,
    expose_value=False,
    callback=lambda context, parameter, tier: context.meta.update({_TIER: tier}),
    help="How large the ensemble is: "
    + ", ".join(
        f"{name} {seeds} packings with {twins} twins" for name, (seeds, twins) in TIERS.items()
    )
    + ". --seeds and --twins come first.",
)
_ensemble = [
    _tier,
    click.option(
        "--seeds",
        type=click.IntRange(1, 1000),
        callback=_of_tier(0),
        help="How many packings; every engine runs each of them. [default: 2]",
    ),
    click.option(
        "--twins",
        type=click.IntRange(0, 100),
        callback=_of_tier(1),
        help="How many twins of each packing beside itself, one particle moved by 1e-12 m. [default: 0]",
    ),
]
_profile = click.option(
    "--profile",
    metavar="NAME",
    is_eager=True,
    callback=_profile_name,
    help="Run on a cluster: slurm, or the folder of a Snakemake profile. [default: on the cores of this machine]",
)
_ranks = click.option(
    "--mpi-ranks",
    "ranks",
    type=click.IntRange(1, 1024),
    default=1,
    show_default=True,
    help="MPI processes per run of LIGGGHTS; the other engines take one.",
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
    callback=_jobs_of,
    help="How many processes at a time, or tasks handed in with --profile. [default: one per core, or the profile's]",
)


_replay = click.option(
    "--replay",
    is_flag=True,
    is_eager=True,
    help="Run only --engines (by default native; none: not one) here, on recorded packings, and take the runs of all "
    "others from the record.",
)
_record = click.option(
    "--record",
    "-o",
    type=click.Path(path_type=Path),
    default=Path("reference_cases/expected"),
    show_default=True,
    help="The folder of recorded ensembles.",
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
@_with(_case, _replay, _engines, *_ensemble, _out, _overrides, _jobs, _profile, _ranks, _record)
def check(**options):
    """Run CASE in every engine, compare, and end with a verdict and a report.

    On the packing of seed 1 each engine is also compared particle by particle with the native scheme of its name, up to
    the horizon: one that differs there differs, with exit code 1, whatever the statistics say.

    A folder of cases is a ladder: each engine against its native twin and against closed forms, at three time steps.
    Its particles are given, so that it needs no seeds.
    """
    return commands.check(**options)


@cli.command()
@_with(_case, _engines, *_ensemble, _out, _overrides, _jobs, _profile, _ranks)
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
@_case
@click.option(
    "--from",
    "origin",
    type=click.Choice(["paper"]),
    default="paper",
    show_default=True,
    help="Where the walk starts: the scheme of the paper.",
)
@click.option(
    "--to",
    "target",
    type=click.Choice(TARGETS),
    required=True,
    help="Whose scheme it leads to; the last step is that code itself.",
)
@_seeds_of(16, "How many packings; every step of the walk runs all of them.")
@click.option(
    "--engine-seeds",
    type=click.IntRange(1, 1000),
    help="On how many of them the other code itself runs. [default: all]",
)
@_with(_out, _overrides, _jobs, _profile)
def explain(**options):
    """Walk from the paper's scheme to another code, and say what each ingredient changes.

    Ends with 3 when a run of the paper's scheme, of the native scheme or of the code itself failed, 4 without a total.
    """
    return commands.explain(**options)


@cli.command()
@_with(_case, _engines)
@click.option(
    "--seed", type=click.IntRange(1, 1000), default=1, show_default=True, help="Of the packing."
)
@_with(_out, _overrides, _jobs)
def horizon(**options):
    """Say up to when CASE can be compared particle by particle: how fast twin runs of each engine part.

    Ends with 0 when every engine does until then what the native scheme of its name does (or the native solver was all
    that was asked for), 1 when one does not, 3 when a run has no result, 4 when an engine could not be compared.
    """
    return commands.horizon(**options)


@cli.command()
@_with(_case, _seeds_of(1, "How many packings."))
@click.option(
    "--time-steps",
    "steps_s",
    default="",
    callback=_time_steps,
    help="Time steps in s, separated by commas. [default: about the bounds]",
)
@_with(_out, _overrides, _jobs)
def stability(**options):
    """Say at which time steps the bed of CASE rests, under each native scheme."""
    return commands.stability(**options)


@cli.command()
@_with(_case, _engines, *_ensemble)
@click.option(
    "--twin-seeds",
    type=click.IntRange(1, 1000),
    help="On how many of the packings the engines run the twins. [default: all]",
)
@click.option(
    "--native-twins",
    type=click.IntRange(0, 100),
    help="Twins of the native solver, where it is to have more of them than the others: calibrate deals with them. "
    "[default: as --twins]",
)
@click.option(
    "--variant",
    "variants",
    metavar="KEY=VALUE[,...]",
    multiple=True,
    help="Record the case with these values changed, too. May be repeated.",
)
@click.option(
    "--variant-engines",
    default=REFERENCE,
    show_default=True,
    callback=_engine_names,
    help="Which engines run the variants.",
)
@click.option(
    "--variant-seeds",
    type=click.IntRange(1, 1000),
    help="How many packings of each variant. [default: as --seeds]",
)
@_with(_record, _out, _jobs, _profile)
def record(**options):
    """Run CASE, and keep of the runs what a comparison reads: few enough numbers to stand beside the case.

    `check --replay` compares with them, `calibrate` judges the judge on them. What is recorded of each variant goes to
    a folder of its own, NAME of the case/VARIANT; what was recorded there before is replaced.
    """
    return commands.record(**options)


@cli.command()
@click.argument(
    "case_file",
    metavar="[CASE]",
    type=click.Path(path_type=Path),
    default=Path("reference_cases/bar_penetration.toml"),
)
@click.option(
    "--splits",
    type=click.IntRange(20, 100_000),
    default=200,
    show_default=True,
    help="Random splits of the recorded native runs, for each size of a comparison.",
)
@_with(_record, _out, _overrides, _jobs)
def calibrate(**options):
    """Judge the judge: how often it errs about recorded native runs, of which the truth is known.

    Ends with 0 when its error rates are as low as they are to be, 1 when not, 4 when there are too few recorded runs.
    """
    return commands.calibrate(**options)


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
    except (SolverError, WorkflowError) as error:
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
