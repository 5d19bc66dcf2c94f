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
from crossdem.adapters.engine import EngineNotFound
from crossdem.adapters.engine_file import EngineFileError
from crossdem.adapters.gates import REFERENCE
from crossdem.adapters.solver import SolverError
from crossdem.adapters.workflow.snakemake import WorkflowError
from crossdem.adapters.workspace import WorkspaceError

from . import bench_options, commands, options
from .runs import TIERS
from .ingredients import TARGETS
from .doctor import doctor as examine
from .init_ci import init_ci as write_ci


@click.group(context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100})
@click.version_option(__version__, prog_name="crossdem")
def cli():
    """Runs one granular case through several discrete element codes and compares what they say."""


@cli.command()
@options.taking(options.case, options.replay, options.against, *options.running, options.record)
def check(**arguments):
    """Run CASE in every engine, compare, and end with a verdict and a report.

    On the packing of seed 1 each engine is also compared particle by particle with the native scheme of its name, up to
    the horizon: one that differs there differs, with exit code 1, whatever the statistics say.

    A folder of cases is a ladder: each engine against its native twin and against closed forms, at three time steps.
    Its particles are given, so that it needs no seeds.
    """
    return commands.check(**arguments)


@cli.command()
@options.own_engine
@options.taking(options.case_or_reference)
@click.option(
    "--tier",
    type=click.Choice(list(TIERS)),
    default="smoke",
    show_default=True,
    help="How large the ensemble of the bed is.",
)
@click.option(
    "--bed/--no-bed",
    default=None,
    help="Run the bed whatever the ladder says, or leave the verdict to the ladder. [default: run it if the ladder holds]",
)
@options.taking(options.out_at("results/ENGINE"), options.jobs)
def conform(**arguments):
    """Say where a code of your own stands: the ladder, then the bed of CASE beside recorded runs of the other codes.

    FILE is its description, FILE.toml or FILE.py:CLASS; docs/own_engine.md tells how to write one. Ends as check does; a
    ladder that differs ends it before the bed.
    """
    return commands.conform(**arguments)


@cli.command("init-ci")
@click.argument("case", metavar="[CASE]", required=False)
@click.option("--engine", metavar="FILE", help="Your code's description, as `conform` takes it.")
@click.option(
    "--source",
    metavar="ADDRESS#TAG",
    help="Where a workflow clones crossdem from, or the folder in which your repository has it.  [default: this checkout's]",
)
@click.option("--tier", type=click.Choice(list(TIERS)), default="smoke", show_default=True)
@click.option(
    "--out",
    type=click.Path(path_type=Path, file_okay=False),
    default=Path("."),
    show_default=True,
    help="The top folder of your repository.",
)
@click.option("--force", is_flag=True, help="Replace files that are there.")
def init_ci(case, engine, source, tier, out, force):
    """Write a workflow of GitHub Actions and a CTest snippet that check at every push.

    With --engine they say where your code stands, else whether the codes agree on CASE. Paths are those in your
    repository. docs/ci.md says more.
    """
    return write_ci(case, engine, source, tier, out, force)


@cli.command()
@options.taking(options.case, *options.running)
def run(**arguments):
    """Run CASE in every engine, without comparing."""
    return commands.run(**arguments)


@cli.command()
@options.taking(
    options.case,
    options.own_engines,
    options.engines,
    options.seeds,
    options.out,
    options.overrides,
    options.jobs,
)
def generate(**arguments):
    """Only write the engines' input for CASE, to run it elsewhere."""
    return commands.generate(**arguments)


@cli.command()
@options.taking(options.case, options.overrides)
def resolve(**arguments):
    """Validate CASE and print all of it, defaults included, as JSON."""
    return commands.resolve(**arguments)


@cli.command()
@click.argument(
    "folders", metavar="DATASET...", nargs=-1, required=True, type=click.Path(path_type=Path)
)
@options.out_at("results/NAME-compare")
def compare(**arguments):
    """Compare runs that exist: folders such as results/bar_penetration/runs/*."""
    return commands.compare(**arguments)


