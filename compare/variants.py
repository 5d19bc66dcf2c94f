"""Variants of a case, run side by side: what attribution, horizon and stability map have in common."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from crossdem.adapters.case import Case
from crossdem.adapters.dataset import Dataset
from crossdem.adapters.packing import Packing
from crossdem.adapters.run import RunRequest, RunResult, run_all
from crossdem.adapters.solver import SolverError
from crossdem.adapters.workflow.ensemble import run_ensemble
from crossdem.adapters.workspace import Workspace

from .progress import ProgressDisplay
from .runs import settle


@dataclass(frozen=True)
class Variant:
    """A case, as a rule with some values changed, in one engine."""

    name: str  # as people read it, and the only one of that name
    case: Case
    engine: str = "native"


@dataclass(frozen=True)
class VariantRun:
    """What became of a variant on one packing: a dataset's folder, or why there is none."""

    variant: Variant
    packing: Packing
    folder: Path | None
    failure: str | None
    unsupported: bool = False  # a failure that no engine is to blame for
    exit_status: int | None = None  # of a process that failed

    def dataset(self) -> Dataset:
        """Read anew each time: a walk through many variants would not go into memory."""
        return Dataset.read(self.folder)

    def manifest(self) -> dict:
        """That of the dataset, without reading it all."""
        return json.loads((self.folder / "manifest.json").read_text(encoding="utf-8"))


def run_variants(
    case: Case,
    pairs: Sequence[tuple[Variant, Packing]],
    workspace: Workspace,
    jobs: int,
    display: ProgressDisplay,
) -> list[VariantRun]:
    """Run or reuse each variant of `case` on its packing, in their order. Variants that are the same are run once.

    Runs of `case` itself lie in runs/, as those of `crossdem check`; those of other cases apart, in variants/runs/.
    """
    requests, names = _requests(pairs)
    results = {}
    for folder in (workspace.root / "variants", workspace.root):
        some = {
            key: entry for key, entry in requests.items() if _place(key, case, workspace) == folder
        }
        ran = run_all(
            list(some.values()),
            folder,
            jobs,
            lambda request, *progress: display.update(names[id(request)], *progress),
        )
        results |= dict(zip(some, ran))
    return _told(pairs, results, display)


def run_many_variants(
    case: Case,
    pairs: Sequence[tuple[Variant, Packing]],
    workspace: Workspace,
    jobs: int | None,
    display: ProgressDisplay,
    profile: str | None = None,
) -> list[VariantRun]:
    """As run_variants, through the workflow: for more runs than one sits and waits for."""
    requests, _ = _requests(pairs)
    placed = [(entry, _place(key, case, workspace)) for key, entry in requests.items()]
    ran = run_ensemble(placed, workspace.root / "workflow", jobs, display.count, profile)
    return _told(pairs, dict(zip(requests, ran)), display)


def _requests(
    pairs: Sequence[tuple[Variant, Packing]],
) -> tuple[dict[tuple[str, str, str], RunRequest], dict[int, str]]:
    """What is to be run, once each, and the name of each request for people, by its id()."""
    requests: dict[tuple[str, str, str], RunRequest] = {}
    names: dict[int, str] = {}
    for variant, packing in pairs:
        request = RunRequest(variant.case, packing, variant.engine)
        kept = requests.setdefault(_identity(variant, packing), request)
        names.setdefault(id(kept), f"{variant.name}, seed {packing.seed}")
    return requests, names


def _place(identity: tuple[str, str, str], case: Case, workspace: Workspace) -> Path:
    return workspace.root if identity[0] == case.hash else workspace.root / "variants"


def _told(
    pairs: Sequence[tuple[Variant, Packing]],
    results: dict[tuple[str, str, str], RunResult],
    display: ProgressDisplay,
) -> list[VariantRun]:
    if reused := sum(result.status == "reused" for result in results.values()):
        display.say(f"{reused} of {len(results)} runs were there already")
    return [
        VariantRun(
            variant,
            packing,
            result.dataset_folder,
            result.failure,
            result.status == "unsupported",
            result.exit_status,
        )
        for variant, packing in pairs
        for result in [results[_identity(variant, packing)]]
    ]


def settled(
    case: Case, seeds: int, workspace: Workspace, jobs: int, display: ProgressDisplay
) -> list[Packing]:
    """The packings of seeds 1, 2, ... Raises CaseError, and SolverError where one could not be made."""
    packings, unsettled = settle(case, seeds, workspace, jobs, display)
    for seed, why in unsettled.items():
        raise SolverError(f"packing of seed {seed}: {why}")
    return packings


def _identity(variant: Variant, packing: Packing) -> tuple[str, str, str]:
    return variant.case.hash, packing.hash, variant.engine
