"""What the commands of the command line do; each returns its exit code."""

from collections.abc import Iterable
from contextlib import contextmanager
from pathlib import Path

import click
from rich.console import Console

from crossdem import ExitCode
from crossdem.adapters.case import Case, CaseError, load_case
from crossdem.adapters.dataset import Dataset, DatasetError
from crossdem.adapters.engines import unknown_engines
from crossdem.adapters.gates import REFERENCE
from crossdem.adapters.workflow.snakemake import check_cluster
from crossdem.adapters.workspace import Workspace

from .bench_workloads import QUICK_WORKLOADS, WORKLOADS
from .comparison import ComparisonError, case_faults, compare_runs
from .explain import explain_case
from .horizon import Horizon
from .horizon_runs import find_horizon, horizon_of_runs
from .dataset_record import read_package
from .record_command import plans_of, record_case
from .recorded import Record, check_writable, find_record
from .replay import replayed, restore_packings, said_of
from .replaced import replaced_by
from .runs import Runs, here, run_engines, write_inputs
from .stability import FAILED
from .stability_runs import map_stability
from .summary import print_summary


def check(
    case_file, engines, seeds, twins, out, overrides, jobs, profile, ranks, replay, against, record
) -> ExitCode:
    case = None if case_file.is_dir() else _load(case_file, overrides)
    if not case or case.resolved["particle"]:  # no bed, of which there could be seeds
        _refuse_on_ladder(
            {
                "--replay": replay,
                "--against": against,
                "--profile": profile,
                "--mpi-ranks": ranks > 1,
            }
        )
        return _check_ladder(case_file, engines, out, overrides, jobs)
    _needs_bar(case)
    check_cluster(profile)
    if replay or against:
        recorded = read_package(against, case) if against else find_record(case, record)
        return _replay(case, engines, seeds, twins, out, overrides, jobs, profile, ranks, recorded)
    with _workspace(case, overrides, out) as workspace:
        runs, found = _run(case, engines, seeds, workspace, jobs, twins, profile, ranks)
    return _report(case, map(Dataset.read, runs.folders), runs, workspace, found)


def _replay(case, engines, seeds, twins, out, overrides, jobs, profile, ranks, record) -> ExitCode:
    others = replayed(record, engines, seeds, twins)
    click.echo(said_of(others))
    runs, found = Runs((), {}), None
    with _workspace(case, overrides, out, "-replay") as workspace:
        if engines:
            restore_packings(case, record, seeds, workspace)
            runs, found = _run(case, engines, seeds, workspace, jobs, twins, profile, ranks)
    return _report(case, map(Dataset.read, runs.folders), runs, workspace, found, others)


def _run(
    case, engines, seeds, workspace, jobs, twins, profile, ranks
) -> tuple[Runs, Horizon | None]:
    runs = run_engines(case, engines, seeds, workspace, jobs, Console(), twins, profile, ranks)
    return runs, horizon_of_runs(
        case, engines, runs.failures, workspace, here(jobs, profile), Console()
    )


def _refuse_on_ladder(given: dict[str, object]) -> None:
    """Raises UsageError for options that are for beds."""
    if names := [name for name, value in given.items() if value]:
        raise click.UsageError(
            f"{', '.join(names)}: not for cases of particles placed by hand: each of their runs takes a second here, on one "
            "core. Leave it out"
        )


def _check_ladder(*arguments) -> ExitCode:
    from .ladder_command import check_ladder  # here: its solvers of equations take as long

    return check_ladder(*arguments)


def conform(engine, case_file, tier, bed, out, jobs) -> ExitCode:
    from .conform_command import conform as tested  # here: as in _report

    case = _load(case_file, [])
    _needs_bar(case)
    return tested(engine, case, tier, bed, Workspace(out or Path("results") / engine), jobs)


def run(case_file, engines, seeds, twins, out, overrides, jobs, profile, ranks) -> ExitCode:
    case = _load(case_file, overrides)
    check_cluster(profile)
    with _workspace(case, overrides, out) as workspace:
        return _tell(
            run_engines(case, engines, seeds, workspace, jobs, Console(), twins, profile, ranks)
        )


