"""The report in a real browser: it shows, complains of nothing, asks for nothing, and fits a wide and a narrow window."""

import os
import shutil
import subprocess

import matplotlib.image
import pytest
import synthetic
import test_attribution
import test_horizon
import test_stability
from test_report import HOSTILE, compared

from crossdem.compare import explain_report, horizon_report, report, stability_report

WIDTHS_PX = (1280, 400)


@pytest.fixture(scope="module")
def page(tmp_path_factory):
    return report.write_report(compared(title=HOSTILE), tmp_path_factory.mktemp("report"))


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
    assert "<script" not in shown
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