@cli.command()
@click.argument("folder", metavar="DATASET", type=click.Path(path_type=Path))
@click.option("--vtk", is_flag=True, help="PVD and VTP files, which ParaView opens.")
@click.option("--h5md", is_flag=True, help="One H5MD file in three dimensions.")
@options.out_at("results/RUN-export")
def export(**arguments):
    """Write the motion of a run, such as results/bar_penetration/runs/native-seed1-..., for other programs."""
    return commands.export(**arguments)


@cli.command()
@options.taking(
    options.case_or_reference,
    options.engines,
    options.seeds_of(16, "How many packings; the native solver runs each setting on all of them."),
)
@click.option(
    "--engine-seeds",
    type=click.IntRange(1, 1000),
    default=4,
    show_default=True,
    help="On how many of them the other codes run, where a claim is theirs to test, too.",
)
@options.taking(options.out, options.overrides, options.jobs_or_tasks, options.profile)
def reproduce(**arguments):
    """Test the paper's claims, figure by figure: what it says, what comes out here, and the number that tells.

    Takes 35 to 50 minutes on two cores; interrupted, the same command goes on where it was. Ends with 3 when a run
    failed, whatever became of the claims.
    """
    return commands.reproduce(**arguments)


@cli.command()
@options.case
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
@options.seeds_of(16, "How many packings; every step of the walk runs all of them.")
@click.option(
    "--engine-seeds",
    type=click.IntRange(1, 1000),
    help="On how many of them the other code itself runs. [default: all]",
)
@options.taking(options.out, options.overrides, options.jobs_or_tasks, options.profile)
def explain(**arguments):
    """Walk from the paper's scheme to another code, and say what each ingredient changes.

    Ends with 3 when a run of the paper's scheme, of the native scheme or of the code itself failed, 4 without a total.
    """
    return commands.explain(**arguments)


@cli.command()
@options.taking(options.case, options.own_engines, options.engines)
@click.option(
    "--seed", type=click.IntRange(1, 1000), default=1, show_default=True, help="Of the packing."
)
@options.taking(options.out, options.overrides, options.jobs)
def horizon(**arguments):
    """Say up to when CASE can be compared particle by particle: how fast twin runs of each engine part.

    Ends with 0 when every engine does until then what the native scheme of its name does (or the native solver was all
    that was asked for), 1 when one does not, 3 when a run has no result, 4 when an engine could not be compared.
    """
    return commands.horizon(**arguments)


@cli.command()
@options.taking(options.case, options.seeds_of(1, "How many packings."))
@click.option(
    "--time-steps",
    "steps_s",
    default="",
    callback=options.time_steps,
    help="Time steps in s, separated by commas. [default: about the bounds]",
)
@options.taking(options.out, options.overrides, options.jobs)
def stability(**arguments):
    """Say at which time steps the bed of CASE rests, under each native scheme."""
    return commands.stability(**arguments)


@cli.command()
@options.taking(options.case, options.engines, *options.ensemble)
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
    callback=options.engine_names,
    help="Which engines run the variants.",
)
@click.option(
    "--variant-seeds",
    type=click.IntRange(1, 1000),
    help="How many packings of each variant, which have no twins. [default: as --seeds]",
)
@options.taking(options.record, options.out, options.jobs_or_tasks, options.profile)
def record(**arguments):
    """Run CASE, and keep of the runs what a comparison reads: few enough numbers to stand beside the case.

    `check --replay` compares with them, `calibrate` judges the judge on them. What is recorded of each variant goes to
    a folder of its own, NAME of the case/VARIANT; what was recorded there before is replaced.
    """
    return commands.record(**arguments)


@cli.command()
@options.case_or_reference
@click.option(
    "--splits",
    type=click.IntRange(20, 100_000),
    default=200,
    show_default=True,
    help="Random splits of the recorded native runs, for each size of a comparison.",
)
@options.taking(options.record, options.out, options.overrides, options.jobs)
def calibrate(**arguments):
    """Judge the judge: how often it errs about recorded native runs, of which the truth is known.

    Ends with 0 when its error rates are as low as they are to be, 1 when not, 4 when there are too few recorded runs.
    """
    return commands.calibrate(**arguments)


