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
from crossdem.adapters.case import CaseError, load_case
from crossdem.adapters.engines import get_engine
from crossdem.adapters.packing import make_packing, make_twin
from crossdem.adapters.workspace import Workspace
from crossdem.compare import (
    horizon_report,
    horizon_runs,
    horizon_tables,
    report,
    summary,
    twin_schemes,
    verdict,
)
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
QUIET = Console(quiet=True)


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
BLIND = EngineHorizon("liggghts", obstacle="<b>[red]cannot</b>")


def test_the_rate_of_an_exponential_is_its_rate():
    assert exponential().rate_1_s == pytest.approx(RATE_1_S)


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


def test_the_comparison_ends_when_the_native_schemes_twin_is_noticed():
    """A difference counts only as long as chaos alone has not made one of that size; and then it does."""
    run, native = moved(np.full((91, 2), 1e-6))
    early = dataclasses.replace(exponential(), drift_m=exponential().drift_m * 500)
    for usual, until_s in ((exponential(), 0.1), (early, math.log(2) / RATE_1_S)):
        compared = closeness(run, native, "yade", usual)
        assert compared.until_s == pytest.approx(until_s)
        assert compared.beyond_s == 0
        assert EngineHorizon("yade", exponential(), compared).outcome == "differs"


def test_an_unstable_engine_cannot_shorten_its_own_examination():
    """Its twin is noticed at once, that of its native scheme after 0.23 s: it differs."""
    wild = exponential(rate_1_s=10 * RATE_1_S)
    one = EngineHorizon("yade", wild, close(), scheme_growth=exponential())
    assert one.outcome == "differs"
    assert "0.023 s" in one.stray and "0.23 s" in one.stray and "less stable" in one.stray
    calm = EngineHorizon("yade", wild, close(), scheme_growth=exponential(rate_1_s=0.0))
    assert "not before 1 s" in calm.stray
    usual = exponential(rate_1_s=1.5 * RATE_1_S)
    assert EngineHorizon("yade", usual, close(), scheme_growth=exponential()).outcome == "agrees"


def test_a_window_without_frames_is_no_agreement():
    """The frame at t = 0 is the packing, which is given."""
    one = EngineHorizon("yade", exponential(), close(until_s=0.005))
    assert (one.closeness.frames, one.outcome, one.stray) == (0, "not comparable", None)
    assert found(one).exit_code == ExitCode.INCONCLUSIVE
    said = horizon_tables.sentence(found(one))
    assert "no frame" in said and "bit by bit" not in said
    assert close(until_s=0.015).frames == 1


@pytest.mark.parametrize(
    "engines, code",
    (
        ([NATIVE], ExitCode.AGREES),
        ([NATIVE, AGREEING], ExitCode.AGREES),
        ([NATIVE, STRAYING], ExitCode.DIFFERS),
        ([NATIVE, AGREEING, BLIND], ExitCode.INCONCLUSIVE),
        ([dataclasses.replace(BLIND, engine="native")], ExitCode.INCONCLUSIVE),
        ([AGREEING, dataclasses.replace(BLIND, failed=True)], ExitCode.ENGINE_FAILED),
        ([STRAYING, dataclasses.replace(BLIND, failed=True)], ExitCode.DIFFERS),
    ),
)
def test_an_engine_that_was_not_compared_is_no_agreement(engines, code):
    assert found(*engines).exit_code == code


def test_engines_of_different_windows_are_told_by_the_shorter_one():
    other = EngineHorizon("liggghts", exponential(), close(2e-15, until_s=0.05))
    said = horizon_tables.sentence(found(NATIVE, other, AGREEING))
    assert said.startswith("On the packing of seed 1, ") and "until 0.05 s each of liggghts" in said


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
        assert "differs" in text and "0.56 s" in text and "30 /s" in text
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
    facts = {"engine_version": "4.2", "time_step_s": 5e-5, "packing_hash": "ab" * 32}
    facts |= {"run": "yade from the twin", "run_key": "cd" * 32}
    horizon = dataclasses.replace(found(NATIVE, BLIND, AGREEING), runs=(facts,))
    page = horizon_report.write_horizon(synthetic.case(), horizon, tmp_path)
    parsed = Page(page.read_text(encoding="utf-8"))
    assert not {"script", "img", "link", "a"} & set(parsed.tags)
    assert "<b>[red]cannot</b>" in parsed.text and parsed.tags.count("svg") == 2
    for fact in ("4.2", "5e\N{MINUS SIGN}05 s", "abababababab", "yade from the twin"):
        assert fact in parsed.text
    assert json.loads((tmp_path / "horizon.json").read_text())["runs"] == [facts]
    names = {path.name for path in tmp_path.iterdir()}
    assert names == {"horizon.html", "horizon.png", "horizon.csv", "horizon.json"}
    horizon_report.print_horizon(horizon, page, Console(width=120))
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


