"""Replay: recorded runs take part in a comparison as if they had been made here, and it is said that they were not."""

import json

import pytest
from recorded_runs import packing_hash, record
from synthetic import REFERENCE_CASE, dataset

from crossdem import ExitCode
from crossdem.adapters.case import load_case
from crossdem.adapters.workspace import Workspace
from crossdem.compare.cli import main
from crossdem.compare.comparison import compare_runs
from crossdem.compare.recorded import RecordError
from crossdem.compare.replay import replayed, restore_packings


@pytest.fixture(scope="module")
def recorded():
    return record(load_case(REFERENCE_CASE))


@pytest.fixture(scope="module")
def records(recorded, tmp_path_factory):
    folder = tmp_path_factory.mktemp("records")
    recorded.write(folder / "bar_penetration" / "default")
    return folder


def replay(records, out, *options):
    arguments = ["check", str(REFERENCE_CASE), "--replay", "--record", str(records)]
    return main([*arguments, "--out", str(out), *options])


def test_recorded_engines_are_compared_where_there_is_none(records, tmp_path, monkeypatch):
    monkeypatch.setenv("PATH", str(tmp_path))
    ended = replay(records, tmp_path / "out", "--engines", "none")
    report = json.loads((tmp_path / "out" / "report.json").read_text())
    assert ended == report["verdict"]["exit_code"]
    assert {run["engine"] for run in report["runs"]} == {"native", "liggghts"}
    assert report["checks"] and not (tmp_path / "out" / "runs").exists()
    page = (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    assert "recorded 2026-01-02: liggghts 1.0" in page


def test_the_engines_asked_for_are_not_taken_from_the_record(recorded):
    assert replayed(recorded, ["native"], 2, 1).ensemble.engines == ("liggghts",)
    assert replayed(recorded, ["yade"], 2, 1).ensemble.engines == ("native", "liggghts")


def test_packings_and_twins_are_those_asked_for(recorded):
    assert set(replayed(recorded, [], 1, 0).ensemble.manifests) == {
        ("native", 1, 0),
        ("liggghts", 1, 0),
    }


def test_more_packings_than_recorded_are_refused_with_their_number(records, tmp_path, capsys):
    assert replay(records, tmp_path / "out", "--seeds", "16") == ExitCode.BAD_INPUT
    assert "2 packings, and not seed 3" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("engines", [[], ["native"]], ids=["none", "native"])
def test_one_engine_that_is_recorded_and_run_alone_is_no_comparison(engines):
    with pytest.raises(
        RecordError, match="runs of this case by native alone: name another engine to run here"
    ):
        replayed(record(engines=("native",)), engines, 2, 1)


def test_one_recorded_engine_is_compared_with_one_that_is_run():
    assert replayed(record(engines=("native",)), ["yade"], 2, 1).ensemble.engines == ("native",)


def test_of_recorded_runs_alone_all_packings_are_compared_unless_it_is_said(
    records, tmp_path, capsys
):
    for options, counted in (((), "2 packings"), (("--seeds", "1"), "1 packing")):
        replay(records, tmp_path / counted, "--engines", "none", *options)
        said = capsys.readouterr().out
        assert said.startswith(f"from the record: {counted} of native and liggghts\n")


def test_a_tier_says_how_many_packings_of_the_record_are_asked_for(records, tmp_path, capsys):
    ended = replay(records, tmp_path / "out", "--engines", "none", "--tier", "smoke")
    assert ended == ExitCode.BAD_INPUT and "not seed 3" in capsys.readouterr().err


def test_a_case_of_other_runs_is_refused(records, tmp_path, capsys):
    changed = ("--set", "gravity_m_s2=1.62")
    assert replay(records, tmp_path / "out", *changed) == ExitCode.BAD_INPUT
    assert "crossdem record" in capsys.readouterr().err


def test_a_record_that_nothing_would_read_is_refused(records, tmp_path, capsys):
    words = ["check", str(REFERENCE_CASE), "--record", str(records)]
    assert main([*words, "--out", str(tmp_path / "out")]) == ExitCode.BAD_INPUT
    said = capsys.readouterr().err
    assert "'--record': is read with --replay alone; results go to --out" in said


def test_no_letter_stands_for_the_record_as_it_would_be_taken_for_the_output(capsys):
    words = ["check", str(REFERENCE_CASE), "--replay", "-o", "here"]
    assert main(words) == ExitCode.BAD_INPUT
    assert "No such option: -o" in capsys.readouterr().err


def test_a_report_of_more_runs_is_not_replaced_in_silence(records, tmp_path, capsys):
    def said(*options):
        replay(records, tmp_path / "out", "--engines", "none", *options)
        return " ".join(capsys.readouterr().out.split())

    assert "replaces" not in said("--twins", "1")
    lesser = said("--seeds", "1")
    assert "It replaces one of 2 packings × 2 runs of native and liggghts, whose runs" in lesser
    assert "replaces" not in said("--seeds", "1") + said()
    (tmp_path / "out" / "report.json").write_text("torn")
    assert "replaces" not in said("--seeds", "1")


def test_another_margin_needs_no_other_record(records, tmp_path):
    changed = ("--set", "title=Mine", "--engines", "none")
    ended = replay(records, tmp_path / "out", *changed)
    report = json.loads((tmp_path / "out" / "report.json").read_text())
    assert (ended, report["case"]["title"]) == (report["verdict"]["exit_code"], "Mine")


def test_what_was_changed_is_said_before_the_verdict(records, tmp_path, capsys):
    changed = ("--set", "title='<b>Mine'", "--set", "check=[]", "--engines", "none")
    replay(records, tmp_path / "out", *changed)
    out = tmp_path / "out"
    page, markdown = ((out / f"report.{end}").read_text("utf-8") for end in ("html", "md"))
    changes = "title=&#39;&lt;b&gt;Mine&#39;</code>, <code>check=[]</code>"
    assert page.index(changes) < page.index('<div class="verdict')
    assert "The case with title=&#39;&lt;b&gt;Mine&#39;, check=\\[\\]" in markdown
    assert "The case with title='<b>Mine', check=[]:" in capsys.readouterr().out
    assert json.loads((out / "report.json").read_text())["case"]["changes"] == list(changed[1:4:2])
    replay(records, tmp_path / "out", "--engines", "none")
    assert "The case with" not in (out / "report.html").read_text("utf-8")


def test_runs_made_here_start_from_the_recorded_packings(recorded, tmp_path):
    workspace = Workspace(tmp_path / "out")
    restore_packings(recorded.case, recorded, 2, workspace)
    for seed in (1, 2):
        text = (workspace.packing_folder(recorded.case, seed) / "packing.csv").read_bytes()
        assert text == recorded.packings[seed].encode()


def test_a_recorded_native_run_sets_the_gate_on_contacts_of_a_run_made_here(recorded):
    others = replayed(recorded, ["liggghts"], 1, 0)
    here = dataset(recorded.case, "liggghts", packing_hash=packing_hash(1))
    here.resistance["contacts"] = 1600  # of 1700 in the native run
    comparison = compare_runs(recorded.case, [here], recorded=others)
    assert "1600 contacts, 1700 in the native run" in failed_contacts(comparison)["liggghts", 1, 0]


def test_a_native_run_made_here_sets_the_gate_on_contacts_of_recorded_runs(recorded):
    """Whatever the native run said that they were recorded beside."""
    others = replayed(recorded, ["native"], 2, 0)
    here = [dataset(recorded.case, seed=seed, packing_hash=packing_hash(seed)) for seed in (1, 2)]
    here[1].resistance["contacts"] = 1600
    for about in others.ensemble.manifests.values():
        passed = {"name": "contacts_share", "value": 0, "limit": 0.01, "passed": True}
        about["gates"] = [*about["gates"], passed | {"message": "as recorded"}]
    comparison = compare_runs(recorded.case, here, recorded=others)
    failed = failed_contacts(comparison)
    assert failed.keys() == {("liggghts", 2, 0)}
    assert "1700 contacts, 1600 in the native run" in failed["liggghts", 2, 0]
    assert comparison.verdict.exit_code == ExitCode.INCONCLUSIVE


def failed_contacts(comparison):
    """By run, what its gate on contacts says, of which each run has one."""
    gates = {
        run: [gate for gate in about["gates"] if gate["name"] == "contacts_share"]
        for run, about in comparison.ensemble.manifests.items()
    }
    return {run: gate["message"] for run, [gate] in gates.items() if not gate["passed"]}


def test_a_run_made_here_is_judged_against_recorded_ones(recorded):
    others = replayed(recorded, ["native"], 2, 0)
    here = [dataset(recorded.case, seed=seed, packing_hash=packing_hash(seed)) for seed in (1, 2)]
    comparison = compare_runs(recorded.case, here, recorded=others)
    assert comparison.engines == ("native", "liggghts")
    assert comparison.results and not any(result.obstacles for result in comparison.results)
    assert comparison.recorded == {("liggghts", 1, 0), ("liggghts", 2, 0)}
