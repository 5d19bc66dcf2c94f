"""The committed record of the paper's case is whole, and its runs come out again: a few of them, drawn at random.

CROSSDEM_DRAW=NUMBER repeats a draw; each prints its own.
"""

import json
import os
import random
from pathlib import Path

import pytest

from crossdem.adapters.case import load_case
from crossdem.adapters.dataset import Dataset
from crossdem.adapters.engine import EngineNotFound
from crossdem.adapters.engines import get_engine
from crossdem.adapters.gates import REFERENCE
from crossdem.adapters.run_folder import RunRequest
from crossdem.adapters.workflow.ensemble import run_ensemble
from crossdem.compare.calibration_command import DESIGNS, calibrated
from crossdem.compare.calibration_tables import misses, record
from crossdem.compare.checks import Check
from crossdem.compare.ensemble import of_engine
from crossdem.compare.recorded import SUMS, Record, find_record
from crossdem.compare.reproduced import difference, packing_of

ROOT = Path(__file__).parents[2]
CASE = ROOT / "reference_cases" / "bar_penetration.toml"
EXPECTED = ROOT / "reference_cases" / "expected"
CALIBRATION = EXPECTED / "bar_penetration" / "calibration.json"
NATIVE_RUNS = 2  # run again
MOST_BYTES = 10_000_000  # of all records


@pytest.fixture(scope="module")
def case():
    return load_case(CASE)


@pytest.fixture(scope="module")
def recorded(case):
    return find_record(case, EXPECTED)


def variants():
    return sorted(path.parent for path in EXPECTED.glob(f"*/*/{SUMS}"))


def test_every_record_is_whole_and_all_are_small():
    for folder in variants():
        assert Record.read(folder).seeds
    assert sum(path.stat().st_size for path in EXPECTED.rglob("*") if path.is_file()) < MOST_BYTES


def test_the_records_are_of_the_case_as_it_stands():
    for folder in variants():
        made = Record.read(folder)
        now = load_case(CASE, made.about["case"]["changes"])
        assert now.run_hash == made.case.run_hash, folder


def test_the_judge_is_as_good_as_its_calibration_says(case, recorded):
    committed = json.loads(CALIBRATION.read_text(encoding="utf-8"), parse_float=_rounded)
    runs = of_engine(recorded.ensemble.endpoints, REFERENCE)
    found = calibrated(Check.of_case(case.resolved), runs, committed["splits"], None, DESIGNS)
    text = json.dumps(record(found, committed["splits"]))
    assert json.loads(text, parse_float=_rounded)["designs"] == committed["designs"]
    assert not misses(found)


def test_recorded_runs_come_out_again(case, recorded, tmp_path):
    draw = int(os.environ.get("CROSSDEM_DRAW", random.SystemRandom().randrange(10**6)))
    runs = _drawn(recorded, random.Random(draw))
    print(f"CROSSDEM_DRAW={draw}: {', '.join('-'.join(map(str, run)) for run in runs)}")
    requests = [
        (RunRequest(case, packing_of(recorded, run, tmp_path / "packings"), run[0]), tmp_path)
        for run in runs
    ]
    results = run_ensemble(requests, tmp_path / "workflow", len(os.sched_getaffinity(0)))
    for run, result in zip(runs, results):
        assert not result.failure, (run, result.failure)
        found = difference(recorded, run, Dataset.read(result.dataset_folder))
        assert not found, f"CROSSDEM_DRAW={draw}: {run}: {found}"


def _drawn(recorded, draw):
    """A few native runs, and one of another engine that is here: the longer one takes, the more seldom."""
    by_engine = {}
    for run, about in recorded.ensemble.manifests.items():
        by_engine.setdefault(run[0], []).append((run, about["cpu_s"]))
    others = [
        entry
        for name in by_engine
        if name != REFERENCE and _here(name)
        for entry in by_engine[name]
    ]
    runs = draw.sample([run for run, _ in by_engine[REFERENCE]], NATIVE_RUNS)
    if others:
        weights = [1 / cpu_s**2 for _, cpu_s in others]
        runs += [draw.choices([run for run, _ in others], weights)[0]]
    return runs


def _rounded(number):
    """Counts are compared exactly, what is computed from them to the digits that libraries agree on."""
    return round(float(number), 9)


def _here(engine):
    try:
        get_engine(engine).version()
    except EngineNotFound:
        if os.environ.get("CI"):
            raise
        return False
    return True