@pytest.mark.parametrize("interval_s", (0.001, 0.007, 0.025, 0.05))
def test_there_are_frames_before_the_end_of_the_comparison(interval_s):
    case = small_case(
        f"time.sample_interval_s={interval_s}",
        f"time.frame_interval_s={interval_s}",
        f"time.penetration_s={4 * interval_s}",
    )
    start = horizon_runs.from_packing(case)
    time = start.resolved["time"]
    assert time["frame_interval_s"] <= min(0.1, time["penetration_s"]) / 5 * (1 + 1e-9)
    for engine in ("native", "liggghts", "yade"):
        steps = time["frame_interval_s"] / get_engine(engine).step_s(start)
        assert steps == pytest.approx(round(steps), abs=1e-6)


def test_the_twin_is_the_packing_with_one_particle_in_its_middle_shifted(case, tmp_path):
    workspace = Workspace(tmp_path / "out")
    packing = make_packing(case, 1, workspace.packing_folder(case, 1))
    twin = make_twin(packing, 1, workspace.twin_folder(packing, 1))
    aside = twin.particles - packing.particles
    [moved_one] = np.flatnonzero(aside["x_m"])
    assert aside["x_m"][moved_one] == pytest.approx(1e-12, rel=1e-3)
    assert not aside.drop(columns="x_m").to_numpy().any()
    assert packing.particles["x_m"][moved_one] == pytest.approx(0.02, abs=0.005)
    assert twin.hash != packing.hash and (twin.seed, twin.twin) == (packing.seed, 1)


def test_particles_placed_by_hand_need_no_bar_and_no_bed_but_may_not_settle_under_a_bar(tmp_path):
    micro = synthetic.REFERENCE_CASE.parent / "micro"
    workspace = Workspace(tmp_path / "out")
    case = load_case(micro / "head_on_pair.toml")
    horizon = horizon_runs.find_horizon(case, ["native"], 1, workspace, 1, QUIET)
    assert horizon.engines[0].growth is not None and horizon.exit_code == ExitCode.AGREES
    with pytest.raises(CaseError, match="bar_into_24.toml: time.rest_s: .* without rest"):
        settling = load_case(micro / "bar_into_24.toml")
        horizon_runs.find_horizon(settling, ["native"], 1, workspace, 1, QUIET)


class Finished:
    """A run that left this dataset."""

    failure = None

    def __init__(self, dataset):
        self.dataset = lambda: dataset


class Lost:
    """A run that left nothing."""

    failure = "ended with status 1; see engine.log"


def test_a_native_scheme_that_fails_is_named_and_costs_no_growth():
    own = [Finished(dataset) for dataset in moved(np.full((91, 2), 1e-12))]
    one = horizon_runs._measured("yade", own, (Lost, Lost))
    assert one.outcome == "failed" and one.growth is not None
    assert one.obstacle == f"its native scheme: {Lost.failure}"
    [row] = horizon_tables.rows(found(one))
    assert row.outcome == "failed" and row.horizon == "later than 1 s"


def test_an_engine_without_a_native_twin_keeps_its_growth(case, tmp_path, monkeypatch):
    """The native solver stands for that engine."""

    def refused(start, engine):
        raise CaseError(["time.step_s: too large"])

    monkeypatch.setattr(horizon_runs, "has_twin", lambda engine: True)
    monkeypatch.setattr(twin_schemes, "native_twin", refused)
    horizon = horizon_runs.find_horizon(case, ["native"], 1, Workspace(tmp_path / "out"), 1, QUIET)
    [one] = horizon.engines
    assert one.growth is not None and (one.outcome, one.failed) == ("not comparable", False)
    assert one.obstacle == "no native twin: time.step_s: too large"
    assert [run["run"] for run in horizon.runs] == ["native", "native from the twin"]


@pytest.mark.parametrize("error", (CaseError(["at fault"]), RuntimeError("at fault")))
def test_nothing_that_happens_here_costs_a_check_its_report(case, error, tmp_path, monkeypatch):
    def broken(*arguments):
        raise error

    monkeypatch.setattr(horizon_runs, "find_horizon", broken)
    failures = {("liggghts", 1): "ended with status 1"}
    horizon = horizon_runs.horizon_of_runs(case, ["yade", "liggghts"], failures, None, 1, QUIET)
    skipped, lost = horizon.engines
    assert (skipped.engine, skipped.failed) == ("liggghts", False)
    assert skipped.obstacle == "seed 1 has no result: ended with status 1"
    assert "at fault" in lost.obstacle and lost.failed == isinstance(error, RuntimeError)
    made = compare_runs(*runs(), failures, horizon=horizon)
    html = report.write_report(made, tmp_path).read_text(encoding="utf-8")
    assert "at fault" in html and "makes them" not in html


def test_a_folder_with_runs_is_not_discarded(tmp_path):
    for name, kept in (("empty", False), ("used", True)):
        workspace = Workspace(tmp_path / name)
        (workspace.root / "packings").mkdir()
        if kept:
            (workspace.root / "variants").mkdir()
        workspace.discard_if_new()
        assert (tmp_path / name / "packings").exists() == kept
