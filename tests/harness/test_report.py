"""The report: complete, self-contained, and inert whatever a case or a dataset calls itself."""

import base64
import hashlib
import json
import re
from html.parser import HTMLParser
from io import StringIO
from xml.etree import ElementTree

import pandas as pd
import pytest
import synthetic
from rich.console import Console

from crossdem.adapters import files
from crossdem.compare import quantities, report, resistance, summary, verdict, wording
from crossdem.compare.colours import engine_styles
from crossdem.compare.comparison import compare_runs
from crossdem.compare.ensemble import Ensemble
from crossdem.compare.pages import TEMPLATES
from crossdem.compare.recorded import Record

HOSTILE = "<script>alert('1')</script> \"q\" & | `土のモデル` [bold]$x_1$\x07"
ENGINES = ("native", "liggghts", "yade")


class Page(HTMLParser):
    """What a browser would take for elements, attributes and text."""

    def __init__(self, text):
        super().__init__()
        self.tags, self.attributes, self.text = [], [], ""
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        self.tags.append(tag)
        self.attributes += attrs

    def handle_data(self, data):
        self.text += data


def compared(title="A title", engines=ENGINES, failures=None, **options):
    run_case = synthetic.case(title=title)
    runs = [
        synthetic.dataset(run_case, engine, seed, noise=0.3, **options)
        for engine in engines
        for seed in (1, 2)
    ]
    return compare_runs(run_case, runs, failures)


def written(comparison, folder):
    page = report.write_report(comparison, folder)
    return page.read_text(encoding="utf-8"), (folder / "report.md").read_text(encoding="utf-8")


FIGURES = {
    f"{name}.{ending}"
    for name in ("resistance", "movement", "surface", "displacement")
    for ending in ("svg", "png", "csv")
}


def test_the_four_files_and_the_figures_are_written_and_nothing_else(tmp_path):
    assert report.write_report(compared(), tmp_path / "new") == tmp_path / "new" / "report.html"
    names = {path.name for path in (tmp_path / "new").iterdir()}
    assert names == {"report.html", "report.md", "report.json", "junit.xml", "figures"}
    assert {path.name for path in (tmp_path / "new" / "figures").iterdir()} == FIGURES


def test_figures_stand_alone_with_their_data_and_go_with_their_report(tmp_path):
    comparison = compared(engines=("native", "a $b_c$ <d>"))
    report.write_report(comparison, tmp_path)
    folder = tmp_path / "figures"
    for file in folder.glob("*.svg"):
        assert "a $b_c$ <d>" in "".join(ElementTree.parse(file).getroot().itertext())
    table = pd.read_csv(folder / "resistance.csv", index_col=0)
    runs = [resistance.resistance_profile(run.resistance, 0.001) for run in comparison.of("native")]
    first, second = (run["mean_N"].to_numpy() for run in runs)
    assert table["native mean"].to_numpy() == pytest.approx((first + second) / 2, rel=1e-5)
    half = abs(first - second) / 2**0.5
    assert table["native high"].to_numpy() == pytest.approx((first + second) / 2 + half, rel=1e-5)
    report.write_report(compare_runs(synthetic.case(), [], {("native", 1): "died"}), tmp_path)
    assert list(folder.iterdir()) == []


def test_the_page_names_the_other_pages_of_the_case_that_are_there(tmp_path):
    assert "None here yet" in written(compared(), tmp_path)[0]
    for name in ("horizon/horizon.html", "explain-yade/explain.html"):
        (tmp_path / name).parent.mkdir()
        (tmp_path / name).touch()
    links = [v for name, v in Page(written(compared(), tmp_path)[0]).attributes if name == "href"]
    assert [link for link in links if "#" not in link] == [
        "explain-yade/explain.html",
        "horizon/horizon.html",
    ]


@pytest.mark.parametrize("engines, sections", [(ENGINES, {"beds", "resistance"}), ((), set())])
def test_every_link_within_the_page_has_its_section(tmp_path, engines, sections):
    comparison = compared(engines=engines, failures={("yade", 3): "died"})
    page = Page(written(comparison, tmp_path)[0])
    ids = {value for name, value in page.attributes if name == "id"}
    links = {v[1:] for name, v in page.attributes if name == "href" and v.startswith("#")}
    assert sections | {"checks", "ladder", "provenance"} <= links <= ids


def test_the_page_says_the_verdict_first_and_shows_every_part(tmp_path):
    html, markdown = written(compared(), tmp_path)
    assert html.index("CONSISTENT") < html.index("Resistance against depth")
    for heading in (
        "Resistance against depth",
        "Displacement fields",
        "The bed and its layers",
        "Surface, and movement near the bar",
        "Checks",
        "Gates",
        "What each engine cannot express",
        "Provenance",
    ):
        assert f"<h2>{heading}</h2>" in html
    assert html.count('<svg class="bed"') == 4 * len(ENGINES)
    assert markdown.startswith("# CONSISTENT: A title")
    assert synthetic.MEAN_RESISTANCE["reason"] in html and "±10 %" in html.replace("\xa0", " ")


