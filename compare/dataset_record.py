"""The runs of a package, for comparisons with it."""

from __future__ import annotations

from pathlib import Path

import pandas as pd

from crossdem.adapters.case import Case

from .dataset_verify import faults_of_package
from .ensemble import Ensemble
from .finished_runs import packing_files, read_runs
from .recorded import DATE, Record, RecordError


def read_package(folder: Path, case: Case) -> Record:
    """The runs of a package as a record of `case`. Raises RecordError when it is damaged, or of another case."""
    if faults := faults_of_package(folder):
        raise RecordError(
            [f"{folder}: not as it was built; fetch it anew", *(f"  {fault}" for fault in faults)]
        )
    packaged = Case.from_canonical((folder / "case.json").read_bytes())
    if packaged.run_hash != case.run_hash:
        raise RecordError(
            [
                f"{folder}: holds runs of another case, {packaged.name}: runs depend on every value but title and checks. "
                f"Use {folder / 'case.json'}, or build a package of this one"
            ]
        )
    runs = pd.read_csv(folder / "tables" / "runs.csv")
    folders = {(run.engine, run.seed, run.twin): folder / run.folder for run in runs.itertuples()}
    ensemble, packings = read_runs(list(folders.values()))
    manifests = {
        run: about | {DATE: about["started_utc"]} for run, about in ensemble.manifests.items()
    }
    ensemble = Ensemble(ensemble.endpoints, ensemble.profiles, ensemble.fields, manifests)
    return Record(
        packaged,
        ensemble,
        *packing_files(packings),
        about={},
        source=f"the package {folder}",
        folders=folders,
    )
