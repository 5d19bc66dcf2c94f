"""The paper's claims: numbers are what they are said to be, verdicts follow from them, and one command makes it all."""

import json
import math
from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest
from command_line import crossdem
from rich.console import Console
from scipy import stats
from small_case import small_case, small_file
from test_report import Page

from crossdem.adapters.case import varied
from crossdem.adapters.workspace import Workspace
from crossdem.compare.progress import ProgressDisplay
from crossdem.compare.reproduction import estimates, time_step, wall_friction
from crossdem.compare.reproduction.collisions import Collisions, collide
from crossdem.compare.reproduction.estimates import Estimate
from crossdem.compare.reproduction.runs import Size
from crossdem.compare.reproduction.scaling import scaled
from crossdem.compare.reproduction.spectrum import fluctuation_share, median_wavelength_m, spectrum
from crossdem.compare.reproduction.study import (
    CORRECTED,
    NOT_REPRODUCED,
    REPRODUCED,
    UNDECIDED,
    VERDICTS,
    Setting,
)
from crossdem.compare.reproduction.verdicts import all_above, lowered, raised

HOSTILE = '<script>alert(1)</script> "q" & 土のモデル'
FIRST, SECOND = pd.Series([1.0, 1.2, 0.9, 1.4]), pd.Series([2.1, 1.7, 2.4])


def test_a_mean_has_students_interval_and_one_value_has_none():
    found = estimates.mean_of(FIRST)
    assert (found.low, found.high) == pytest.approx(
        stats.t.interval(0.95, 3, loc=FIRST.mean(), scale=stats.sem(FIRST))
    )
    assert not estimates.mean_of(FIRST[:1]).known


def test_a_difference_is_taken_packing_by_packing():
    other = FIRST + pd.Series([0.5, 0.5, 0.5, math.nan])
    found = estimates.difference_of(other, FIRST)
    assert (found.mean, found.packings) == (pytest.approx(0.5), 3)


def test_a_ratio_is_of_means_and_covers_the_truth_19_times_in_20():
    random, covered = np.random.default_rng(1), 0
    for _ in range(1000):
        base, other = (pd.Series(random.normal(mean, 0.3 * mean, 16)) for mean in (2.0, 5.0))
        found = estimates.ratio_of(other, base)
        assert found.mean == pytest.approx(other.mean() / base.mean())
        covered += found.low < 2.5 < found.high
    assert 930 <= covered <= 970


def test_a_ratio_to_what_may_be_nothing_is_none():
    assert math.isnan(estimates.ratio_of(FIRST, -SECOND).mean)
    assert not estimates.ratio_of(FIRST, SECOND[:1]).known


def resistance(wavelength_m, share):
    depth_m = np.linspace(0, 0.09, 901)
    force_N = 1.0 + share * math.sqrt(2) * np.sin(2 * np.pi * depth_m / wavelength_m)
    return pd.DataFrame({"depth_m": depth_m, "force_y_N": force_N})


def test_a_fluctuation_of_one_wavelength_has_that_wavelength_and_that_share():
    table = resistance(0.004, 0.2)
    assert median_wavelength_m(table) == pytest.approx(0.004, rel=0.02)
    assert fluctuation_share(table) == pytest.approx(0.2, rel=0.01)


def test_the_spectrum_sums_up_to_the_variance():
    density = spectrum(resistance(0.004, 0.2))
    assert density.sum() * density.index[0] == pytest.approx(0.2**2, rel=0.01)


def test_finer_stiffer_and_heavier_discs_keep_the_bed_and_the_share_of_the_time_step():
    case = small_case()
    for factors in ({"size": 0.5}, {"stiffness": 10.0}, {"density": 2.5}):
        other = varied(case, scaled(case, **factors)).resolved
        before, mass = case.resolved, factors.get("size", 1) ** 2 * factors.get("density", 1)

        def area(values):
            sizes = np.array(values["particles"]["diameters_m"])
            return (
                values["particles"]["count"]
                * (sizes**2 * values["particles"]["number_shares"]).sum()
            )

        root = math.sqrt(mass / factors.get("stiffness", 1))
        assert area(other) == pytest.approx(area(before))
        step_s = other["time"]["step_s"]
        assert (
            0.98 * root * before["time"]["step_s"]
            < step_s
            <= root * before["time"]["step_s"] * (1 + 1e-9)
        )
        for kind, contact in before["contact"].items():
            damping = math.sqrt(mass * factors.get("stiffness", 1)) * contact["shear_damping_N_s_m"]
            assert other["contact"][kind]["shear_damping_N_s_m"] == pytest.approx(damping)


def test_the_root_of_eq_31_is_one():
    a = time_step.root()
    assert a**3 + 2 * math.sqrt(2) * a**2 + a - 2 * math.sqrt(2) == pytest.approx(0, abs=1e-12)
    assert f"{a:.4f}" == "0.7594"


def test_the_first_step_of_a_collision_adds_energy_from_the_root_of_eq_31_on(tmp_path):
    with ProgressDisplay(Console(quiet=True)) as display:
        found = collide(small_case(), Workspace(tmp_path / "out"), 2, display)
    assert found.first_step_gains_from == pytest.approx(time_step.root(), abs=0.002)
    table = found.table.set_index("share")
    a = 0.5  # Eq (28) over Eq (26), with eta = sqrt(2 m k)
    expected = (1 - a**2 - math.sqrt(2) * a) ** 2 + a**2
    assert table.loc[a, "first_step"] == pytest.approx(expected, rel=1e-6)
    assert (table["least"] <= table["largest"]).all()


