"""Options and arguments that several commands take."""

from collections.abc import Collection, Sequence
from pathlib import Path

import click
from click.core import ParameterSource

from crossdem.adapters.engines import DEFAULT_ENGINES, ENGINES, attach
from crossdem.adapters.gates import REFERENCE
from crossdem.adapters.workflow.snakemake import WorkflowError, profile_folder

from .recorded import RECORDS
from .runs import TIERS, WITHOUT_TIER, cores


def names_among(text: str, known: Collection[str], what: str) -> list[str]:
    """Names separated by commas, each once. Raises BadParameter for one that is not `known`."""
    names = list(dict.fromkeys(name.strip() for name in text.split(",")))
    for name in names:
        if name not in known:
            raise click.BadParameter(f"no {what} {name!r}; there are {', '.join(known)}")
    return names


def engine_names(context, parameter, text: str) -> list[str]:
    own = context.meta.get(_OWN, [])
    if context.params.get("replay") or context.params.get("against"):
        if text.strip() == "none":
            return own
        if context.get_parameter_source(parameter.name) is ParameterSource.DEFAULT:
            return own or [REFERENCE]
    return list(dict.fromkeys([*names_among(text, ENGINES, "engine"), *own]))


def time_steps(context, parameter, text: str) -> list[float]:
    try:
        steps = sorted({float(step) for step in text.split(",") if step.strip()})
    except ValueError as error:
        raise click.BadParameter(f"{text!r} is not a list of numbers such as 5e-5,1e-4") from error
    if not all(0 < step < float("inf") for step in steps):
        raise click.BadParameter("a time step is a number above 0")
    return steps


case = click.argument("case_file", metavar="CASE", type=click.Path(path_type=Path))
case_or_reference = click.argument(
    "case_file",
    metavar="[CASE]",
    type=click.Path(path_type=Path),
    default=RECORDS.parent / "bar_penetration.toml",
)
overrides = click.option(
    "--set",
    "overrides",
    metavar="KEY=VALUE",
    multiple=True,
    help="Change one value of the case, such as contact.particle_wall.friction=0.5. May be repeated.",
)
engines = click.option(
    "--engines",
    default=",".join(DEFAULT_ENGINES),
    show_default=True,
    callback=engine_names,
    help="Which engines to run, separated by commas.",
)


own_engines = click.option(
    "--engine",
    metavar="FILE",
    multiple=True,
    is_eager=True,
    expose_value=False,
    callback=lambda context, parameter, files: context.meta.update({_OWN: _attach(files)}),
    help="Also run a code of your own: FILE.toml, or FILE.py:CLASS. May be repeated. docs/own_engine.md tells how.",
)
own_engine = click.argument(
    "engine", metavar="FILE", callback=lambda context, parameter, file: _attach([file])[0]
)
_OWN = "crossdem.own_engines"


def _attach(descriptions: Sequence[str]) -> list[str]:
    """The names of users' engines, from now on known. Raises EngineFileError."""
    return [attach(description) for description in descriptions]


def seeds_of(default: int, help_text: str):
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
        if value is not None:
            return value
        return TIERS.get(context.meta.get(_TIER), WITHOUT_TIER)[which]

    return chosen


def _packings(context, parameter, value: int | None) -> int | None:
    """None: all that are recorded, where nothing is run."""
    if value is None and context.params["engines"] == [] and _TIER not in context.meta:
        return None
    return _of_tier(0)(context, parameter, value)


def _record_folder(context, parameter, folder: Path) -> Path:
    given = context.get_parameter_source(parameter.name) is not ParameterSource.DEFAULT
    if given and context.params.get("replay") is False:
        raise click.BadParameter("is read with --replay alone; results go to --out")
    return folder


def _one_of_two(context, parameter, given):
    if given and (context.params.get("against") or context.params.get("replay")):
        raise click.BadParameter(
            "--replay compares with the record, and --against with a package: give one"
        )
    return given


def _profile_name(context, parameter, name: str | None) -> str | None:
    if name:
        try:
            profile_folder(name)
        except WorkflowError as error:
            raise click.BadParameter(str(error)) from error
    return name


def _jobs_of(context, parameter, jobs: int | None) -> int | None:
    return jobs or (None if context.params.get("profile") else cores())


seeds = seeds_of(2, "How many packings; every engine runs each of them.")
_TIER = "crossdem.tier"
_tier = click.option(
    "--tier",
    type=click.Choice(list(TIERS)),
    is_eager=True,
    expose_value=False,
    callback=lambda context, parameter, tier: context.meta.update({_TIER: tier} if tier else {}),
    help="How large the ensemble is: "
    + ", ".join(
        f"{name} {seeds} packings with {twins} twins" for name, (seeds, twins) in TIERS.items()
    )
    + ". --seeds and --twins override its numbers.",
)
ensemble = [
    _tier,
    click.option(
        "--seeds",
        type=click.IntRange(1, 1000),
        callback=_packings,
        help="How many packings; every engine runs each of them. [default: 2]",
    ),
    click.option(
        "--twins",
        type=click.IntRange(0, 100),
        callback=_of_tier(1),
        help="How many twins of each packing beside itself, one particle moved by 1e-12 m. [default: 0]",
    ),
]
profile = click.option(
    "--profile",
    metavar="NAME",
    is_eager=True,
    callback=_profile_name,
    help="Run on a cluster: slurm, or the folder of a Snakemake profile. [default: on the cores of this machine]",
)
ranks = click.option(
    "--mpi-ranks",
    "ranks",
    type=click.IntRange(1, 1024),
    default=1,
    show_default=True,
    help="MPI processes per run of LIGGGHTS; the other engines take one.",
)


def out_at(default: str):
    return click.option(
        "--out", type=click.Path(path_type=Path), help=f"Output folder. [default: {default}]"
    )


out = out_at("results/NAME of the case, results/NAME-HASH with --set")


def _jobs(help_text: str):
    return click.option("--jobs", type=click.IntRange(1), callback=_jobs_of, help=help_text)


jobs = _jobs("How many processes at a time. [default: one per core]")
jobs_or_tasks = _jobs(
    "How many processes at a time, or tasks handed in with --profile. [default: one per core, or the profile's]"
)
replay = click.option(
    "--replay",
    is_flag=True,
    is_eager=True,
    callback=_one_of_two,
    help="Run only --engine and --engines (by default native; none: not one) here, on recorded packings, and take the runs of all "
    "others from the record; with none, of all its packings unless --seeds or --tier say otherwise.",
)
against = click.option(
    "--against",
    metavar="DIR",
    type=click.Path(path_type=Path),
    is_eager=True,
    callback=_one_of_two,
    help="As --replay, with the runs of the package in DIR, which `crossdem dataset build` made: it is verified first.",
)
record = click.option(
    "--record",
    type=click.Path(path_type=Path),
    default=RECORDS,
    callback=_record_folder,
    help="The folder of recorded ensembles. [default: reference_cases/expected beside the program]",
)

running = [
    own_engines,
    engines,
    *ensemble,
    out,
    overrides,
    jobs_or_tasks,
    profile,
    ranks,
]  # of an ensemble


def taking(*options):
    """Adds these arguments and options to a command, in this order."""

    def add(function):
        for option in reversed(options):
            function = option(function)
        return function

    return add
