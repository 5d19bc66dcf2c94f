"""The ladder: each rung on made-up runs, proved to fail; and the command on a folder, with the native solver alone."""

import dataclasses
import json
import os
import shutil
from xml.etree import ElementTree

import numpy as np
import pandas as pd
import pytest
from command_line import ROOT, crossdem
from few_particles import Disc, few_particles
from rich.console import Console

from crossdem import ExitCode
from crossdem.adapters.dataset import Dataset, Motion
from crossdem.adapters.dataset_faults import MANIFEST_KEYS, RESISTANCE_COLUMNS, SCHEMA_VERSION
from crossdem.compare import answers, closed_forms, rungs
from crossdem.compare.answers import answer_faults
from crossdem.compare.ladder import Ladder, LadderCase
from crossdem.compare.ladder_report import ladder_junit, print_ladder, write_ladder
from crossdem.compare.refinement import extrapolated, observed_order
from crossdem.compare.rungs import AGREES, DIFFERS, NO_RESULT, NO_SUCH_LAW, NOT_COMPARABLE, Rung

MICRO = ROOT / "reference_cases" / "micro"
RESTITUTION = {
    "quantity": "restitution",
    "kind": "absolute",
    "tolerance": 2e-3,
    "reason": "the closed form of a linear spring and dashpot",
}
EXACT = closed_forms.restitution(
    closed_forms.damping_ratio(1530 * np.pi * 0.0025**2 * 0.01, 1000.0, 0.774)
)


@pytest.fixture
def case(tmp_path):
    """A disc that hits the floor in the air's absence, as a resolved case with one answer."""
    disc = Disc(0.01, 0.0025, velocity_y=-0.1)
    return few_particles([disc], tmp_path, "gravity_m_s2=0.0").resolved | {"answer": [RESTITUTION]}


def run_of(case, engine="native", speed_m_s=0.0, moved_m=0.0, floor_N=0.0):
    """A made-up run that ends with this speed upwards, its disc `moved_m` off in every frame from 0.05 s on."""
    frames, samples = 11, 101
    time_s = np.linspace(0, 0.1, frames)
    still = np.zeros((frames, 1))
    position_m = np.tile([0.01, 0.0025], (frames, 1, 1))
    position_m[time_s >= 0.05, 0, 0] += moved_m
    velocity = np.zeros((frames, 1, 2))
    velocity[-1, 0, 1] = speed_m_s
    table = pd.DataFrame(0.0, index=range(samples), columns=RESISTANCE_COLUMNS)
    table["time_s"] = np.linspace(0, 0.1, samples)
    table["floor_force_y_N"] = floor_N
    manifest = dict.fromkeys(MANIFEST_KEYS, "made up")
    manifest |= {"schema_version": SCHEMA_VERSION, "engine": engine, "time_step_s": 1e-4}
    manifest |= {"particles": 1, "frames": frames, "samples": samples, "seed": 1, "twin": 0}
    manifest |= {"command": [], "wall_s": 1.0, "cpu_s": 1.0, "limitations": [], "gates": []}
    motion = Motion(time_s, position_m, velocity, still, None, None)
    return Dataset(case, manifest, np.array([0.0025]), motion, table)


def restitution_of(case, *ratios, engine="native", entry=RESTITUTION):
    runs = [run_of(case, engine, 0.1 * ratio) for ratio in ratios]
    return rungs.answer_rung(case, engine, entry, runs)


def ladder_of(*found, engines=("native", "yade")):
    steps = dict.fromkeys(engines, 1e-4)
    shown = LadderCase("few_particles", "A title <b>", "0" * 64, steps)
    return Ladder("micro", (shown,), engines, {"native": "solver 1"}, tuple(found), 12.3)


# Refinement


def test_errors_of_first_and_second_order_vanish_from_the_limit():
    values = [3 + 5 * dt - 7 * dt**2 for dt in (0.1, 0.05, 0.025)]
    assert extrapolated(values) == pytest.approx(3, abs=1e-13)


