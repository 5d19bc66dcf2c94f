"""Calibration: what is known of a judge comes out, and a judge that errs is told."""

import math

import numpy as np
import pandas as pd
import pytest
from recorded_runs import record
from scipy import stats
from synthetic import MEAN_RESISTANCE, case

from crossdem import ExitCode
from crossdem.compare import calibration, calibration_command
from crossdem.compare import calibration_tables as tables
from crossdem.compare.calibration import HALVES, TRUE_SHIFT, Design, Rate, calibrate, dealt, shifted
from crossdem.compare.calibration_command import calibrate_case, calibrated
from crossdem.compare.checks import DIFFERENT, EQUIVALENT, INCONCLUSIVE, Check, evaluate
from crossdem.compare.quantities import QUANTITIES

SCATTER_N = 0.03  # of a run about the mean of its packing
KINDS = [
    MEAN_RESISTANCE,
    MEAN_RESISTANCE | {"quantity": "surface_heave_m", "kind": "absolute", "margin": 0.1},
    MEAN_RESISTANCE
    | {"quantity": "fluctuation_N", "kind": "ratio", "margin": 1.33, "seed_scatter": 1.1},
]


def runs_of(packings, twins=8, seed=1):
    """Normal truth: packings scatter by 0.1 about 1, the runs of one by SCATTER_N; by seed and twin."""
    random = np.random.default_rng(seed)
    index = pd.MultiIndex.from_product(
        [range(1, packings + 1), range(twins)], names=["seed", "twin"]
    )
    names = list(QUANTITIES)
    beds = np.repeat(1 + 0.1 * random.normal(size=(packings, len(names))), twins, axis=0)
    runs = beds + SCATTER_N * random.normal(size=(packings * twins, len(names)))
    return pd.DataFrame(runs, index=index, columns=names)


def checks_of(*entries):
    return Check.of_case({"check": list(entries)})


def test_a_split_deals_each_packings_twins_into_halves_that_share_no_run():
    runs = pd.DataFrame({"value": 2.0 ** np.arange(48)}, index=runs_of(6).index)
    splits = dealt(runs, Design(4, 3), 50)
    beds = set()
    for means in splits.tables:
        halves = [set(means.loc[half].index) for half in HALVES]
        assert halves[0] == halves[1] and len(halves[0]) == 4
        beds |= halves[0]
        for seed in halves[0]:
            used = sum(round(3 * means.loc[(half, seed), "value"]) for half in HALVES)
            assert (
                used.bit_count() == 6 and used >> (8 * (seed - 1)) < 256
            )  # six runs, all of this packing
    assert beds == set(range(1, 7)) and set(splits.signs) == {-1, 1}


def test_runs_that_cannot_be_dealt_are_not():
    assert dealt(runs_of(15), Design(16, 1), 20) is None
    assert dealt(runs_of(16, twins=5), Design(16, 3), 20) is None
    assert dealt(runs_of(16, twins=6), Design(16, 3), 20)


@pytest.mark.parametrize("entry", KINDS, ids=lambda entry: entry["kind"])
def test_a_shift_is_one_on_the_scale_of_the_check(entry):
    (check,) = checks_of(entry)
    values = np.array([0.8, 1.0, 1.3])
    for shift in (0.15, -0.3):
        difference = check.differences(shifted(check, values, shift), values)
        assert difference.mean() == pytest.approx(shift)


def test_normal_truth_gives_the_rates_of_the_textbook():
    """One absolute check, 16 of very many packings, so that splits hardly overlap."""
    (check,) = checks_of(KINDS[1] | {"margin": 0.03})
    runs, design = runs_of(600, twins=2), Design(16, 1)
    found = calibrate([check], runs, design, dealt(runs, design, 300))
    (endpoint,) = found.endpoints
    noncentrality = 0.03 / (math.sqrt(2) * SCATTER_N) * math.sqrt(16)
    power = 1 - 2 * stats.nct.cdf(stats.t.ppf(0.95, 15), 15, noncentrality)
    assert endpoint.at(0.0).equivalent.share == pytest.approx(power, abs=0.07)
    assert endpoint.at(1.0).equivalent.share == pytest.approx(0.05, abs=0.035)
    assert endpoint.at(1.0).different.share == pytest.approx(0.05, abs=0.035)
    assert endpoint.at(TRUE_SHIFT).equivalent.share < 0.02
    # by the same test, with the distance from the margin as what is to be seen
    seen = 0.03 * (endpoint.detectable - 1) / (math.sqrt(2) * SCATTER_N) * math.sqrt(16)
    assert 1 - stats.nct.cdf(stats.t.ppf(0.95, 15), 15, seen) == pytest.approx(0.83, abs=0.08)


def test_what_is_implied_is_what_the_judge_would_have_said(monkeypatch):
    checks, runs, design = checks_of(*KINDS), runs_of(32), Design(16, 1)
    splits = dealt(runs, design, 12)
    implied = calibrate(checks, runs, design, splits)
    monkeypatch.setattr(calibration, "_implied", lambda outcomes, shift: None)
    assert calibrate(checks, runs, design, splits) == implied


