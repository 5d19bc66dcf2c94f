"""The horizon: growth on curves whose answer is known, the comparison before it, and what check makes of both."""

import dataclasses
import json
import math
from xml.etree import ElementTree

import numpy as np
import pytest
import synthetic
from rich.console import Console
from test_report import Page

from crossdem import ExitCode
from crossdem.adapters.case import load_case
from crossdem.adapters.packing import make_packing
from crossdem.adapters.workspace import Workspace
from crossdem.compare import horizon_report, horizon_runs, horizon_tables, report, summary, verdict
from crossdem.compare.comparison import compare_runs
from crossdem.compare.horizon import (
    LIMIT_M,
    Closeness,
    EngineHorizon,
    Growth,
    Horizon,
    closeness,
    crossing_s,
    drift_m,
    growth,
)
from small_case import small_case

TIME_S = np.linspace(0, 1, 101)
RATE_1_S = 30.0
RADIUS_M = 0.002


def exponential(rate_1_s=RATE_1_S):
    """A drift from 1e-12 m at t = 0 on, saturated at a millimetre."""
    return Growth(TIME_S, np.minimum(1e-12 * np.exp(rate_1_s * TIME_S), 1e-3), 0.01 * RADIUS_M)


def close(difference_m=0.0, from_s=0.0, until_s=0.1):
    return Closeness("yade", TIME_S, np.where(TIME_S >= from_s, difference_m, 0.0), until_s)


def found(*engines):
    return Horizon(1, 1.0, engines)


AGREEING = EngineHorizon("yade", exponential(), close(3e-15))
STRAYING = EngineHorizon("yade", exponential(), close(2e-7, from_s=0.045))
NATIVE = EngineHorizon("native", exponential())


def test_the_rate_of_an_exponential_is_its_rate():
    rate, error = exponential().rate_1_s
    assert rate == pytest.approx(RATE_1_S) and error == pytest.approx(0, abs=1e-6)


def test_noise_on_the_curve_shows_as_the_rates_error():
    noise = np.exp(np.random.default_rng(1).normal(size=TIME_S.size))
    noisy = Growth(TIME_S, exponential().drift_m * noise, 2e-5)
    rate, error = noisy.rate_1_s
    assert abs(rate - RATE_1_S) < 3 * error < 10


def test_the_times_of_an_exponential_are_where_its_formula_has_them():
    assert exponential().noticed_s == pytest.approx(math.log(1e3) / RATE_1_S)
    assert exponential().horizon_s == pytest.approx(math.log(2e7) / RATE_1_S)


def test_what_does_not_grow_has_no_horizon_and_no_rate():
    calm = exponential(rate_1_s=0.0)
    assert calm.noticed_s is calm.horizon_s is calm.rate_1_s is None


def test_a_crossing_from_equal_bits_lies_at_the_frame():
    assert crossing_s(np.array([0.0, 0.1, 0.2]), np.array([0.0, 0.0, 1e-3]), 1e-9) == 0.2


def moved(offset_m):
    """A bed of two particles, and the same with the second one off by `offset_m` (F, 2)."""
    particles = {**synthetic.case().resolved["particles"], "count": 2}
    run_case = synthetic.case(particles=particles)
    place_m = np.tile([[0.02, 0.02], [0.1, 0.03]], (91, 1, 1))
    tips_m = 0.1 - 0.01 * np.linspace(0, 9, 91)
    runs = []
    for aside_m in (np.zeros((91, 2)), offset_m):
        positions_m = place_m.copy()
        positions_m[:, 1] += aside_m
        runs.append(synthetic.bed_of(run_case, positions_m, np.full(2, RADIUS_M), tips_m))
    return runs


def test_the_drift_is_the_largest_distance_of_any_particle():
    offset_m = np.zeros((91, 2))
    offset_m[5] = 3e-4, 4e-4
    drift = drift_m(*moved(offset_m))
    assert drift[5] == pytest.approx(5e-4) and drift[4] == drift[6] == 0
    assert growth(*moved(offset_m)).lost_m == pytest.approx(0.01 * RADIUS_M)


def test_the_comparison_ends_when_the_twin_is_noticed():
    """A difference counts only as long as chaos alone has not made one of that size."""
    run, native = moved(np.full((91, 2), 1e-6))
    early = dataclasses.replace(exponential(), drift_m=exponential().drift_m * 500)
    assert closeness(run, native, "yade", exponential()).until_s == pytest.approx(0.1)
    assert closeness(run, native, "yade", early).until_s == pytest.approx(math.log(2) / RATE_1_S)


def test_only_a_difference_before_the_end_of_the_comparison_counts():
    assert close(1e-6, from_s=0.11).beyond_s is None
    assert close(1e-6, from_s=0.11).largest_m == 0
    assert close(0.99 * LIMIT_M).beyond_s is None
    assert close(1.01 * LIMIT_M, from_s=0.05).beyond_s == pytest.approx(0.05)


def test_a_stray_names_engine_time_and_numbers():
    assert found(NATIVE, AGREEING).strays == []
    [said] = found(NATIVE, STRAYING).strays
    for part in (
        "yade leaves the native scheme 'yade'",
        "t = 0.05 s",
        "2e\N{MINUS SIGN}7 m",
        "1e\N{MINUS SIGN}9 m",
    ):
        assert part in said