def test_the_page_says_outcome_interval_p_and_packings_of_each_pair_and_why(tmp_path):
    html, markdown = written(compared(), tmp_path)
    shown = Page(html).text.replace("\xa0", " ")
    for text in (shown, markdown):
        assert "p after Holm" in text and "2 / 16" in text and "inconclusive" in text
        assert "2 packings can only raise an alarm" in text
    assert "never counts as agreement" in shown
    assert html.count('<span class="outcome inconclusive">inconclusive</span> in 1 of 1') == 3


def test_each_pair_shows_the_alarm_band_of_its_own_scatter(tmp_path):
    """The scatter is that of the calmer engine, and yade is calm."""
    run_case = synthetic.case()
    runs = [
        synthetic.dataset(run_case, engine, seed, factor=factor)
        for engine, factors in zip(ENGINES, [(1.0, 1.3), (1.0, 1.3), (1.0, 1.0)])
        for seed, factor in enumerate(factors, start=1)
    ]
    comparison = compare_runs(run_case, runs)
    bands = [wording.band(result.check, result.alarm) for result in comparison.results]
    assert len(set(bands)) == 2
    html, markdown = written(comparison, tmp_path)
    for text in (Page(html).text.replace("\xa0", " "), markdown):
        shown = [text.count(f"the alarm band of 2 packings, {band};") for band in bands]
        assert shown == [bands.count(band) for band in bands]


def twins(engine, run_case):
    return [
        synthetic.dataset(
            run_case, engine, seed, twin, noise=0.3, packing_hash=f"{seed}{twin}" * 32
        )
        for seed in (1, 2, 3, 4, 5)
        for twin in (0, 1)
    ]


def test_engines_recorded_in_tables_are_in_every_table_and_in_no_picture_of_a_bed(tmp_path):
    run_case = synthetic.case(title="A title")
    recorded = Record(run_case, Ensemble.of(twins("yade", run_case)), {}, {}, {})
    comparison = compare_runs(run_case, twins("native", run_case), recorded=recorded)
    html, markdown = written(comparison, tmp_path)
    assert "recorded: yade 1.0" in html and "yade against native" in markdown
    assert html.count('<svg class="bed"') == 4 and "How much is chaos" in html
    assert "5 packings × 2 runs" in Page(html).text
    runs = json.loads((tmp_path / "report.json").read_text())["runs"]
    assert [run["recorded"] for run in runs] == [False] * 10 + [True] * 10
    alone = compare_runs(run_case, [], recorded=recorded)
    assert "yade" in written(alone, tmp_path)[0]


def test_the_page_loads_nothing_and_runs_its_own_scripts_only(tmp_path):
    html, _ = written(compared(), tmp_path)
    page = Page(html)
    (policy,) = [v for name, v in page.attributes if v and v.startswith("default-src 'none';")]
    allowed = re.search(r"script-src ([^;]*);", policy)[1].split()
    scripts = re.findall(r"<script>(.*?)</script>", html, flags=re.DOTALL)
    hashes = [base64.b64encode(hashlib.sha256(text.encode()).digest()).decode() for text in scripts]
    assert allowed == [f"'sha256-{one}'" for one in hashes]
    assert len(scripts) == sum(asset.endswith(".js") for asset in report.ASSETS)
    assert html.count("<script") == len(scripts) + 2  # and the data, which no browser runs
    assert not {"img", "link", "iframe", "object", "image"} & set(page.tags)
    for name, value in page.attributes:
        assert not name.startswith("on")
        if name in ("href", "xlink:href", "src"):
            assert value.startswith("#")
    assert "@import" not in html and not re.search(r"url\((?!#)", html)


def test_a_hostile_title_stays_text(tmp_path):
    html, markdown = written(compared(HOSTILE), tmp_path)
    page = Page(html)
    assert "<script>alert" not in html
    assert HOSTILE.replace("\x07", "\N{REPLACEMENT CHARACTER}") in page.text
    assert "<script" not in markdown and "\\|" in markdown and "土のモデル" in markdown
    assert json.loads((tmp_path / "report.json").read_text())["case"]["title"] == HOSTILE


def test_hostile_engines_and_messages_stay_text(tmp_path):
    engine = "<img src=x onerror=1>$a_b$"
    comparison = compared(
        engines=("native", engine),
        failures={("yade", 1): f"said: {HOSTILE} \x00"},
        failed_gate=HOSTILE,
    )
    html, markdown = written(comparison, tmp_path)
    assert "img" not in Page(html).tags and "<script>alert" not in html and "<img" not in html
    assert "<img" not in markdown and "<script" not in markdown
    ElementTree.parse(tmp_path / "junit.xml")