def generate(case_file, engines, seeds, out, overrides, jobs) -> ExitCode:
    case = _load(case_file, overrides)
    with _workspace(case, overrides, out) as workspace:
        return _tell(write_inputs(case, engines, seeds, workspace, jobs, Console()))


def resolve(case_file, overrides) -> ExitCode:
    click.echo(_load(case_file, overrides).canonical)
    return ExitCode.AGREES


def compare(folders, out) -> ExitCode:
    Dataset.read(folders[0])  # refuses what is no run
    case = Case.from_canonical((folders[0] / "inputs" / "case.json").read_bytes())
    _needs_bar(case)
    workspace = Workspace(out or Path("results") / f"{case.name}-compare")
    try:
        return _report(case, map(Dataset.read, folders), Runs((), {}), workspace)
    except DatasetError:
        workspace.discard_if_new()
        raise
    except ComparisonError as error:
        workspace.discard_if_new()
        raise CaseError(error.faults) from error


def export(folder, vtk, h5md, out) -> ExitCode:
    from .export import write_h5md, write_vtk  # here: as in _report

    if not (vtk or h5md):
        raise click.UsageError("say what to write: --vtk, --h5md or both")
    dataset = Dataset.read(folder)
    workspace = Workspace(out or Path("results") / f"{folder.resolve().name}-export")
    if vtk:
        click.echo(write_vtk(dataset, workspace.root / "vtk"))
    if h5md:
        click.echo(write_h5md(dataset, workspace.root / "motion.h5"))
    return ExitCode.AGREES


def explain(
    case_file, origin, target, seeds, engine_seeds, out, overrides, jobs, profile
) -> ExitCode:
    from .explain_report import print_explanation, write_explanation  # here: as in _report

    case = _load(case_file, [*overrides, f"scheme.name={origin}"])
    check_cluster(profile)
    with _workspace(case, overrides, out) as workspace:
        attribution = explain_case(
            case, target, seeds, engine_seeds or seeds, workspace, jobs, Console(), profile
        )
        page = write_explanation(attribution, workspace.root / f"explain-{target}")
    print_explanation(attribution, page)
    if attribution.engine_failed:
        return ExitCode.ENGINE_FAILED
    return ExitCode.AGREES if attribution.has_total else ExitCode.INCONCLUSIVE


def horizon(case_file, engines, seed, out, overrides, jobs) -> ExitCode:
    from .horizon_report import print_horizon, write_horizon  # here: as in _report

    case = _load(case_file, overrides)
    with _workspace(case, overrides, out) as workspace:
        found = find_horizon(case, engines, seed, workspace, jobs, Console())
        page = write_horizon(case, found, workspace.root / "horizon")
    print_horizon(found, page)
    return found.exit_code


def stability(case_file, steps_s, seeds, out, overrides, jobs) -> ExitCode:
    from .stability_report import print_stability, write_stability  # here: as in _report

    case = _load(case_file, overrides)
    with _workspace(case, overrides, out) as workspace:
        found = map_stability(case, steps_s, seeds, workspace, jobs, Console())
        page = write_stability(found, workspace.root / "stability")
    print_stability(found, page)
    failed = any(trial.outcome == FAILED for trial in found.trials)
    return ExitCode.ENGINE_FAILED if failed else ExitCode.AGREES


def reproduce(case_file, engines, seeds, engine_seeds, out, overrides, jobs, profile) -> ExitCode:
    from .reproduction.report import print_reproduction, write_reproduction  # here: as in _report
    from .reproduction.reproduce import reproduce_paper
    from .reproduction.runs import Size

    case = _load(case_file, overrides)
    _needs_bar(case)
    check_cluster(profile)
    size = Size(seeds, engine_seeds, tuple(dict.fromkeys([REFERENCE, *engines])))
    with _workspace(case, overrides, out) as workspace:
        reproduction = reproduce_paper(case, size, workspace, jobs, Console(), profile)
        page = write_reproduction(reproduction, workspace.root / "reproduce")
    print_reproduction(reproduction, page)
    return reproduction.exit_code


def record(case_file, variants, record, out, jobs, profile, **ensemble) -> ExitCode:
    plans = [(plan, _load(case_file, plan.overrides)) for plan in plans_of(variants, **ensemble)]
    for _, case in plans:
        _needs_bar(case)
    check_cluster(profile)
    for plan, case in plans:
        check_writable(record / case.name / plan.name)
    with _workspace(plans[0][1], [], out) as workspace:
        record_case(case_file, plans, record, workspace, jobs, profile, Console())
    return ExitCode.AGREES