@pytest.mark.parametrize("order", [1, 2, 0.5])
def test_the_observed_order_is_that_of_the_error(order):
    values = [1 + dt**order for dt in (0.1, 0.05, 0.025)]
    assert observed_order(values) == pytest.approx(order)


@pytest.mark.parametrize("values", [(1, 1, 1), (1, 2, 3), (1, 2, 1.5), (1, 1 + 1e-15, 1)])
def test_values_that_do_not_close_in_have_no_order(values):
    assert observed_order(values) is None


# Twins


def twin_of(case, moved_m, engine="liggghts", forces=None):
    run = run_of(case, engine, moved_m=moved_m)
    return rungs.twin_rung(case, engine, "its twin", run, run_of(case).motion, forces)


def test_an_engine_must_be_its_twin_to_the_last_bit(case):
    assert twin_of(case, 0.0).outcome == AGREES
    one_bit = twin_of(case, 1.8e-18)
    assert one_bit.outcome == DIFFERS and one_bit.difference_m > 0
    assert one_bit.time_s == pytest.approx(0.05) and "1.73e-18 m" in one_bit.sentence


def test_where_nothing_is_known_of_any_case_the_ladder_says_so(case):
    only_twins = ladder_of(twin_of(case, 0.0))
    assert only_twins.word == "AGREES" and "No case has an [[answer]]" in only_twins.sentence
    asked = ladder_of(twin_of(case, 0.0), restitution_of(case, 0.7, 0.7, 0.7))
    assert "No case has an [[answer]]" not in asked.sentence


def test_a_limit_of_the_case_holds_for_its_engine_and_as_long_as_it_says(case):
    loose = {"engine": "liggghts", "limit_m": 1e-12, "until_s": 0.1, "reason": "summation order"}
    assert twin_of(case | {"twin": [loose]}, 1e-13).outcome == AGREES
    assert twin_of(case | {"twin": [loose]}, 1e-11).outcome == DIFFERS
    assert twin_of(case | {"twin": [loose]}, 1e-13, engine="yade").outcome == DIFFERS
    early = loose | {"until_s": 0.04}
    assert twin_of(case | {"twin": [early]}, 1e-3).outcome == AGREES


def test_the_native_solver_is_held_against_the_transcription_in_motion_and_force(case):
    forces = run_of(case).resistance
    assert twin_of(case, 9e-12, "native", forces).outcome == AGREES
    assert twin_of(case, 2e-11, "native", forces).outcome == DIFFERS
    for wrong_N, outcome in ((0.9e-8, AGREES), (1.1e-8, DIFFERS)):
        pulled = run_of(case, floor_N=wrong_N).resistance
        found = twin_of(case, 0.0, "native", pulled)
        assert found.outcome == outcome and found.difference_N == pytest.approx(wrong_N)


# Closed forms


def test_a_quantity_must_tend_to_its_closed_form(case):
    errors = [0.04, 0.02, 0.01]
    found = restitution_of(case, *[EXACT + error for error in errors])
    assert found.outcome == AGREES
    assert found.order == pytest.approx(1, abs=1e-6)
    assert found.errors == pytest.approx(errors) and abs(found.error) < 1e-12


def test_a_wrong_limit_differs_however_well_it_converges(case):
    found = restitution_of(case, *[EXACT + 0.0021 + error for error in (0.04, 0.02, 0.01)])
    assert found.outcome == DIFFERS and found.order == pytest.approx(1, abs=1e-6)
    assert "0.0457, exact 0.0436, allowed ± 0.00200" in found.sentence


def test_a_wrong_closed_form_differs(case, monkeypatch):
    wrong = dataclasses.replace(answers.ANSWERS["restitution"], exact=lambda start, law: 0.5)
    monkeypatch.setitem(answers.ANSWERS, "restitution", wrong)
    assert restitution_of(case, EXACT, EXACT, EXACT).outcome == DIFFERS


