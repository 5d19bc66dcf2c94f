"""All runs of one case side by side: their quantities, checks and verdict."""

from __future__ import annotations

import functools
import itertools
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

import pandas as pd

from crossdem.adapters.case import Case
from crossdem.adapters.dataset import Dataset
from crossdem.adapters.engines import ENGINES
from crossdem.adapters.gates import with_contacts_gates

from .answers import answer_faults
from .checks import Check, CheckResult, check_faults, evaluate
from .ensemble import Ensemble, of_engine, packing_means
from .horizon import Horizon
from .intake import Intake, failed_gates, obstacles
from .opinions import Opinions
from .quantities import QUANTITIES, unknown_quantities
from .recorded import Record
from .verdict import Verdict, decide

Run = tuple[str, int, int]  # engine, seed, twin


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
    ensemble: Ensemble  # all runs, recorded ones too
    endpoints: pd.DataFrame  # ensemble.packing_means of its endpoints
    datasets: tuple[
        Dataset, ...
    ]  # twin 0 of each packing, for pictures; of recorded runs those that lie there whole
    recorded: frozenset[Run]  # runs of the ensemble that were read from a record
    failures: dict[tuple[str, int], str]  # (engine, seed): why there is no dataset
    results: tuple[CheckResult, ...]
    verdict: Verdict
    horizon: Horizon | None = None  # None: nothing was compared particle by particle

    @property
    def seeds(self) -> tuple[int, ...]:
        """Of every run asked for, finished or not."""
        return tuple(sorted({seed for _, seed, *_ in [*self.ensemble.manifests, *self.failures]}))

    @property
    def pairs(self) -> tuple[tuple[str, str], ...]:
        return tuple(dict.fromkeys(result.pair for result in self.results))

    @functools.cached_property
    def opinions(self) -> Opinions:
        """Beside the verdict: no part of it. They take seconds."""
        return Opinions.of(self.case, self.ensemble, self.failures)

    def of(self, engine: str) -> list[Dataset]:
        return [dataset for dataset in self.datasets if dataset.engine == engine]

    def manifests(self, engine: str) -> dict[Run, dict]:
        return {run: about for run, about in self.ensemble.manifests.items() if run[0] == engine}

    def packings(self, engine: str) -> pd.DataFrame:
        """The mean resistance [N] per cm of depth, a row for each of the engine's packings."""
        return of_engine(packing_means(self.ensemble.profiles), engine)


def compare_runs(
    case: Case,
    datasets: Iterable[Dataset],
    failures: dict[tuple[str, int], str] | None = None,
    unsupported: frozenset[tuple[str, int]] = frozenset(),
    horizon: Horizon | None = None,
    recorded: Record | None = None,
) -> Comparison:
    """Compare the `datasets` of one `case`, and with them the `recorded` runs of it; `failures` says for each
    (engine, seed) without a dataset why.

    The datasets are read one by one, and only twin 0 of each packing stays in memory. Failures that are
    `unsupported` make their engine not comparable; it has not failed. `horizon` holds the comparison particle by
    particle: an engine that differs there differs, whatever the statistics say.

    Raises ComparisonError when the runs are not of this case, a run is there twice, or a check makes no sense.
    """
    failures = dict(failures or {})
    read = frozenset(recorded.ensemble.manifests if recorded else ())
    intake = Intake(case, read)
    ensemble = Ensemble.of(intake.sound(datasets))
    if faults := case_faults(case.resolved) + intake.faults:
        raise ComparisonError(faults)
    ensemble = ensemble.joined(recorded.ensemble) if recorded else ensemble
    # Anew for all: a recorded run meets another native run here than where it was recorded.
    share = case.resolved["gates"]["contacts_share"]
    ensemble = replace(ensemble, manifests=with_contacts_gates(ensemble.manifests, share))
    engines = in_order({*ensemble.engines, *(engine for engine, _ in failures)})
    order = {engine: number for number, engine in enumerate(engines)}
    ensemble = ensemble.selected(
        sorted(ensemble.manifests, key=lambda run: (order[run[0]], *run[1:]))
    )

    endpoints = packing_means(ensemble.endpoints).reindex(columns=list(QUANTITIES))
    checks = Check.of_case(case.resolved)
    results = tuple(
        result
        # the later engine first: liggghts against native
        for second, first in itertools.combinations(engines, 2)
        for result in evaluate(
            checks,
            (first, second),
            endpoints,
            obstacles((first, second), ensemble.manifests, failures),
        )
    )
    failed = {run: why for run, why in failures.items() if run not in unsupported}
    if horizon:
        failed |= {run: f"from the packing: {why}" for run, why in horizon.failures.items()}
    verdict = decide(
        engines,
        results,
        failed,
        failed_gates(ensemble.manifests, engines),
        horizon.strays if horizon else (),
        ensemble.runs_each,
        (recorded.source, len(recorded.seeds)) if recorded else None,
    )
    return Comparison(
        case,
        engines,
        ensemble,
        endpoints,
        intake.pictured(order, recorded.datasets if recorded else ()),
        read,
        failures,
        results,
        verdict,
        horizon,
    )


def case_faults(case: dict) -> list[str]:
    """A line for everything in `case`, resolved or as read, that only the comparison can know to be wrong."""
    return unknown_quantities(case) + check_faults(case) + answer_faults(case)


def in_order(engines: Iterable[str]) -> tuple[str, ...]:
    """As ENGINES has them, everywhere; others follow by name."""
    rank = {engine: number for number, engine in enumerate(ENGINES)}
    return tuple(sorted(engines, key=lambda engine: (rank.get(engine, len(rank)), engine)))
