"""Replay: the engines asked for run here, on the recorded packings; all other engines' runs come from the record."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from crossdem.adapters.case import Case
from crossdem.adapters.dataset import Dataset
from crossdem.adapters.gates import REFERENCE, with_contacts_gate
from crossdem.adapters.workspace import Workspace

from .ensemble import Ensemble
from .recorded import CONTACTS, Record, RecordError


def replayed(record: Record, engines: Sequence[str], seeds: int, twins: int) -> Ensemble:
    """The recorded runs of all other engines than `engines`, as far as seeds and twins are asked for.

    Raises RecordError where the record has fewer packings.
    """
    missing = [seed for seed in range(1, seeds + 1) if seed not in record.packings]
    if missing:
        has = f"{len(record.seeds)} packings, and not seed {missing[0]}"
        raise RecordError([f"the record has {has}: ask for fewer --seeds, or another --tier"])
    others = record.ensemble.selected(
        run
        for run in record.ensemble.manifests
        if run[0] not in engines and run[1] <= seeds and run[2] <= twins
    )
    if not engines and len(others.engines) < 2:
        raise RecordError(["only one engine is recorded: name others to run here with --engines"])
    return others


def restore_packings(case: Case, record: Record, seeds: int, workspace: Workspace) -> None:
    """So that runs start from the recorded packings to the last bit, whatever the solver here would have settled."""
    for seed in range(1, seeds + 1):
        record.restore(seed, workspace.packing_folder(case, seed))


def gated(datasets: Iterable[Dataset], others: Ensemble) -> Iterator[Dataset]:
    """The same runs, with their gates on contacts set by the recorded native run of their packing, where there is one."""
    contacts = {
        facts["packing_hash"]: facts[CONTACTS]
        for (engine, _, _), facts in others.manifests.items()
        if engine == REFERENCE
    }
    for dataset in datasets:
        known = contacts.get(dataset.manifest["packing_hash"])
        yield dataset if known is None else with_contacts_gate(dataset, known)