def test_a_result_that_is_no_number_differs(case):
    found = rungs.answer_rung(case, "native", RESTITUTION, [run_of(case, speed_m_s=1e308)] * 3)
    assert found.outcome == DIFFERS and not np.isfinite(found.limit)


def test_the_exact_value_is_that_of_the_engines_law(case):
    clipped = closed_forms.restitution_clipped(0.7061)
    assert restitution_of(case, *[clipped] * 3, engine="yade").outcome == AGREES
    assert restitution_of(case, *[clipped] * 3, engine="liggghts").outcome == DIFFERS


def test_an_invariant_holds_at_every_time_step(case):
    entry = {"quantity": "momentum_change", "kind": "absolute", "tolerance": 1e-3, "reason": "-"}
    runs = [run_of(case, speed_m_s=-0.1 + wrong) for wrong in (0.02, 0.01, 0.005)]
    assert rungs.answer_rung(case, "native", entry, runs).outcome == DIFFERS
    kept = [run_of(case, speed_m_s=-0.1)] * 3
    assert rungs.answer_rung(case, "native", entry, kept).outcome == AGREES


def test_an_expected_difference_must_be_there_and_no_larger(case):
    expected = {
        "engine": "native",
        "quantity": "restitution_at_step",
        "value": 0.31,
        "tolerance": 0.01,
        "reason": "the averaged displacement",
    }
    entry = RESTITUTION | {"quantity": "restitution_at_step"}
    known = case | {"difference": [expected]}
    assert restitution_of(known, EXACT + 0.315, entry=entry).outcome == AGREES
    vanished = restitution_of(known, EXACT, entry=entry)
    assert vanished.outcome == DIFFERS and "has vanished" in vanished.sentence
    assert restitution_of(known, EXACT + 0.33, entry=entry).outcome == DIFFERS
    assert restitution_of(known, EXACT, entry=entry, engine="liggghts").outcome == AGREES


def test_an_impact_that_never_ends_has_no_exact_value(case):
    entry = RESTITUTION | {"quantity": "rebound_over_impact_speed"}
    found = restitution_of(case | {"gravity_m_s2": 1e6}, 0, 0, 0, entry=entry)
    assert found.outcome == NOT_COMPARABLE and "do not part" in found.sentence


def test_a_quantity_without_a_value_is_no_agreement(folder, tmp_path):
    ended = check(folder, tmp_path / "out", "--engines", "native", "--set", "gravity_m_s2=0.0")
    assert ended.returncode == ExitCode.DIFFERS, ended.stderr
    assert "rest_on_floor, native, closed form, floor / weight: no value" in ended.stdout


# Cases


def test_an_answer_that_cannot_be_had_of_a_case_is_a_fault(case):
    assert answer_faults(case) == []
    unknown = case | {"answer": [RESTITUTION | {"quantity": "restitutoin"}]}
    [line] = answer_faults(unknown)
    assert line.startswith("answer[0].quantity: unknown") and "mean 'restitution'" in line
    many = case | {"particle": 3 * case["particle"]}
    assert answer_faults(many) == [
        "answer[0].quantity: restitution is known of 1 to 2 given [[particle]] tables only"
    ]
    no_bar = case | {"difference": [{"quantity": "bar_side_force_N"}]}
    assert answer_faults(no_bar) == [
        "difference[0].quantity: bar_side_force_N is asked of a case with a bar"
    ]


def test_every_answer_says_what_it_is_and_is_asked_somewhere():
    text = "".join(path.read_text() for path in MICRO.glob("*.toml"))
    for name, answer in answers.ANSWERS.items():
        assert len(answer.definition) > 20
        assert f'"{name}"' in text, f"no case asks for {name}"


# Verdict and report