def test_the_numbers_do_not_depend_on_how_many_processes_compute_them():
    checks, runs, designs = checks_of(*KINDS[:2]), runs_of(20), [Design(4, 1)]
    assert calibrated(checks, runs, 20, 1, designs) == calibrated(checks, runs, 20, 2, designs)


def says(outcome):
    """A judge that says the same of everything."""

    def judge(checks, pair, endpoints):
        return [type("Result", (), {"outcome": outcome}) for _ in checks]

    return judge


@pytest.mark.parametrize(
    "outcome, told",
    [
        (DIFFERENT, "end with DIFFERENT"),
        (DIFFERENT, "never EQUIVALENT"),
        (EQUIVALENT, "passes for EQUIVALENT"),
        (EQUIVALENT, "not DIFFERENT in 80 % at any true shift up to 5 margins"),
        (INCONCLUSIVE, "never EQUIVALENT"),
        (INCONCLUSIVE, "not DIFFERENT in 80 % at any true shift up to 5 margins"),
    ],
)
def test_a_judge_that_says_the_same_of_everything_misses_its_target(outcome, told):
    checks, runs, design = checks_of(MEAN_RESISTANCE), runs_of(20), Design(16, 1)
    found = calibrate(checks, runs, design, dealt(runs, design, 20), judge=says(outcome))
    assert [line for line in tables.misses([found]) if told in line]


def test_a_judge_that_takes_one_half_for_both_is_told():
    """It compares a half with itself, so that no shift reaches it."""

    def judge(checks, pair, endpoints):
        half = endpoints.loc[[pair[0]]]
        other = half.rename(index={pair[0]: pair[1]}, level="engine")
        return evaluate(checks, pair, pd.concat([half, other]))

    checks, runs, design = checks_of(MEAN_RESISTANCE), runs_of(20), Design(16, 1)
    found = calibrate(checks, runs, design, dealt(runs, design, 20), judge=judge)
    assert found.endpoints[0].detectable is None
    assert [line for line in tables.misses([found]) if "passes for EQUIVALENT" in line]


def test_few_packings_that_decide_nothing_miss_no_target():
    checks, runs, design = checks_of(MEAN_RESISTANCE), runs_of(20), Design(4, 1)
    found = calibrate(checks, runs, design, dealt(runs, design, 20), judge=says(INCONCLUSIVE))
    assert not tables.misses([found])


def test_none_of_200_is_a_rate_of_at_most_2_percent():
    rate = Rate(0, 200)
    assert rate.share == 0 and rate.interval[1] == pytest.approx(0.0188, abs=2e-4)


@pytest.fixture(scope="module")
def eight_twins():
    return record(engines=("native",), seeds=2, twins=7)


def test_too_few_recorded_runs_end_with_4(eight_twins, tmp_path):
    assert calibrate_case(case(), eight_twins, 20, tmp_path, 1) == ExitCode.INCONCLUSIVE


def test_the_page_the_picture_and_the_tables_are_written(
    eight_twins, tmp_path, monkeypatch, capsys
):
    monkeypatch.setattr(calibration_command, "DESIGNS", (Design(6, 1), Design(6, 2)))
    monkeypatch.setattr(calibration_command, "of_engine", lambda *_: runs_of(12))
    ended = calibrate_case(case(), eight_twins, 20, tmp_path / "calibrate", 1)
    assert ended == ExitCode.AGREES
    names = sorted(path.name for path in (tmp_path / "calibrate").iterdir())
    assert names == ["calibrate.csv", "calibrate.html", "calibrate.json", "calibrate.png"]
    page = (tmp_path / "calibrate" / "calibrate.html").read_text(encoding="utf-8")
    assert "random state 20000" in page and "6 x 2" in page
    assert "20000" in capsys.readouterr().out
    rows = pd.read_csv(tmp_path / "calibrate" / "calibrate.csv")
    assert (rows["different"] <= rows["splits"]).all() and {0.0, TRUE_SHIFT} <= set(
        rows["shift_margins"]
    )


def test_a_missed_target_ends_with_1(eight_twins, tmp_path, monkeypatch):
    monkeypatch.setattr(calibration_command, "DESIGNS", (Design(6, 1),))
    monkeypatch.setattr(calibration_command, "of_engine", lambda *_: runs_of(12))
    monkeypatch.setattr(
        calibration_command,
        "calibrate",
        lambda *arguments: calibrate(*arguments[:4], judge=says(EQUIVALENT)),
    )
    assert calibrate_case(case(), eight_twins, 20, tmp_path, 1) == ExitCode.DIFFERS


def test_the_table_counts_splits():
    checks, runs, design = checks_of(MEAN_RESISTANCE), runs_of(20), Design(16, 1)
    found = calibrate(checks, runs, design, dealt(runs, design, 20))
    (check,) = tables.record([found], 20)["designs"][0]["checks"]
    at_margin = found.endpoints[0].at(1.0)
    assert check["equivalent_at_margin"]["events"] == at_margin.equivalent.events
    assert check["different_at_margin"]["events"] == at_margin.different.events
    (row,) = tables.endpoint_rows([found])
    assert dict(zip(tables.ENDPOINT_TITLES, row))["EQUIVALENT at the margin"] == tables.rate(
        at_margin.equivalent
    )
    rows = tables.table([found])
    assert (rows["splits"] == 20).all() and rows["shift_margins"].is_monotonic_increasing