@cli.group()
def dataset():
    """Reference datasets: packages of all runs of a case, to be published, verified and compared with."""


@dataset.command("build")
@options.taking(options.case, *options.running)
@click.option(
    "--native-seeds",
    type=click.IntRange(1, 1000),
    help="How many packings the native solver runs, where it is to run more than the others. [default: as --seeds]",
)
@click.option(
    "-o",
    "--output",
    metavar="DIR",
    required=True,
    type=click.Path(path_type=Path),
    help="The package, which is not there yet.",
)
@click.option(
    "--author",
    "authors",
    metavar="NAME",
    multiple=True,
    default=["The crossdem authors"],
    show_default=True,
    help="Who is to be cited; may be repeated.",
)
@click.option(
    "--archive", is_flag=True, help="Also write DIR.tar.gz, the same bytes for the same package."
)
def dataset_build(**arguments):
    """Run CASE in every engine or reuse its runs, and write a package DIR of them, whole or not at all.

    Ends with 0 whatever the verdict in the package, and with 3 and without a package when a run has no result.
    """
    return commands.dataset_build(**arguments)


@dataset.command("verify")
@click.argument("folder", metavar="DIR", type=click.Path(path_type=Path))
@click.option("--identity", metavar="HEX", help="What its SHA256SUMS is to have as SHA-256.")
def dataset_verify(**arguments):
    """List every byte and file by which the package DIR is not what was built: 0 for none, 1 else, 2 for no package."""
    return commands.dataset_verify(**arguments)


@cli.group(invoke_without_command=True)
@options.taking(bench_options.engines, bench_options.workloads, bench_options.one_thread)
@bench_options.shared
@click.pass_context
def bench(context, **arguments):
    """Time the engines on the same beds: ns per particle-step, time to solution, each against the native solver.

    Nothing but the stepping is timed, by each engine itself, on one thread. Ends with 3 when an engine is missing or failed.
    """
    if not context.invoked_subcommand:
        return commands.bench(**arguments)
    if any(context.get_parameter_source(name) is not ParameterSource.DEFAULT for name in arguments):
        raise click.UsageError(f"options of {context.invoked_subcommand} stand behind its name")


@bench.command("scaling")
@bench_options.largest
@bench_options.one_and_two_threads
@bench_options.shared
def bench_scaling(**arguments):
    """Time the native solver on static beds of 1000 particles and more: speed on one thread and on two, memory,
    and how long a bed settles."""
    return commands.bench_scaling(**arguments)


@cli.command()
def doctor():
    """Say which engines are here, and what to install."""
    return examine()


def main(arguments: list[str] | None = None) -> int:
    """Runs a command; returns its exit code. No exception leaves it."""
    terminated = []

    def end_as_by_ctrl_c(*_):  # and with that the engines
        terminated.append(True)
        raise KeyboardInterrupt

    signal.signal(signal.SIGTERM, end_as_by_ctrl_c)
    try:
        return cli.main(arguments, prog_name="crossdem", standalone_mode=False) or ExitCode.AGREES
    except click.Abort:
        kept = "what is finished is kept, and the same command goes on from there"
        click.echo(f"interrupted; {kept}", err=True)
        return ExitCode.TERMINATED if terminated else ExitCode.INTERRUPTED
    except click.ClickException as error:
        error.show()
        return ExitCode.BAD_INPUT
    except (CaseError, DatasetError, EngineFileError, WorkspaceError) as error:
        click.echo(error, err=True)
        return ExitCode.BAD_INPUT
    except (EngineNotFound, SolverError, WorkflowError) as error:
        click.echo(error, err=True)
        return ExitCode.ENGINE_FAILED
    except OSError as error:
        click.echo(f"crossdem: {error}: correct that, and repeat the command to go on", err=True)
        return ExitCode.SYSTEM
    except Exception:
        traceback.print_exc()
        click.echo(
            "crossdem: this is a bug in crossdem; please report it with these lines", err=True
        )
        return ExitCode.BUG


if __name__ == "__main__":
    sys.exit(main())