def test_a_difference_weighs_more_than_a_missing_engine_and_that_more_than_an_open_rung(case):
    good = restitution_of(case, EXACT, EXACT, EXACT)
    bad = restitution_of(case, 0.5, 0.5, 0.5)
    missing = Rung("few_particles", "yade", rungs.TWIN, "its twin", NO_RESULT, "not installed")
    unlike = dataclasses.replace(missing, outcome=NOT_COMPARABLE)
    assert ladder_of(good).exit_code == ExitCode.AGREES
    assert ladder_of(good, bad, missing).exit_code == ExitCode.DIFFERS
    assert ladder_of(good, missing, unlike).exit_code == ExitCode.ENGINE_FAILED
    assert ladder_of(good, unlike).exit_code == ExitCode.INCONCLUSIVE
    assert ladder_of().exit_code == ExitCode.INCONCLUSIVE
    sentence = ladder_of(good, bad).sentence
    assert sentence.startswith("few_particles, native, closed form, restitution: 0.5")


def test_an_engine_may_lack_the_law_of_a_case_but_not_of_all_it_is_asked_for(case):
    good = restitution_of(case, EXACT, EXACT, EXACT)
    held = dataclasses.replace(good, engine="yade")
    lacking = Rung("a_joint", "yade", rungs.TWIN, "its twin", NO_SUCH_LAW, "not comparable: why")
    found = ladder_of(good, held, lacking)
    assert found.exit_code == ExitCode.AGREES
    assert "every one of 2 rungs" in found.sentence
    assert found.sentence.endswith(" Not comparable: yade on a_joint.")
    assert ladder_of(good, lacking).exit_code == ExitCode.INCONCLUSIVE
    assert "not comparable: why" in ladder_of(good, lacking).sentence
    assert ladder_of(lacking).exit_code == ExitCode.INCONCLUSIVE
    bad = restitution_of(case, 0.5, 0.5, 0.5)
    assert ladder_of(bad, held, lacking).exit_code == ExitCode.DIFFERS


def test_what_an_engine_does_not_offer_is_said_once_and_is_no_agreement(folder, tmp_path):
    case = folder / "rolling_resistance.toml"
    shutil.copy(MICRO / case.name, case)
    ended = check(case, tmp_path / "out", "--engines", "native,yade")
    assert ended.returncode == ExitCode.INCONCLUSIVE, ended.stderr
    said = "rolling_resistance, yade: not comparable: yade: contact.particle_wall.rolling_friction"
    assert ended.stdout.count(said) == 1
    tests = ElementTree.parse(tmp_path / "out" / "junit.xml").findall(".//testcase")
    skipped = [test for test in tests if test.find("skipped") is not None]
    assert {test.get("classname") for test in skipped} == {"rolling_resistance.yade"}


def test_the_report_is_whole_and_names_every_rung(case, tmp_path):
    found = (
        twin_of(case, 1e-3),
        restitution_of(case, 0.5, 0.5, 0.5),
        Rung("few_particles", "yade", rungs.TWIN, "its twin", NO_RESULT, "not <installed>"),
    )
    ladder = ladder_of(*found, engines=("native", "liggghts", "yade"))
    page = write_ladder(ladder, tmp_path / "new")
    assert {path.name for path in page.parent.iterdir()} == {
        "ladder.html",
        "ladder.json",
        "junit.xml",
    }
    html = page.read_text()
    assert "A title &lt;b&gt;" in html and "not &lt;installed&gt;" in html and "<script" not in html
    written = json.loads((page.parent / "ladder.json").read_text())
    assert written["verdict"]["exit_code"] == 1
    assert [rung["outcome"] for rung in written["rungs"]] == [DIFFERS, DIFFERS, NO_RESULT]
    suites = ElementTree.fromstring(ladder_junit(ladder))
    ends = [[test.tag for test in case_] for case_ in suites.iter("testcase")]
    assert ends == [["failure"], ["failure"], ["failure"], ["error"]]