def runs():
    case = synthetic.case()
    return case, [synthetic.dataset(case, engine) for engine in ("native", "yade")]


def test_a_difference_before_the_horizon_is_a_difference_whatever_the_statistics_say():
    said = compare_runs(*runs(), horizon=found(NATIVE, STRAYING)).verdict
    assert (said.word, said.exit_code) == (verdict.DIFFERS, ExitCode.DIFFERS)
    assert said.sentence.startswith("yade leaves") and "micro" in said.next_step
    assert compare_runs(*runs(), horizon=found(NATIVE, AGREEING)).verdict.word == verdict.CONSISTENT


def test_a_failed_run_from_the_packing_is_a_failure_and_an_unsupported_one_is_not():
    def said(failed):
        lost = EngineHorizon("yade", obstacle="yade ended with status 1", failed=failed)
        return compare_runs(*runs(), horizon=found(NATIVE, lost)).verdict

    assert said(failed=True).word == verdict.ENGINE_FAILED
    assert "from the packing: yade ended with status 1" in said(failed=True).sentence
    assert said(failed=False).word == verdict.CONSISTENT


def test_the_report_says_numbers_horizon_and_outcome_everywhere(tmp_path):
    comparison = compare_runs(*runs(), horizon=found(NATIVE, STRAYING))
    page = report.write_report(comparison, tmp_path)
    html = page.read_text(encoding="utf-8")
    markdown = (tmp_path / "report.md").read_text(encoding="utf-8")
    for text in (Page(html).text.replace("\xa0", " "), markdown):
        assert "Particle by particle, up to the horizon" in text
        assert "differs" in text and "0.56 s" in text and "30 ± " in text
    assert html.index('id="horizon"') < html.index('id="gates"')
    record = json.loads((tmp_path / "report.json").read_text())["horizon"]
    assert record["engines"][1]["beyond_limit_s"] == pytest.approx(0.05)
    suites = {s.get("name"): s for s in ElementTree.parse(tmp_path / "junit.xml").getroot()}
    assert suites["particle by particle"].get("failures") == "1"


def test_the_terminal_says_it_beside_the_verdict(capsys):
    horizon = found(NATIVE, AGREEING)
    summary.print_summary(compare_runs(*runs(), horizon=horizon), console=Console(width=200))
    assert horizon_tables.sentence(horizon) in capsys.readouterr().out


def test_a_report_of_datasets_says_why_it_has_no_such_comparison(tmp_path):
    html = report.write_report(compare_runs(*runs()), tmp_path).read_text(encoding="utf-8")
    assert "it takes runs from the packing" in html
    assert json.loads((tmp_path / "report.json").read_text())["horizon"] is None


def test_page_files_and_terminal(tmp_path, capsys):
    blind = EngineHorizon("liggghts", obstacle="<b>[red]cannot</b>")
    page = horizon_report.write_horizon(synthetic.case(), found(NATIVE, blind, AGREEING), tmp_path)
    parsed = Page(page.read_text(encoding="utf-8"))
    assert not {"script", "img", "link", "a"} & set(parsed.tags)
    assert "<b>[red]cannot</b>" in parsed.text and parsed.tags.count("svg") == 2
    names = {path.name for path in tmp_path.iterdir()}
    assert names == {"horizon.html", "horizon.png", "horizon.csv", "horizon.json"}
    horizon_report.print_horizon(found(NATIVE, blind, AGREEING), page, Console(width=120))
    shown = capsys.readouterr().out
    assert "3e\N{MINUS SIGN}15 m" in shown and "[red]cannot" in shown and str(page) in shown


def test_bits_that_are_equal_are_called_that():
    same = EngineHorizon("yade", exponential(), close(0.0))
    assert "0 m, bit by bit" in horizon_tables.sentence(found(same))


def test_the_runs_start_from_the_packing_and_are_short():
    start = horizon_runs.from_packing(load_case(synthetic.REFERENCE_CASE)).resolved["time"]
    assert (start["rest_s"], start["penetration_s"], start["frame_interval_s"]) == (0, 1.0, 0.01)
    short = horizon_runs.from_packing(small_case("time.penetration_s=0.06")).resolved["time"]
    assert short["penetration_s"] == pytest.approx(0.06)


def test_the_twin_is_the_packing_with_one_particle_in_its_middle_shifted(case, tmp_path):
    workspace = Workspace(tmp_path / "out")
    packing = make_packing(case, 1, workspace.packing_folder(case, 1))
    twin = horizon_runs.shifted(packing, workspace)
    aside = twin.particles - packing.particles
    [moved_one] = np.flatnonzero(aside["x_m"])
    assert aside["x_m"][moved_one] == pytest.approx(1e-12, rel=1e-3)
    assert not aside.drop(columns="x_m").to_numpy().any()
    assert packing.particles["x_m"][moved_one] == pytest.approx(0.02, abs=0.005)
    assert twin.hash != packing.hash and twin.seed == packing.seed
