"""Finished runs and their gates: those on contacts wait for the native run on the same bed.

A comparison sets these gates anew, among the runs that it has; here they are set for people, and for `crossdem explain`.
"""

from __future__ import annotations

from ..dataset import Dataset
from ..gates import REFERENCE, contacts_at_rest, with_gates
from ..one_run import Run


class Shelf:
    """Takes up runs that are there, best the native ones first. Holds no datasets: there may be hundreds."""

    def __init__(self):
        self._native_contacts: dict[tuple[str, str], int] = {}  # at the end of the rest, by bed
        self._waiting: list[Run] = []

    def take(self, run: Run) -> bool:
        """Whether the run is there, and whole."""
        dataset = run.finished()
        if not dataset:
            return False
        if run.engine.name == REFERENCE:
            self._native_contacts[bed(run)] = contacts_at_rest(dataset)
        if not self._set_gates(run, dataset):
            self._waiting.append(run)
        return True

    def close(self) -> None:
        """Set the gates for which a native run has come since. Where none has, a run keeps those it has."""
        for run in self._waiting:
            if bed(run) in self._native_contacts:
                self._set_gates(run, run.finished())

    def _set_gates(self, run: Run, dataset: Dataset) -> bool:
        native_contacts = self._native_contacts.get(bed(run))
        if native_contacts is None:
            return False
        gated = with_gates(dataset, native_contacts)
        if gated.manifest != dataset.manifest:
            gated.write_manifest(run.folder)
        return True


def bed(run: Run) -> tuple[str, str]:
    """What names the bed that a run loads: variants of a case share their packings, and rest differently."""
    return run.case.run_hash, run.request.packing.hash