def test_time_steps_that_never_add_energy_have_no_bound():
    quiet = pd.DataFrame({"share": [0.1, 0.2], "first_step": [0.5, 0.9], "largest": [0.1, 0.2]})
    assert Collisions(quiet, 0.1).first_step_gains_from is None


def step(mean, half):
    return Estimate(mean, mean - half, mean + half, 16)


def test_a_trend_is_reproduced_only_where_every_step_goes_up():
    up, flat, down = step(1.0, 0.2), step(-0.1, 0.4), step(-1.0, 0.2)
    assert wall_friction.verdict_of([0, 1, 2, 3], [up, up, up], 1e-6) == REPRODUCED
    assert wall_friction.verdict_of([0, 1, 0.9, 3], [up, flat, up], 1e-6) == CORRECTED
    assert wall_friction.verdict_of([0, 1, 0, 3], [up, down, up], 1e-6) == CORRECTED
    assert wall_friction.verdict_of([3, 2, 1, 0], [down, down, down], 1.0) == NOT_REPRODUCED
    assert wall_friction.verdict_of([0, 0.1, 0.2, 0.3], [flat, flat, flat], 0.4) == UNDECIDED


def test_all_engines_must_lie_on_the_side_that_is_claimed():
    above, about, below = step(2.0, 0.5), step(1.0, 0.5), step(0.1, 0.2)
    assert all_above({"native": above, "yade": above}, 1.0) == REPRODUCED
    assert all_above({"native": above, "yade": about}, 1.0) == UNDECIDED
    assert all_above({"native": above, "yade": below}, 1.0) == NOT_REPRODUCED
    assert all_above({"native": Estimate(2.0, math.nan, math.nan, 1)}, 1.0) == UNDECIDED


def test_a_resistance_is_raised_where_the_interval_lies_above_no_change():
    assert raised(step(1.3, 0.1)) == raised(step(1.15, 0.07)) == REPRODUCED
    assert raised(step(1.05, 0.03)) == CORRECTED
    assert raised(step(1.0, 0.05)) == NOT_REPRODUCED
    assert raised(step(1.1, 0.15)) == raised(Estimate(2.0, math.nan, math.nan, 1)) == UNDECIDED


def test_a_fluctuation_is_lowered_without_correction_only_where_it_is_so_in_newtons():
    less, same, more = step(0.6, 0.1), step(1.0, 0.1), step(1.4, 0.1)
    assert lowered(less, less) == REPRODUCED
    assert lowered(less, more) == CORRECTED
    assert lowered(more, more) == NOT_REPRODUCED
    assert lowered(less, same) == lowered(same, less) == UNDECIDED


def test_a_setting_of_another_bar_has_beds_of_its_own():
    with pytest.raises(ValueError, match="bar.width_m=0.02"):
        Setting("wide", ("bar.width_m=0.02",))
    Setting("wide", ("bar.width_m=0.02",), bed=("bar.width_m=0.02",))


def test_other_engines_run_no_more_packings_than_there_are():
    size = Size(2, 4, ("native", "yade"))
    assert (size.of("native"), size.of("yade")) == (2, 2)


@pytest.fixture(scope="module")
def reproduced(tmp_path_factory):
    folder = tmp_path_factory.mktemp("reproduce")
    path = small_file(folder)
    path.write_text(
        path.read_text().replace("Bar penetration into 944 discs", HOSTILE.replace('"', '\\"'))
    )
    options = ("--engines", "native", "--seeds", "2", "--out", folder / "out")
    return SimpleNamespace(
        folder=folder / "out" / "reproduce",
        done=crossdem("reproduce", path, *options, timeout=400),
        again=lambda: crossdem("reproduce", path, *options, timeout=400),
    )


def test_one_command_says_what_came_of_each_claim(reproduced):
    assert reproduced.done.returncode == 0, reproduced.done.stderr
    claims = pd.read_csv(reproduced.folder / "claims.csv")
    assert len(claims) >= 14 and set(claims["verdict"]) <= set(VERDICTS)
    record = json.loads((reproduced.folder / "reproduce.json").read_text())
    assert [claim["says"] for claim in record["claims"]] == claims["says"].to_list()
    page = (reproduced.folder / "reproduce.html").read_text()
    for name in (
        "fig9_beds",
        "fig10_friction",
        "fig10_map",
        "fig11_resistance",
        "fig11_spectrum",
        "eq32_bed",
    ):
        assert f"{name}.svg" in page
        assert (reproduced.folder / f"{name}.svg").stat().st_size > 1000
        assert (reproduced.folder / f"{name}.png").read_bytes().startswith(b"\x89PNG")


def test_the_page_shows_a_hostile_title_as_text(reproduced):
    page = Page((reproduced.folder / "reproduce.html").read_text())
    assert HOSTILE in page.text


def test_what_was_interrupted_goes_on_where_it_was(reproduced):
    before = (reproduced.folder / "claims.csv").read_bytes()
    again = reproduced.again()
    assert "runs done" not in again.stdout  # nothing was left to run
    assert (reproduced.folder / "claims.csv").read_bytes() == before
