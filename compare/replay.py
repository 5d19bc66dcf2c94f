"""Replay: the engines asked for run here, on the recorded packings; all other engines' runs come from the record."""

from __future__ import annotations

from collections.abc import Sequence

from crossdem.adapters.case import Case
from crossdem.adapters.workspace import Workspace

from .ensemble import Ensemble
from .recorded import Record, RecordError


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