@pytest.mark.parametrize("width, refined", [(170, True), (100, False)])
def test_the_table_fits_its_terminal_and_failures_are_told_in_full(case, tmp_path, width, refined):
    with open(tmp_path / "said", "w") as file:
        console = Console(file=file, width=width)
        print_ladder(ladder_of(restitution_of(case, 0.5, 0.5, 0.5)), tmp_path, console)
    said = (tmp_path / "said").read_text()
    assert ("\u0394t/4" in said) == refined
    assert "\N{HORIZONTAL ELLIPSIS}" not in said
    assert "few_particles, native, closed form, restitution: 0.5000, exact 0.0436" in said


# The command


@pytest.fixture
def folder(tmp_path):
    """A folder of two cases that take no time."""
    chosen = tmp_path / "chosen"
    chosen.mkdir()
    for name in ("free_fall", "rest_on_floor"):
        shutil.copyfile(MICRO / f"{name}.toml", chosen / f"{name}.toml")
    return chosen


def check(folder, out, *options, **environment):
    return crossdem("check", folder, "--out", out, *options, **environment)


def test_a_folder_is_checked_rung_by_rung_and_a_second_time_without_a_run(folder, tmp_path):
    ended = check(folder, tmp_path / "out", "--engines", "native")
    assert ended.returncode == 0, ended.stdout + ended.stderr
    assert "every one of 6 rungs on 2 cases holds" in ended.stdout
    again = check(folder, tmp_path / "out", "--engines", "native")
    assert again.returncode == 0 and "6 of these were there already" in again.stdout


def test_what_does_not_come_to_rest_in_time_exits_1_and_names_the_rung(folder, tmp_path):
    short = ["--set", "time.penetration_s=0.002"]
    ended = check(folder, tmp_path / "out", "--engines", "native", *short)
    assert ended.returncode == ExitCode.DIFFERS
    assert "rest_on_floor, native, closed form, floor / weight" in ended.stdout


def test_a_missing_engine_is_no_agreement(folder, tmp_path):
    tools = tmp_path / "tools"
    tools.mkdir()
    for name in ("dirname", "readlink"):
        (tools / name).symlink_to(f"/usr/bin/{name}")
    ended = check(folder, tmp_path / "out", "--engines", "native,liggghts", PATH=str(tools))
    assert ended.returncode == ExitCode.ENGINE_FAILED
    assert "free_fall, liggghts, twin" in ended.stdout and "not installed" in ended.stdout


def test_a_failing_engine_is_no_agreement(folder, tmp_path):
    tools = tmp_path / "tools"
    tools.mkdir()
    fake = tools / "liggghts"
    fake.write_text(
        '#!/bin/sh\n[ "$3" = -h ] && echo "Version 3.8.0, made up)" && exit 1\nexit 7\n'
    )
    fake.chmod(0o755)
    path = f"{tools}:{os.environ['PATH']}"
    ended = check(folder, tmp_path / "out", "--engines", "native,liggghts", PATH=path)
    assert ended.returncode == ExitCode.ENGINE_FAILED, ended.stdout + ended.stderr
    assert "liggghts ended with status 7" in ended.stdout


def test_all_faults_of_all_cases_are_told_and_nothing_is_written(folder, tmp_path):
    for name, old, new in (
        ("free_fall", "fall_m", "fall_km"),
        ("rest_on_floor", "density_kg_m3", "density"),
    ):
        path = folder / f"{name}.toml"
        path.write_text(path.read_text().replace(old, new))
    ended = check(folder, tmp_path / "out")
    assert ended.returncode == ExitCode.BAD_INPUT
    assert "unknown answer 'fall_km'" in ended.stderr and "density" in ended.stderr
    assert not (tmp_path / "out").exists()


def test_a_folder_without_cases_and_two_cases_of_one_name_are_bad_input(folder, tmp_path):
    (tmp_path / "empty").mkdir()
    ended = check(tmp_path / "empty", tmp_path / "out")
    assert ended.returncode == ExitCode.BAD_INPUT and "holds no case" in ended.stderr
    shutil.copyfile(folder / "free_fall.toml", folder / "another.toml")
    ended = check(folder, tmp_path / "out")
    assert ended.returncode == ExitCode.BAD_INPUT and "'free_fall' too" in ended.stderr
