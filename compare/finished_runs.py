"""Runs that are there, in their folders: what a judge reads of them, and the packings that they started from."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

from crossdem.adapters.dataset import Dataset
from crossdem.adapters.packing import Packing

from .ensemble import Ensemble
from .fingerprint import content_sha256
from .recorded import CONTENT


def read_runs(folders: Sequence[Path]) -> tuple[Ensemble, dict[int, Packing]]:
    """The ensemble of the runs in `folders`, in the order of engines, seeds and twins, and the packing of each seed.

    Its manifests hold CONTENT. Each dataset is read once and not kept. Raises DatasetError, PackingError.
    """
    facts: dict[tuple[str, int, int], dict] = {}
    packings: dict[int, Packing] = {}

    def read() -> Iterator[Dataset]:
        for folder in folders:
            dataset = Dataset.read(folder)
            facts[dataset.engine, dataset.seed, dataset.twin] = {CONTENT: content_sha256(dataset)}
            if dataset.twin == 0:
                packings[dataset.seed] = Packing.read(folder / "inputs")
            yield dataset

    ensemble = Ensemble.of(read())
    manifests = {run: manifest | facts[run] for run, manifest in ensemble.manifests.items()}
    in_order = sorted(manifests, key=lambda run: (ensemble.engines.index(run[0]), *run[1:]))
    ensemble = Ensemble(ensemble.endpoints, ensemble.profiles, ensemble.fields, manifests)
    return ensemble.selected(in_order), dict(sorted(packings.items()))


def packing_files(packings: Mapping[int, Packing]) -> tuple[dict[int, str], dict[int, dict]]:
    """By seed, packing.csv to the byte, and what packing.json says."""
    tables = {
        seed: (packing.folder / "packing.csv").read_bytes().decode()
        for seed, packing in packings.items()
    }
    about = {
        seed: json.loads((packing.folder / "packing.json").read_bytes())
        for seed, packing in packings.items()
    }
    return tables, about
