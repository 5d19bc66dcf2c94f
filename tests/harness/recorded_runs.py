"""A made-up record: synthetic runs on packings of a few discs."""

import hashlib

import pandas as pd
from synthetic import case, dataset

from crossdem.adapters.machine import machine_facts
from crossdem.adapters.packing import COLUMNS
from crossdem.compare.ensemble import Ensemble
from crossdem.compare.fingerprint import content_sha256
from crossdem.compare.recorded import CONTENT, DATE, Record


def packing_text(seed):
    """packing.csv of three discs at places with long digits."""
    rows = [
        (i, 0.02 + 0.01 * i + seed / 7000, 0.002 + seed / 9e5, 0.002, 0, 0, 0) for i in range(3)
    ]
    return pd.DataFrame(rows, columns=list(COLUMNS)).to_csv(index=False)


def packing_hash(seed):
    return hashlib.sha256(packing_text(seed).encode()).hexdigest()


def recorded_datasets(run_case, engines=("native", "liggghts"), seeds=2, twins=1):
    for engine in engines:
        for seed in range(1, seeds + 1):
            for twin in range(twins + 1):
                factor = 1 + 0.01 * twin + 0.02 * len(engine) / 7
                yield dataset(
                    run_case,
                    engine,
                    seed,
                    twin,
                    factor=factor,
                    noise=0.1,
                    packing_hash=packing_hash(seed),
                )


def record(run_case=None, **which):
    run_case = run_case or case()
    runs = list(recorded_datasets(run_case, **which))
    facts = {(run.engine, run.seed, run.twin): {CONTENT: content_sha256(run)} for run in runs}
    ensemble = Ensemble.of(runs)
    manifests = {run: about | facts[run] for run, about in ensemble.manifests.items()}
    seeds = sorted({run.seed for run in runs})
    about = {"particles": 3, "bar_tip_m": 0.0123456789012345, "contacts": 2}
    return Record(
        run_case,
        Ensemble(ensemble.endpoints, ensemble.profiles, ensemble.fields, manifests),
        {seed: packing_text(seed) for seed in seeds},
        {seed: about | {"seed": seed} for seed in seeds},
        {DATE: "2026-01-02T03:04:05+00:00", "schema_version": 1, "machine": machine_facts()},
    )
