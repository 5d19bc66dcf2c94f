"""Replay: the engines asked for run here, on the recorded packings; all other engines' runs come from the record."""

from __future__ import annotations

from collections.abc import Sequence

from crossdem.adapters.case import Case
from crossdem.adapters.workspace import Workspace

from .recorded import Record, RecordError
from .wording import listed, packings


def said_of(others: Record) -> str:
    """What of a comparison is recorded, for people."""
    ensemble = others.ensemble
    counted = packings(len({seed for _, seed, _ in ensemble.manifests}), ensemble.runs_each)
    return f"from {others.source}: {counted} of {listed(ensemble.engines)}"


def replayed(record: Record, engines: Sequence[str], seeds: int | None, twins: int) -> Record:
    """The recorded runs of all other engines than `engines`, as far as seeds (None: all) and twins are asked for.

    Raises RecordError where the record has fewer packings, or leaves nothing to compare.
    """
    seeds = seeds or max(record.seeds)
    missing = [seed for seed in range(1, seeds + 1) if seed not in record.packings]
    if missing:
        has = f"{len(record.seeds)} packings, and not seed {missing[0]}"
        raise RecordError([f"{record.source} has {has}: ask for fewer --seeds, or another --tier"])
    others = record.selected(
        run
        for run in record.ensemble.manifests
        if run[0] not in engines and run[1] <= seeds and run[2] <= twins
    )
    if len({*engines, *others.ensemble.engines}) < 2:
        has = listed(record.ensemble.engines)
        raise RecordError(
            [
                f"{record.source} holds runs of this case by {has} alone: name another engine to run here, with --engines"
            ]
        )
    return others


def restore_packings(case: Case, record: Record, seeds: int, workspace: Workspace) -> None:
    """So that runs start from the recorded packings to the last bit, whatever the solver here would have settled."""
    for seed in range(1, seeds + 1):
        record.restore(seed, workspace.packing_folder(case, seed))
