"""The report in a real browser: it shows, complains of nothing, asks for nothing, and fits a wide and a narrow window."""

import json
import os
import shutil
import statistics
import subprocess
from dataclasses import replace

import matplotlib.image
import numpy as np
import pytest
import synthetic
import test_attribution
import test_horizon
import test_stability
from command_line import ROOT
from test_report import HOSTILE

from crossdem.compare import explain_report, horizon_report, report, stability_report
from crossdem.compare.comparison import compare_runs

WIDTHS_PX = (1280, 400)
BROWSER = ROOT / "tests" / "browser"
SMOOTH_MS = 1000 / 30 + 0.5  # between pictures; the browser's clock is that coarse


@pytest.fixture(scope="module")
def page(tmp_path_factory):
    """Of engines whose particles move differently, with the speeds that belong to it."""
    case = synthetic.case(title=HOSTILE)
    drags = {"native": 0.5, "liggghts": 0.45, "yade": 0.4}
    runs = [
        _with_speeds(synthetic.dataset(case, engine, seed, noise=0.3, drag=drag))
        for engine, drag in drags.items()
        for seed in (1, 2)
    ]
    return report.write_report(compare_runs(case, runs), tmp_path_factory.mktemp("report"))


def _with_speeds(run):
    velocity_m_s = np.gradient(run.motion.position_m, run.motion.time_s, axis=0)
    return replace(run, motion=replace(run.motion, velocity_m_s=velocity_m_s))


@pytest.fixture(scope="module")
def browser(tmp_path_factory):
    """A function that has Chromium open a page, and returns what it prints and what it complains of."""
    if not shutil.which("chromium"):
        if os.environ.get("CI"):
            pytest.fail("chromium is missing: apt install chromium")
        pytest.skip("chromium is not installed: apt install chromium")
    profile = tmp_path_factory.mktemp("profile")
    quiet = ("--disable-background-networking", "--disable-component-update", "--disable-sync")

    def open_page(address, *options):
        program = ["chromium", "--headless", "--no-sandbox", "--disable-gpu", "--no-first-run"]
        logged = ["--enable-logging=stderr", f"--user-data-dir={profile}"]
        done = subprocess.run(
            [*program, *quiet, *logged, *options, address],
            capture_output=True,
            text=True,
            errors="replace",
            timeout=120,
        )
        assert done.returncode == 0, done.stderr
        return done.stdout, [line for line in done.stderr.splitlines() if "CONSOLE" in line]

    return open_page


def test_the_browser_complains_of_nothing_and_shows_the_title_as_text(browser, page):
    shown, complaints = browser(page.as_uri(), "--dump-dom")
    assert complaints == []
    assert "&lt;script&gt;alert('1')&lt;/script&gt;" in shown and "土のモデル" in shown
    assert "<script>alert" not in shown
    assert shown.index("CONSISTENT") < shown.index("Resistance against depth")


def _explanation(folder):
    return explain_report.write_explanation(test_attribution.attributed(HOSTILE), folder)


def _horizon(folder):
    found = test_horizon.found(test_horizon.NATIVE, test_horizon.STRAYING)
    return horizon_report.write_horizon(synthetic.case(title=HOSTILE), found, folder)


def _stability(folder):
    outcomes = [test_stability.QUIET, test_stability.BLOWN_UP]
    return stability_report.write_stability(test_stability.found(outcomes, HOSTILE), folder)


@pytest.mark.parametrize("write", [_explanation, _horizon, _stability])
def test_the_other_pages_are_complained_of_no_more(browser, tmp_path, write):
    shown, complaints = browser(write(tmp_path).as_uri(), "--dump-dom")
    assert complaints == []
    assert "&lt;script&gt;alert('1')&lt;/script&gt;" in shown and "<script" not in shown


def test_the_page_may_not_load_or_run_anything(browser, page, tmp_path):
    """The content security policy holds: a script and a picture from elsewhere put into the page are refused."""
    foreign = '<script>document.title = "ran"</script><img src="http://localhost:9/x.png"></body>'
    spoilt = tmp_path / "spoilt.html"
    spoilt.write_text(page.read_text(encoding="utf-8").replace("</body>", foreign), "utf-8")
    shown, complaints = browser(spoilt.as_uri(), "--dump-dom")
    assert "<title>ran" not in shown
    assert any("script" in line for line in complaints), complaints
    assert any("x.png" in line for line in complaints), complaints


