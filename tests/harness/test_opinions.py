"""The opinions in the report: each part is there when it can be told, says when it cannot, and changes no verdict."""

import json

import pytest
import synthetic
from test_report import HOSTILE, Page

from crossdem import ExitCode
from crossdem.compare import opinion_tables, report
from crossdem.compare.checks import EQUIVALENT, NOT_COMPARABLE
from crossdem.compare.comparison import compare_runs

HEADINGS = (
    "Whole curves",
    "Displacement fields compared",
    "Each code against the others",
    "Theory",
)
FACTORS = {"native": 1.0, "liggghts": 1.03, "yade": 1.0}
PACKINGS = 8


def compared(engines=tuple(FACTORS), packings=PACKINGS, title="A title"):
    """liggghts has 3 % more resistance than the others, far within the margin of 10 %, and hardly any scatter."""
    run_case = synthetic.case(title=title)
    runs = (
        synthetic.dataset(run_case, engine, seed, factor=FACTORS[engine], noise=0.02)
        for engine in engines
        for seed in range(1, packings + 1)
    )
    return compare_runs(run_case, runs)


@pytest.fixture(scope="module")
def three():
    return compared(title=HOSTILE)


@pytest.fixture(scope="module")
def written(three, tmp_path_factory):
    return report.write_report(three, tmp_path_factory.mktemp("report")).parent


def test_a_significant_difference_within_the_margin_changes_no_verdict(three):
    one = next(one for one in three.opinions.curves if one.pair == ("liggghts", "native"))
    assert one.p < 0.05 and one.table["differs"].any() and not one.table["beyond"].any()
    assert three.opinions.margin.quantity.name == "mean_resistance_N"
    middle = one.table.loc[one.table["differs"]].iloc[0]
    assert middle["margin_N"] == pytest.approx(0.10 * 1.015 * 16.0 * middle.name, rel=0.1)
    assert three.verdict.exit_code == ExitCode.AGREES


def test_the_page_has_every_part_and_says_that_none_is_of_the_verdict(written):
    html = (written / "report.html").read_text(encoding="utf-8")
    markdown = (written / "report.md").read_text(encoding="utf-8")
    places = [html.index(f"<h2>{heading}</h2>") for heading in ("Checks", *HEADINGS)]
    assert places == sorted(places)
    for heading, following in zip(HEADINGS, [*HEADINGS[1:], "Particle by particle"]):
        for text in (html, markdown):
            part = text[text.index(heading) : text.index(following)]
            assert "part of the verdict" in part, heading
    assert "Differ at " in html and "Differ at " in markdown
    assert "the others" in html and "no agreement" in html
    figures = html[html.index("<h2>Whole curves") : html.index("<h2>Each code")]
    assert (
        figures.count("<svg") == 3 + 2 * 3
    )  # a curve for each pair, a field for each and either direction
    assert not {"img", "link"} & set(Page(html).tags)


def test_other_programs_find_all_of_it(three, written):
    found = json.loads((written / "report.json").read_text(encoding="utf-8"))
    assert [one["pair"] for one in found["curves"]] == [list(o.pair) for o in three.opinions.curves]
    assert found["curves"][0]["depths"][0].keys() >= {"depth_m", "low_N", "high_N", "margin_N"}
    assert found["curves"][0]["seeds"] == list(range(1, PACKINGS + 1))
    assert 0 <= found["fields"][0]["p"] <= 1 and found["fields"][0]["split_half"] > 0
    assert {one["engine"] for one in found["consensus"]} == set(FACTORS)
    assert {one["word"] for one in found["theory"]} <= {"inside", "outside", "open"}


def test_a_run_that_failed_a_gate_takes_no_part():
    run_case = synthetic.case()
    runs = [
        synthetic.dataset(run_case, engine, seed, failed_gate=message)
        for engine in FACTORS
        for seed in (1, 2)
        for message in ["the bed does not rest" if (engine, seed) == ("yade", 2) else None]
    ]
    opinions = compare_runs(run_case, runs).opinions
    assert [one.seeds for one in opinions.curves] == [(1, 2), (1,), (1,)]
    assert [one.seeds for one in opinions.fields] == [(1, 2), (1,), (1,)]
    assert {one.seeds for one in opinions.consensus} == {(1,)}
    assert {one.outcome for one in opinions.consensus} == {NOT_COMPARABLE}
    assert [one.packings for one in opinions.theory if one.engine == "yade"] == [1, 1]


def test_there_is_no_consensus_while_a_run_is_missing():
    run_case = synthetic.case()
    runs = [synthetic.dataset(run_case, engine, seed) for engine in FACTORS for seed in range(1, 9)]
    assert {one.outcome for one in compare_runs(run_case, runs).opinions.consensus} == {EQUIVALENT}
    lost = compare_runs(run_case, runs, {("yade", 9): "lost 3 particles"}).opinions
    assert {one.outcome for one in lost.consensus} == {NOT_COMPARABLE}


def test_two_checks_of_one_quantity_are_two_rows_and_the_code_that_stands_apart_is_named(tmp_path):
    strict = synthetic.MEAN_RESISTANCE | {"kind": "ratio", "margin": 1.02, "seed_scatter": 1.01}
    run_case = synthetic.case([synthetic.MEAN_RESISTANCE, strict])
    runs = (
        synthetic.dataset(run_case, engine, seed, factor=1.2 if engine == "liggghts" else 1.0)
        for engine in FACTORS
        for seed in range(1, 9)
    )
    found = compare_runs(run_case, runs)
    rows = opinion_tables.values(found.opinions)["consensus"]
    assert [row.margin for row in rows] == ["±10 %", "1/1.02 to 1.02"]
    assert [[cell.apart for cell in row.cells] for row in rows] == [[False, True, False]] * 2
    page = report.write_report(found, tmp_path).read_text(encoding="utf-8")
    assert page.count("<b>stands apart</b>") == 2 and "off by about half of its distance" in page
    assert (tmp_path / "report.md").read_text(encoding="utf-8").count(", stands apart |") == 2
    written = json.loads((tmp_path / "report.json").read_text(encoding="utf-8"))["consensus"]
    assert {(one["kind"], one["margin"]) for one in written} == {("relative", 0.1), ("ratio", 1.02)}
    assert {one["engine"] for one in written if one["stands_apart"]} == {"liggghts"}


def test_opinions_are_made_once(three):
    assert three.opinions is three.opinions


def test_two_codes_have_no_consensus_and_few_packings_no_curves(tmp_path):
    page = report.write_report(compared(("native", "yade"), packings=2), tmp_path)
    for text in (page.read_text(encoding="utf-8"), (tmp_path / "report.md").read_text("utf-8")):
        assert "Two codes have no consensus" in text
        assert "2 packings that both ran are too few to tell curves apart: it takes 6." in text
        assert "2 packings that both ran are too few to tell fields apart: it takes 6." in text


def test_one_code_has_theory_alone(tmp_path):
    page = report.write_report(compared(("native",), packings=2), tmp_path)
    for text in (page.read_text(encoding="utf-8"), (tmp_path / "report.md").read_text("utf-8")):
        assert HEADINGS[3] in text and not any(heading in text for heading in HEADINGS[:3])


def test_without_any_run_there_is_no_opinion(tmp_path):
    found = compare_runs(synthetic.case(), [], {("native", 1): "it ended", ("yade", 1): "it ended"})
    html = report.write_report(found, tmp_path).read_text(encoding="utf-8")
    assert not any(f"<h2>{heading}</h2>" in html for heading in HEADINGS)
