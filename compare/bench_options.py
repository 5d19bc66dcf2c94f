"""Options of `crossdem bench`."""

from pathlib import Path

import click

from crossdem.adapters.engines import DEFAULT_ENGINES

from .bench_clocks import CLOCKS
from .bench_scaling import LARGEST, SMALLEST
from .bench_workloads import QUICK_WORKLOADS, WORKLOADS
from .options import names_among, taking
from .runs import cores

MOST_THREADS = 1024  # that crossdem-solver takes
PAPER = Path(__file__).resolve().parent.parent / "reference_cases" / "bar_penetration.toml"


def _timed_engines(context, parameter, text: str | None) -> list[str] | None:
    return None if text is None else names_among(text, CLOCKS, "engine that can be timed")


def _workloads(context, parameter, text: str | None) -> list[str] | None:
    return None if text is None else names_among(text, WORKLOADS, "workload")


def _json_file(context, parameter, path: Path | None) -> Path | None:
    if path and (path.is_dir() or not path.absolute().parent.is_dir()):
        raise click.BadParameter(f"{path} is a folder, or lies in one that is not there")
    return path


def _thread_counts(context, parameter, text: str) -> list[int]:
    try:
        counts = sorted({int(count) for count in text.split(",")})
    except ValueError as error:
        raise click.BadParameter(f"{text!r} is not a list of numbers such as 1,2") from error
    if not 1 <= counts[0] <= counts[-1] <= MOST_THREADS:
        raise click.BadParameter(f"a run has from 1 to {MOST_THREADS} threads")
    return counts


def _repeats(context, parameter, count: int | None) -> int:
    return count or (2 if context.params.get("quick") else 5)


quick = click.option(
    "--quick",
    is_flag=True,
    is_eager=True,
    help="A hundredth of the steps, 2 rounds: whether it works, not how fast it is.",
)
repeats = click.option(
    "--repeats",
    type=click.IntRange(1, 1000),
    callback=_repeats,
    help="How many rounds; every engine runs every workload once in each. [default: 5]",
)
json_file = click.option(
    "--json",
    "json_file",
    metavar="FILE",
    type=click.Path(path_type=Path),
    callback=_json_file,
    help="Also write the numbers there.",
)
case_file = click.option(
    "--case",
    "case_file",
    metavar="CASE",
    type=click.Path(path_type=Path),
    default=PAPER,
    help="A case with a bed and a bar, of which the workloads are made. [default: the paper's]",
)
out = click.option(
    "--out",
    type=click.Path(path_type=Path),
    default=Path("results") / "bench",
    show_default=True,
    help="Output folder; beds that lie there are not made again.",
)
engines = click.option(
    "--engines",
    callback=_timed_engines,
    help=f"Which engines to time, separated by commas. [default: {','.join(DEFAULT_ENGINES)}, and lammps where it is installed]",
)
workloads = click.option(
    "--workloads",
    callback=_workloads,
    help=f"On what, separated by commas. [default: {','.join(WORKLOADS)}; with --quick {','.join(QUICK_WORKLOADS)}]",
)

largest = click.option(
    "--largest",
    type=click.IntRange(SMALLEST, 10_000_000),
    default=LARGEST,
    show_default=True,
    help="The largest bed, in particles. Settling 1 million takes some minutes on two cores, once.",
)


def threads(default: str):
    return click.option(
        "--threads",
        metavar="N,...",
        default=default,
        show_default=True,
        callback=_thread_counts,
        help="On how many threads the native solver runs at most; several numbers are timed in turn. Others run on one.",
    )


one_thread = threads("1")
one_and_two_threads = threads("1,2" if cores() > 1 else "1")  # a thread without a core slows down

shared = taking(quick, repeats, json_file, case_file, out)