@pytest.mark.parametrize("width_px", WIDTHS_PX)
def test_there_is_something_to_see_at_both_widths(browser, page, tmp_path, width_px):
    picture = tmp_path / "page.png"
    browser(page.as_uri(), f"--screenshot={picture}", f"--window-size={width_px},1200")
    pixels = matplotlib.image.imread(picture)
    assert pixels.shape[:2] == (1200, width_px)
    assert len({tuple(pixel) for pixel in pixels.reshape(-1, pixels.shape[2])}) > 50


@pytest.fixture(scope="module")
def used(page, tmp_path_factory):
    """What tests/browser/report.mjs saw when it used the page."""
    if not (BROWSER / "node_modules" / "playwright-core").is_dir():
        pytest.fail(f"playwright-core is missing: run npm ci in {BROWSER}")
    pictures = tmp_path_factory.mktemp("pictures")
    done = subprocess.run(
        ["node", "report.mjs", page.as_uri(), pictures],
        cwd=BROWSER,
        capture_output=True,
        text=True,
        timeout=300,
    )
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout) | {"pictures": pictures, "address": page.as_uri()}


def test_using_the_page_raises_no_complaint_and_no_request(used):
    assert used["complaints"] == []
    assert set(used["requests"]) == {used["address"]}
    assert used["wider_than_window"] == []


def test_a_hostile_title_is_text_in_the_browser(used):
    assert used["title"] == HOSTILE.replace("\x07", "\N{REPLACEMENT CHARACTER}")


def test_the_beds_of_all_engines_play_smoothly_and_stop(used):
    assert used["canvases"] == 3
    assert used["moved"] and used["paused"]
    assert 1 < float(used["clock_after_playing"].split()[0]) < 9
    assert min(map(statistics.median, used["intervals_ms"])) <= SMOOTH_MS


def test_the_slider_goes_where_it_is_dragged_and_obeys_keys(used):
    assert float(used["clock_while_dragged"].split()[0]) == pytest.approx(0.6 * 9, abs=0.2)
    assert used["clock_at_the_end"] == "9.00 s"
    assert used["clock_after_arrow"] == "8.90 s"


def test_each_colouring_shows_another_picture_and_its_scale(used):
    names = {"layer", "displacement", "speed", "difference"}
    assert names <= used["colourings"].keys()
    pictures = [used["colourings"][name][0] for name in names]
    assert len(set(pictures)) == len(names)
    assert "mm/s" in used["colourings"]["speed"][1]


def test_force_chains_are_drawn_where_discs_overlap_and_can_be_taken_away(used):
    found, expected = used["overlaps"]
    assert len(found) > 100
    assert [pair[:2] for pair in found] == [pair[:2] for pair in expected]
    assert [pair[2] for pair in found] == pytest.approx([pair[2] for pair in expected])
    assert used["forces"]["drawn"] and used["forces"]["gone"]
    assert "mN" in used["forces"]["scale"]


def test_pointing_at_a_particle_says_its_values_in_every_bed(used):
    particles = {text.split(";")[0] for text in used["said"]}
    assert len(used["said"]) == 3 and len(particles) == 1
    assert particles.pop().removeprefix("particle ").isdigit()
    assert all("displacement" in text and "mm" in text for text in used["said"])


def test_an_engine_can_be_taken_out_of_the_curves_and_the_curves_zoomed(used):
    assert used["toggled"] and used["toggled_back"] and used["zoomed"]
    for engine in ("native", "liggghts", "yade"):
        assert engine in used["legend"]
    assert sum(character.isdigit() for character in used["legend"]) > 8


def test_the_checks_can_be_filtered(used):
    assert used["rows"] == used["rows_again"] == 3
    assert (used["rows_with_yade"], used["rows_with_nonsense"], used["rows_different"]) == (2, 0, 0)


def test_on_paper_the_pictures_stand_for_what_moves(used):
    assert used["printed"] == {"stills": 12, "canvases": 0}


def test_light_and_dark_differ_at_both_widths(used):
    for width_px in WIDTHS_PX:
        light, dark = (
            matplotlib.image.imread(used["pictures"] / f"{scheme}-{width_px}.png")[..., :3].mean()
            for scheme in ("light", "dark")
        )
        assert light > 0.7 and dark < 0.4
