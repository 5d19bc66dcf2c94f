"""All runs of one case side by side: their quantities, checks and verdict."""

from __future__ import annotations

import itertools
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import pandas as pd

from crossdem.adapters.case import Case
from crossdem.adapters.dataset import Dataset
from crossdem.adapters.engines import ENGINES
from crossdem.adapters.gates import REFERENCE, contacts_at_rest, with_contacts_gate

from .answers import answer_faults
from .checks import Check, CheckResult, check_faults, evaluate
from .horizon import Horizon
from .quantities import endpoints, unknown_quantities
from .verdict import Verdict, decide


class ComparisonError(Exception):
    """Runs that are not one comparison, or checks that cannot be made; `faults` are lines ready to print."""

    def __init__(self, faults: Sequence[str]) -> None:
        super().__init__("\n".join(faults))
        self.faults = list(faults)


@dataclass(frozen=True)
class Comparison:
    """Everything the report says, computed; nothing of how it is said."""

    case: Case
    engines: tuple[str, ...]  # with and without results
    datasets: tuple[Dataset, ...]  # in the order of engines, then seeds
    failures: dict[tuple[str, int], str]  # (engine, seed): why there is no dataset
    endpoints: pd.DataFrame  # quantities.endpoints
    results: tuple[CheckResult, ...]
    verdict: Verdict
    horizon: Horizon | None = None  # None: nothing was compared particle by particle

    @property
    def seeds(self) -> tuple[int, ...]:
        return tuple(sorted({seed for _, seed in self.runs()}))

    def runs(self) -> list[tuple[str, int]]:
        """(engine, seed) of every run asked for, finished or not."""
        return [(dataset.engine, dataset.seed) for dataset in self.datasets] + list(self.failures)

    def of(self, engine: str) -> list[Dataset]:
        return [dataset for dataset in self.datasets if dataset.engine == engine]


def compare_runs(
    case: Case,
    datasets: Iterable[Dataset],
    failures: dict[tuple[str, int], str] | None = None,
    unsupported: frozenset[tuple[str, int]] = frozenset(),
    horizon: Horizon | None = None,
) -> Comparison:
    """Compare the `datasets` of one `case`; `failures` says for each (engine, seed) without one why.

    Those of them that are `unsupported` make their engine not comparable; it has not failed. `horizon` holds the
    comparison particle by particle: an engine that differs there differs, whatever the statistics say.

    Raises ComparisonError when the datasets are not of this case, a run is there twice, or a check makes no sense.
    """
    failures = dict(failures or {})
    engines = in_order(
        {dataset.engine for dataset in datasets} | {engine for engine, _ in failures}
    )
    runs = gated(sorted(datasets, key=lambda run: (engines.index(run.engine), run.seed)))
    faults = comparison_faults(case, runs)
    if faults:
        raise ComparisonError(faults)

    table = endpoints(runs)
    seeds = {run.seed for run in runs} | {seed for _, seed in failures}
    results = tuple(
        evaluate(check, pair, table, obstacles)
        for pair, obstacles in _pairs(engines, runs, failures, seeds)
        for check in Check.of_case(case.resolved)
    )
    failed = {run: why for run, why in failures.items() if run not in unsupported}
    if horizon:
        failed |= {run: f"from the packing: {why}" for run, why in horizon.failures.items()}
    return Comparison(
        case,
        engines,
        runs,
        failures,
        table,
        results,
        decide(engines, results, failed, _failed_gates(runs), horizon.strays if horizon else ()),
        horizon,
    )


def gated(runs: Sequence[Dataset]) -> tuple[Dataset, ...]:
    """The same runs, each with its gate on contacts where the native run of its packing is among them.

    A run made before, or without, its native counterpart lacks that gate.
    """
    contacts = {
        run.manifest["packing_hash"]: contacts_at_rest(run)
        for run in runs
        if run.engine == REFERENCE
    }
    return tuple(
        with_contacts_gate(run, contacts[run.manifest["packing_hash"]])
        if run.manifest["packing_hash"] in contacts
        else run
        for run in runs
    )


def case_faults(case: dict) -> list[str]:
    """A line for everything in `case`, resolved or as read, that only the comparison can know to be wrong."""
    return unknown_quantities(case) + check_faults(case) + answer_faults(case)


def comparison_faults(case: Case, datasets: Sequence[Dataset]) -> list[str]:
    """A line for everything that forbids to compare `datasets` under `case`."""
    faults = case_faults(case.resolved)
    for dataset in datasets:
        if dataset.manifest["case_hash"] != case.hash:
            faults.append(
                f"{dataset.engine}, seed {dataset.seed}: run of another case "
                f"({dataset.manifest['case_hash'][:12]}; this one is {case.hash[:12]})"
            )
    runs = Counter((dataset.engine, dataset.seed) for dataset in datasets)
    faults += [
        f"{engine}, seed {seed}: given {n} times" for (engine, seed), n in runs.items() if n > 1
    ]
    return faults


def in_order(engines: Iterable[str]) -> tuple[str, ...]:
    """As ENGINES has them, everywhere; others follow by name."""
    rank = {engine: number for number, engine in enumerate(ENGINES)}
    return tuple(sorted(engines, key=lambda engine: (rank.get(engine, len(rank)), engine)))


def _failed_gates(runs: Iterable[Dataset]) -> list[str]:
    return [
        f"{run.engine}, seed {run.seed}: {gate['message']}"
        for run in runs
        for gate in run.manifest["gates"]
        if not gate["passed"]
    ]


def _pairs(engines, runs, failures, seeds):
    """Each pair of engines, the later one first (liggghts against native), with what forbids to compare it."""
    packing = {(run.engine, run.seed): run.manifest["packing_hash"] for run in runs}
    for second, first in itertools.combinations(engines, 2):
        obstacles = []
        for engine in (first, second):
            for seed in sorted(seeds):
                if (engine, seed) not in packing:
                    why = failures.get((engine, seed), "not run")
                    obstacles.append(f"{engine}, seed {seed}: {why}")
        obstacles += _failed_gates([run for run in runs if run.engine in (first, second)])
        obstacles += [
            f"seed {seed}: {first} and {second} did not start from the same packing"
            for seed in sorted(seeds)
            if len({packing.get((first, seed)), packing.get((second, seed))} - {None}) > 1
        ]
        yield (first, second), tuple(obstacles)
