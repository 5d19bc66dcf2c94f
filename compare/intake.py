"""Runs on their way into a comparison: which may enter, and what forbids to compare two engines."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field

from crossdem.adapters.case import Case
from crossdem.adapters.dataset import Dataset

Manifests = dict[tuple[str, int, int], dict]  # by engine, seed and twin


@dataclass
class Intake:
    """Lets the runs of one case pass, one by one, and keeps what pictures are drawn of."""

    case: Case
    seen: frozenset[tuple[str, int, int]]  # runs that are there already
    faults: list[str] = field(default_factory=list)  # of the runs that may not pass
    _kept: list[Dataset] = field(default_factory=list)

    def sound(self, datasets: Iterable[Dataset]) -> Iterator[Dataset]:
        """Those of them that belong here, each once."""
        wanted = self.case.run_hash
        for dataset in datasets:
            run = (dataset.engine, dataset.seed, dataset.twin)
            found = Case.from_resolved(dataset.case).run_hash
            if found != wanted:
                self.faults.append(
                    f"{run_name(run)}: run of another case ({found[:12]}; this one is {wanted[:12]})"
                )
            elif run in self.seen:
                self.faults.append(f"{run_name(run)}: given more than once")
            else:
                self.seen |= {run}
                if dataset.twin == 0:
                    self._kept.append(dataset)
                yield dataset

    def pictured(self, order: dict[str, int], others: Iterable[Dataset]) -> tuple[Dataset, ...]:
        """Twin 0 of each packing, `others` too, engines in this order."""
        runs = [*self._kept, *others]
        return tuple(sorted(runs, key=lambda run: (order[run.engine], run.seed)))


def run_name(run: tuple[str, int, int]) -> str:
    engine, seed, twin = run
    return f"{engine}, seed {seed}" + (f", twin {twin}" if twin else "")


def obstacles(
    engines: Sequence[str], manifests: Manifests, failures: dict[tuple[str, int], str]
) -> list[str]:
    """A line for everything that forbids to compare these engines with one another."""
    return [
        *missing_runs(engines, failures),
        *failed_gates(manifests, engines),
        *(
            line
            for pair in itertools.combinations(engines, 2)
            for line in other_packings(pair, manifests)
        ),
    ]


def failed_gates(manifests: Manifests, engines: Iterable[str]) -> list[str]:
    """A line for each gate that a run of these engines did not pass, in whichever twin."""
    return [
        f"{run_name(run)}: {gate['message']}"
        for run, manifest in manifests.items()
        if run[0] in engines
        for gate in manifest["gates"]
        if not gate["passed"]
    ]


def missing_runs(engines: Iterable[str], failures: dict[tuple[str, int], str]) -> list[str]:
    """A line for each packing that one of these engines has no result on: to leave out what failed would flatter it.

    A packing that an engine was never asked to run is no such thing: engines are compared on those that all of them have.
    """
    return [
        f"{engine}, seed {seed}: {why}"
        for (engine, seed), why in failures.items()
        if engine in engines
    ]


def other_packings(pair: tuple[str, str], manifests: Manifests) -> list[str]:
    """A line for each packing that is not the same for both engines."""
    first, second = pair
    packing = {run: manifest["packing_hash"] for run, manifest in manifests.items()}
    return [
        f"{run_name(run).removeprefix(f'{first}, ')}: {first} and {second} did not start from the same packing"
        for run, own in packing.items()
        if run[0] == first and packing.get((second, *run[1:]), own) != own
    ]