def calibrate(case_file, overrides, splits, record, out, jobs) -> ExitCode:
    from .calibration_command import calibrate_case  # here: as in _report

    case = _load(case_file, overrides)
    recorded = find_record(case, record)
    with _workspace(case, overrides, out) as workspace:
        return calibrate_case(case, recorded, splits, workspace.root / "calibrate", jobs)


def dataset_build(
    case_file,
    engines,
    seeds,
    twins,
    native_seeds,
    overrides,
    out,
    output,
    archive,
    authors,
    jobs,
    profile,
    ranks,
) -> ExitCode:
    from .dataset_command import build, refuse_places

    case = _load(case_file, overrides)
    _needs_bar(case)
    check_cluster(profile)
    refuse_places(output, archive)
    with _workspace(case, overrides, out) as workspace:
        return build(
            case,
            overrides,
            engines,
            seeds,
            native_seeds or seeds,
            twins,
            output,
            archive,
            authors,
            workspace,
            jobs,
            profile,
            ranks,
        )


def dataset_verify(folder, identity) -> ExitCode:
    from .dataset_command import verify

    return verify(folder, identity)


def bench(engines, workloads, threads, quick, repeats, json_file, case_file, out) -> ExitCode:
    from .bench_command import bench_engines  # here: as in _report

    names = workloads or (QUICK_WORKLOADS if quick else WORKLOADS)
    case = _load(case_file, [])
    _needs_bar(case)
    with _workspace(case, [], out) as workspace:
        return bench_engines(case, names, engines, threads, repeats, quick, workspace, json_file)


def bench_scaling(largest, threads, quick, repeats, json_file, case_file, out) -> ExitCode:
    from .bench_command import bench_scaling as scale  # here: as in _report

    case = _load(case_file, [])
    _needs_bar(case)
    with _workspace(case, [], out) as workspace:
        return scale(case, largest, threads, repeats, quick, workspace, json_file)


def _needs_bar(case: Case) -> None:
    """Raises CaseError for what no comparison of beds can be made of."""
    if case.resolved["particle"]:
        said = "its particles are placed by hand: `crossdem check` on its file compares such runs"
        raise CaseError([f"{case.name}: {said}"])
    if "bar" not in case.resolved:
        said = "there is no bar, whose resistance is compared; `crossdem run` runs it without comparing"
        raise CaseError([f"{case.file_name}: bar: {said}"])


def _load(case_file: Path, overrides: list[str]) -> Case:
    case = load_case(case_file, overrides, lambda raw: case_faults(raw) + unknown_engines(raw))
    for warning in case.warnings:
        click.echo(warning, err=True)
    return case


@contextmanager
def _workspace(case: Case, overrides: list[str], out: Path | None, purpose: str = ""):
    """The output folder; a variant's own by default. Gone again when it was new and the case turns out to be at fault."""
    variant = f"-{case.hash[:8]}" if overrides else ""
    workspace = Workspace(out or Path("results") / f"{case.name}{variant}{purpose}")
    try:
        yield workspace
    except CaseError:
        workspace.discard_if_new()
        raise


def _report(
    case: Case,
    datasets: Iterable[Dataset],
    runs: Runs,
    workspace: Workspace,
    horizon: Horizon | None = None,
    recorded: Record | None = None,
) -> ExitCode:
    from .report import write_report  # here: its drawing library takes half a second to load

    comparison = compare_runs(case, datasets, runs.failures, runs.unsupported, horizon, recorded)
    replaced = replaced_by(comparison, workspace.root)
    page = write_report(comparison, workspace.root)
    print_summary(comparison, page, replaced=replaced)
    return comparison.verdict.exit_code


def _tell(runs: Runs) -> ExitCode:
    for folder in runs.folders:
        click.echo(folder)
    for (engine, seed), why in runs.failures.items():
        click.echo(f"{engine}, seed {seed}: {why}", err=True)
    return ExitCode.ENGINE_FAILED if runs.failures else ExitCode.AGREES
