"""Whether a recorded run comes out again: to the last bit, or as another twin of its packing would.

A run that starts 1e-12 m away soon has other last bits, and in the end other values; so does the same run under another
C library. Then each endpoint is held against the twins recorded on the same packing: by the t-statistic of a new value,
whose scatter from twin to twin is that of all recorded packings together, and Holm over the endpoints.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
from scipy import stats
from statsmodels.stats.multitest import multipletests

from crossdem.adapters.dataset import Dataset
from crossdem.adapters.gates import REFERENCE
from crossdem.adapters.machine import machine_facts
from crossdem.adapters.packing import Packing, make_twin

from .ensemble import Ensemble
from .fingerprint import content_sha256
from .recorded import CONTENT, Record

Run = tuple[str, int, int]  # engine, seed, twin

LEVEL = 0.001  # of "it does not come out again": so seldom does an unchanged engine fail


def packing_of(record: Record, run: Run, folder: Path) -> Packing:
    """What a recorded `run` started from, made in `folder`."""
    _, seed, twin = run
    packing = record.restore(seed, folder / f"seed{seed}")
    return make_twin(packing, twin, folder / f"seed{seed}-twin{twin}")


def same_program(record: Record, run: Run, dataset: Dataset) -> bool:
    """Whether `dataset` was made here by what `run` was made by, so that it must be the same to the last bit.

    The native solver computes the same bits on every machine.
    """
    if run[0] == REFERENCE:
        return True
    recorded = record.ensemble.manifests[run]
    version = recorded["engine_version"] == dataset.manifest["engine_version"]
    # A run that does not tell its machine was made on that which wrote the record, as far as anybody knows.
    return version and recorded.get("machine", record.about["machine"]) == machine_facts()


def difference(record: Record, run: Run, dataset: Dataset) -> str | None:
    """What is not reproduced of `run` by `dataset`, for people; None: nothing."""
    recorded = record.ensemble.manifests[run]
    if dataset.manifest["packing_hash"] != recorded["packing_hash"]:
        return "it did not start from the recorded packing"
    if same_program(record, run, dataset):
        same = content_sha256(dataset) == recorded[CONTENT]
        return None if same else "its bits are not those recorded"
    p = strangeness(record.ensemble.endpoints, run, Ensemble.of([dataset]).endpoints.iloc[0])
    strange = p[p <= LEVEL]
    said = (f"{name} (p = {value:.1e})" for name, value in strange.items())
    return f"beyond the scatter of the recorded twins: {', '.join(said)}" if len(strange) else None


def strangeness(endpoints: pd.DataFrame, run: Run, values: pd.Series) -> pd.Series:
    """p, after Holm, of each of the `values` as one more twin on the packing of `run`; 1 where nothing tells.

    `endpoints` are the recorded ones, indexed by engine, seed and twin.
    """
    engine, seed, _ = run
    mine = endpoints.loc[engine]
    packings = mine.groupby(level="seed")
    inner = mine - packings.transform("mean")
    freedom = len(mine) - packings.ngroups
    if freedom < 1:
        return pd.Series(1.0, index=values.index)
    scatter = np.sqrt((inner**2).sum() / freedom)
    twins = mine.loc[seed]
    with np.errstate(all="ignore"):  # a value that never scatters must be met
        t = (values - twins.mean()).abs() / (scatter * np.sqrt(1 + 1 / len(twins)))
    p = pd.Series(2 * stats.t.sf(t, freedom), index=t.index).fillna(1.0)
    return pd.Series(multipletests(p, method="holm")[1], index=p.index)
