"""`crossdem record`: runs a case and variants of it, and keeps of the runs what a judge reads."""

from __future__ import annotations

import json
import shlex
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime, timezone
from pathlib import Path

from rich.console import Console

from crossdem import ExitCode, __version__
from crossdem.adapters.case import Case, CaseError
from crossdem.adapters.gates import REFERENCE
from crossdem.adapters.machine import machine_facts
from crossdem.adapters.solver import SolverError, solver_sha256
from crossdem.adapters.workspace import Workspace

from .ensemble import Ensemble
from .finished_runs import packing_files, read_runs
from .record import libraries
from .recorded import DATE, RECORDS, SCHEMA_VERSION, Record
from .recorded_tables import FIELD_DIGITS
from .runs import Runs, run_engines

DEFAULT = "default"  # names the case as its file has it


@dataclass(frozen=True)
class Plan:
    """What to run of one variant of a case."""

    overrides: tuple[str, ...]
    engines: tuple[str, ...]
    seeds: int
    twins: int  # of a packing, beside itself
    twin_seeds: int  # of how many packings engines run the twins
    native_twins: int  # of each packing

    @property
    def name(self) -> str:
        """Of the variant's folder."""
        return ",".join(self.overrides) or DEFAULT


def plans_of(
    variants: Sequence[str],
    engines: Sequence[str],
    seeds: int,
    twins: int,
    twin_seeds: int | None,
    native_twins: int | None,
    variant_engines: Sequence[str],
    variant_seeds: int | None,
) -> list[Plan]:
    """Of the case as it stands, then of each of its `variants`, on packings without twins. Raises CaseError."""
    if faults := [
        f"--variant {name}: it becomes the name of a folder; leave out the /"
        for name in variants
        if "/" in name
    ]:
        raise CaseError(faults)
    more = native_twins if native_twins is not None else twins
    twin_seeds = min(twin_seeds or seeds, seeds)
    plans = [Plan((), tuple(engines), seeds, twins, twin_seeds, max(more, twins))]
    for variant in variants:
        overrides = tuple(part.strip() for part in variant.split(","))
        count = variant_seeds or seeds
        plans.append(Plan(overrides, tuple(variant_engines), count, 0, count, 0))
    return plans


def record_case(
    case_file: Path,
    plans: Sequence[tuple[Plan, Case]],
    folder: Path,
    workspace: Workspace,
    jobs: int | None,
    profile: str | None,
    console: Console,
) -> None:
    """Run or reuse all that the `plans` ask of their variants of a case, and write a record of each into `folder`.

    Raises SolverError when a run has no result: what was recorded until then stays.
    """
    for plan, case in plans:
        folders: dict[Path, None] = {}
        for engines, seeds, twins in _batches(plan):
            runs = run_engines(case, list(engines), seeds, workspace, jobs, console, twins, profile)
            refuse_failures(runs, "not recorded")
            folders |= dict.fromkeys(runs.folders)
        home = folder / case.name / plan.name
        record_of(case, list(folders), plan, _command(case_file, plans, folder)).write(home)
        size = sum(path.stat().st_size for path in home.iterdir())
        console.print(f"{home}: {len(folders)} runs, {size / 1e6:.1f} MB", soft_wrap=True)


def record_of(case: Case, folders: Sequence[Path], plan: Plan, command: str) -> Record:
    """The record of the finished runs in `folders`, which are of this case."""
    ensemble, packings = read_runs(folders)
    return Record(
        case, ensemble, *packing_files(packings), _manifest(case, ensemble, plan, command)
    )


def _command(case_file: Path, plans: Sequence[tuple[Plan, Case]], folder: Path) -> str:
    """What makes these records again; where runs go and how many at a time is left to who types it."""
    first, *others = [plan for plan, _ in plans]
    words = ["crossdem", "record", str(case_file), "--engines", ",".join(first.engines)]
    words += ["--seeds", str(first.seeds), "--twins", str(first.twins)]
    words += ["--twin-seeds", str(first.twin_seeds), "--native-twins", str(first.native_twins)]
    for plan in others:
        words += ["--variant", plan.name]
    if others:
        words += ["--variant-engines", ",".join(others[0].engines)]
        words += ["--variant-seeds", str(others[0].seeds)]
    return shlex.join(words if folder == RECORDS else [*words, "--record", str(folder)])


def _batches(plan: Plan) -> list[tuple[tuple[str, ...], int, int]]:
    """Engines, and the packings and twins they run. Native runs all of them, as the gates need one beside each run."""
    batches = [(plan.engines, plan.twin_seeds, plan.twins), (plan.engines, plan.seeds, 0)]
    if REFERENCE in plan.engines:
        batches.append(((REFERENCE,), plan.seeds, plan.native_twins))
    return list(dict.fromkeys(batches))


def refuse_failures(runs: Runs, what: str) -> None:
    """Raises SolverError where a run has no result; `what` then was not made, for people."""
    if runs.failures:
        lines = (f"{engine}, seed {seed}: {why}" for (engine, seed), why in runs.failures.items())
        raise SolverError("\n".join([f"{what}, as runs are missing:", *lines]))


def _manifest(case: Case, ensemble: Ensemble, plan: Plan, command: str) -> dict:
    return {
        "schema_version": SCHEMA_VERSION,
        "case": {
            "name": case.name,
            "title": case.resolved["title"],
            "run_hash": case.run_hash,
            "changes": list(plan.overrides),
        },
        DATE: datetime.now(timezone.utc).isoformat(timespec="seconds"),
        "command": command,
        "crossdem": __version__,
        "solver_sha256": solver_sha256(),
        "engines": {engine: _engine(ensemble, engine) for engine in ensemble.engines},
        "machine": machine_facts(),  # that wrote this; each run names its own
        "rounding": f"fields.csv.gz to 1e-{FIELD_DIGITS} m; every other number reads back the same",
        "libraries": libraries(),
    }


def _engine(ensemble: Ensemble, engine: str) -> dict:
    runs = {run: facts for run, facts in ensemble.manifests.items() if run[0] == engine}
    return {
        "versions": sorted({facts["engine_version"] for facts in runs.values()}),
        "runs": len(runs),
        "seeds": len({seed for _, seed, _ in runs}),
        "twins": max(twin for _, _, twin in runs),
    }