def test_the_record_is_strict_json_with_all_checks_and_values(tmp_path):
    comparison = compared()
    report.write_report(comparison, tmp_path)

    def refuse(constant):
        raise AssertionError(constant)

    record = json.loads((tmp_path / "report.json").read_text(), parse_constant=refuse)
    assert record["verdict"]["word"] == "CONSISTENT" and record["verdict"]["exit_code"] == 0
    assert len(record["checks"]) == len(comparison.results) == 3
    assert len(record["runs"]) == 6
    assert set(record["runs"][0]["values"]) == set(quantities.QUANTITIES)
    assert record["case"]["hash"] == comparison.case.hash


def test_the_test_report_has_a_test_per_run_gate_and_check_and_passes_only_agreement(tmp_path):
    failures = {("yade", 1): "lost 3 particles"}
    comparison = compared(engines=("native", "liggghts"), failures=failures)
    report.write_report(comparison, tmp_path)
    suites = {
        suite.get("name"): suite for suite in ElementTree.parse(tmp_path / "junit.xml").getroot()
    }
    assert [len(suites[name]) for name in ("verdict", "runs", "gates", "checks")] == [1, 5, 8, 3]
    assert suites["verdict"].get("failures") == "1"
    assert suites["runs"].get("errors") == "1"
    checks = {test.get("classname"): test for test in suites["checks"]}
    assert checks["checks.liggghts against native"].find("skipped") is not None
    assert checks["checks.yade against native"].find("error") is not None


def test_a_comparison_without_any_run_still_has_a_report(tmp_path):
    failures = {(engine, 1): f"{engine} is not installed" for engine in ENGINES}
    html, markdown = written(compare_runs(synthetic.case(), [], failures), tmp_path)
    assert "ENGINE FAILED OR MISSING" in html and "yade is not installed" in html
    assert "ENGINE FAILED OR MISSING" in markdown


def test_a_report_that_cannot_be_finished_leaves_the_one_before(tmp_path, monkeypatch):
    before, _ = written(compared(), tmp_path)

    def full(_):
        raise OSError("No space left on device")

    monkeypatch.setattr(files.os, "fsync", full)
    with pytest.raises(OSError):
        report.write_report(compared("Another title"), tmp_path)
    assert (tmp_path / "report.html").read_text(encoding="utf-8") == before


def test_each_engine_has_a_colour_of_its_own_the_same_in_any_company():
    styles = engine_styles(["native", "liggghts", "yade", "lammps", "esys"])
    assert len({style.colour for style in styles.values()}) == 5
    assert engine_styles(["yade"])["yade"] == styles["yade"]


@pytest.mark.parametrize("width", [80, 60, 48])
def test_no_number_parts_from_its_unit_however_narrow_the_terminal(width):
    text = StringIO()
    comparison = compared(drag=0.9, failures={("yade", 3): "off by 5 mm or 0.25 % of it; " * 20})
    summary.print_summary(comparison, console=Console(file=text, width=width))
    lines = text.getvalue().splitlines()
    words = [word for line in lines for word in line.split()]
    units = ("N", "mJ", "µJ", "mm", "N/m", "%")
    assert {"N", "mm", "%"} <= set(words)
    for line in lines:
        parts = line.split()
        for before, unit in zip([None, *parts], parts):
            assert unit not in units or (before and before[-1].isdigit()), line


def test_consistent_is_never_shown_as_agreement_is():
    assert summary.COLOURS[verdict.CONSISTENT] not in (
        summary.COLOURS[word] for word in summary.COLOURS if word != verdict.CONSISTENT
    )
    style = (TEMPLATES / "report.css").read_text(encoding="utf-8")
    tones = dict(re.findall(r"\.(agrees|consistent)\b[^{]*{ --tone: var\((--[a-z]+)\)", style))
    assert len(set(tones.values())) == 2
    for tone in tones.values():
        assert len(set(re.findall(tone + r": (#\w+);", style))) == 2  # in light and in dark


def test_the_terminal_shows_verdict_values_and_path_and_takes_no_text_for_markup(tmp_path):
    text = StringIO()
    comparison = compared(failures={("yade", 3): "[bold]died[/bold]\x1b[2J"})
    summary.print_summary(comparison, tmp_path / "report.html", Console(file=text, width=100))
    shown = text.getvalue()
    assert "ENGINE FAILED OR MISSING" in shown
    assert "[bold]died[/bold]" in shown and "\x1b" not in shown
    assert "mean resistance" in shown
    assert str(tmp_path / "report.html") in shown
