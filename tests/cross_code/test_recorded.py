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


def test_recorded_runs_come_out_again(recorded, tmp_path):
    draw = int(os.environ.get("CROSSDEM_DRAW", random.SystemRandom().randrange(10**6)))
    chosen = _drawn(recorded, random.Random(draw))
    names = [f"{_variant(made)} {'-'.join(map(str, run))}" for made, run in chosen]
    print(f"CROSSDEM_DRAW={draw}: {', '.join(names)}")
    requests = [
        (RunRequest(made.case, packing_of(made, run, tmp_path / _variant(made)), run[0]), tmp_path)
        for made, run in chosen
    ]
    results = run_ensemble(requests, tmp_path / "workflow", len(os.sched_getaffinity(0)))
    for name, (made, run), result in zip(names, chosen, results):
        assert not result.failure, (name, result.failure)
        found = difference(made, run, Dataset.read(result.dataset_folder))
        assert not found, f"CROSSDEM_DRAW={draw}: {name}: {found}"


def _drawn(recorded, draw):
    """A native run of the case, one of a variant, and one of another engine that is here, whichever takes longer."""
    others = [made for made in map(Record.read, variants()) if _variant(made) != _variant(recorded)]
    engines = [name for name in recorded.ensemble.engines if name != REFERENCE and _here(name)]
    wanted = [(recorded, REFERENCE), (draw.choice(others), REFERENCE)]
    wanted += [(recorded, draw.choice(engines))] if engines else []
    return [
        (made, draw.choice([run for run in made.ensemble.manifests if run[0] == engine]))
        for made, engine in wanted
    ]


def _variant(made):
    return ",".join(made.about["case"]["changes"]) or "default"


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
