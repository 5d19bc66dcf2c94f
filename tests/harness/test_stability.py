"""The stability map: beds are told apart by their energy, bounds are the solver's, and the map reads well."""

import json
import math
import re
from types import SimpleNamespace

import pandas as pd
import pytest
import synthetic
from command_line import REFERENCE, ROOT, crossdem
from rich.console import Console
from test_report import HOSTILE, Page

from crossdem.adapters.case import load_case
from crossdem.adapters.solver import BEYOND_REASON
from crossdem.compare import stability, stability_report, stability_tables
from crossdem.compare.stability import (
    AGITATED,
    BLOWN_UP,
    FAILED,
    QUIET,
    SCHEMES,
    StabilityMap,
    Trial,
)
from crossdem.compare.wording import DASH

PAPER, LEAP_FROG, YADE = (
    next(scheme for scheme in SCHEMES if scheme.name == name)
    for name in ("paper", "paper with leap-frog", "yade")
)
CASE = synthetic.case()
MANIFEST = synthetic.dataset(CASE).manifest


def run(energy_J=None, failure=None, exit_status=None):
    """As run_variants gives it."""
    dataset = synthetic.dataset(CASE)
    if energy_J is not None:
        dataset.resistance.loc[0, "kinetic_energy_J"] = energy_J
    return SimpleNamespace(
        packing=SimpleNamespace(seed=1),
        failure=failure,
        exit_status=exit_status,
        dataset=lambda: dataset,
    )


def found(outcomes, title="A title", scheme=PAPER, left_out=None):
    """A map of one scheme with these outcomes at 100, 200, ... microseconds; of several beds where there are lists."""
    trials = [
        Trial(scheme.name, (place + 1) * 1e-4, seed + 1, outcome, 1e-5, "")
        for place, beds in enumerate(outcomes)
        for seed, outcome in enumerate([beds] if isinstance(beds, str) else beds)
    ]
    case = synthetic.case(title=title)
    return StabilityMap(
        case, stability.bounds(case), 1.2, tuple(trials), left_out or {}, (MANIFEST,)
    )


@pytest.mark.parametrize("energy_J, outcome", [(9e-9, QUIET), (1.1e-8, AGITATED), (5e-3, AGITATED)])
def test_the_gate_on_the_rest_tells_quiet_from_agitated(energy_J, outcome):
    assert stability.trial(PAPER, 1e-4, run(energy_J)).outcome == outcome


def test_only_a_solver_that_gave_up_on_the_motion_has_blown_up():
    gone = run(failure="native ended with status 3: exploded", exit_status=BEYOND_REASON)
    assert stability.trial(PAPER, 3e-4, gone).outcome == BLOWN_UP
    for status in (None, 1, -9):  # a timeout, a full disk, out of memory
        full = run(failure="native: try a smaller time step", exit_status=status)
        assert stability.trial(PAPER, 3e-4, full).outcome == FAILED


def test_the_bounds_are_those_of_the_solver():
    """Its own words, at time steps above them."""
    known = stability.bounds(load_case(REFERENCE))

    def said(pattern, *overrides):
        options = [word for text in overrides for word in ("--set", text)]
        text = crossdem("resolve", REFERENCE, *options).stderr
        return float(re.search(pattern + r"[^0-9]*([0-9.e-]+[0-9])", text)[1])

    assert said(r"0\.75 sqrt\(m/k\) =", "time.step_s=1e-3") == pytest.approx(known.eq32_s, rel=1e-3)
    averaged = said("limit of the averaged displacement", "time.step_s=2e-4")
    assert averaged == pytest.approx(known.averaged_s, rel=1e-3)
    conventional = said("limit of a conventional integrator", "engines.yade.step_s=1e-4")
    assert conventional == pytest.approx(known.conventional_s, rel=1e-3)


def test_an_undamped_case_has_no_linear_bound_and_still_a_map():
    contact = {
        kind: {**values, "shear_damping_N_s_m": 0.0}
        for kind, values in CASE.resolved["contact"].items()
    }
    case = synthetic.case(contact=contact)
    assert stability.bounds(case).averaged_s == math.inf
    assert len(stability.default_steps_s(case)) > 10
    trials = (Trial(PAPER.name, 1e-4, 1, QUIET, 1e-9, ""),)
    undamped = StabilityMap(case, stability.bounds(case), 1.2, trials, {})
    assert cell(undamped, "linear bound") == DASH


def test_the_default_time_steps_reach_beyond_all_bounds_and_hold_those_of_the_case():
    steps_s, known = stability.default_steps_s(CASE), stability.bounds(CASE)
    assert steps_s == sorted(steps_s)
    assert steps_s[0] < 0.6 * known.conventional_s and steps_s[-1] > known.eq32_s
    assert {1e-4, 5e-5} <= set(steps_s)


@pytest.mark.parametrize("step_s", [3.1e-5, 1e-4, 3.6e-4])
@pytest.mark.parametrize("scheme", SCHEMES, ids=lambda scheme: scheme.name)
def test_every_place_of_the_map_is_a_valid_case_that_rests_as_long(scheme, step_s):
    time = stability.resting(load_case(REFERENCE), scheme, step_s).case.resolved["time"]
    assert time["step_s"] == step_s
    assert time["rest_s"] == pytest.approx(1.2, abs=step_s)


def test_quiet_reaches_up_to_the_first_bed_that_is_not():
    outcomes = [QUIET, QUIET, AGITATED, QUIET, BLOWN_UP]
    spread = found(outcomes)
    assert spread.quiet_up_to_s(PAPER) == pytest.approx(2e-4)
    assert spread.loud_from_s(PAPER) == pytest.approx(3e-4)
    assert spread.blown_up_from_s(PAPER) == pytest.approx(5e-4)
    two_beds = found([QUIET, [QUIET, AGITATED]])
    assert two_beds.quiet_up_to_s(PAPER) == pytest.approx(1e-4)
    assert found([BLOWN_UP]).quiet_up_to_s(PAPER) is None
    assert found([QUIET]).loud_from_s(PAPER) is None


def test_a_run_that_failed_tells_neither_quiet_nor_loud():
    top = found([QUIET, QUIET, FAILED])
    assert top.quiet_up_to_s(PAPER) == pytest.approx(2e-4)
    assert top.loud_from_s(PAPER) is None and top.perhaps_further(PAPER)
    between = found([QUIET, FAILED, AGITATED])
    assert between.quiet_up_to_s(PAPER) == pytest.approx(1e-4)
    assert between.loud_from_s(PAPER) == pytest.approx(3e-4) and between.perhaps_further(PAPER)
    assert not found([QUIET, AGITATED]).perhaps_further(PAPER)
    assert found([FAILED]).quiet_up_to_s(PAPER) is None
    one_of_two = found([QUIET, [QUIET, FAILED]])
    assert one_of_two.quiet_up_to_s(PAPER) == pytest.approx(1e-4)


def test_the_sentence_says_at_least_and_names_what_rests_nowhere():
    assert "rests up to at least 200 µs (paper)" in stability_tables.sentence(found([QUIET, QUIET]))
    assert "rests up to 100 µs (paper);" in stability_tables.sentence(found([QUIET, AGITATED]))
    rows = [*found([QUIET, AGITATED]).trials, *found([AGITATED], scheme=YADE).trials]
    both = StabilityMap(CASE, stability.bounds(CASE), 1.2, tuple(rows), {})
    assert "nowhere here under yade;" in stability_tables.sentence(both)


def test_a_scheme_that_refuses_a_reading_is_left_out_and_the_others_go_on():
    case = load_case(REFERENCE, ["scheme.attraction=clipped"])
    places, left_out = stability.grid(case, [5e-5])
    assert set(left_out) == {"yade", "yade_averaged"}
    assert all("scheme.name" in why for why in left_out.values())
    assert {place.scheme.name for place in places} | set(left_out) == {s.name for s in SCHEMES}
    said = stability_tables.remarks(found([QUIET], left_out=left_out))
    assert said[0][1].startswith("left out: ")


def test_particles_placed_by_hand_are_no_bed(tmp_path):
    placed = ROOT / "reference_cases" / "micro" / "head_on_pair.toml"
    ended = crossdem("stability", placed, cwd=tmp_path)
    assert ended.returncode == 2 and "[[particle]]" in ended.stderr, ended.stderr
    assert "crossdem check" in ended.stderr and not list(tmp_path.iterdir())


def cell(shown, title):
    """Of the first scheme's row."""
    return stability_tables.rows(shown)[0][stability_tables.TITLES.index(title)]


def test_the_bound_of_a_scheme_is_that_of_its_integrator():
    bounds = stability.bounds(CASE)
    assert bounds.of(PAPER) == pytest.approx(3 * bounds.of(LEAP_FROG))


def test_page_files_and_terminal(tmp_path, capsys):
    everything = found([QUIET, AGITATED, BLOWN_UP, FAILED], HOSTILE)
    page = stability_report.write_stability(everything, tmp_path)
    text = page.read_text(encoding="utf-8")
    parsed = Page(text)
    assert not {"script", "img", "link", "a"} & set(parsed.tags)
    assert parsed.tags.count("svg") == 2
    shown = [cells for _, [cells] in stability_tables.trial_rows(everything)]
    assert [text.partition(",")[0] for text in shown] == [QUIET, AGITATED, BLOWN_UP, FAILED]
    drawn = re.findall(r"<td[^>]*>([^<]*)</td>", text[text.index('id="trials"') :])
    assert [text for text in drawn if text in shown] == shown
    assert "native 1.0" in parsed.text and MANIFEST["packing_hash"][:12] in parsed.text
    assert "Eq (32)" in text
    names = {path.name for path in tmp_path.iterdir()}
    assert names == {"stability.html", "stability.png", "stability.csv", "stability.json"}
    assert list(pd.read_csv(tmp_path / "stability.csv")["outcome"]) == [
        *(QUIET, AGITATED, BLOWN_UP, FAILED)
    ]
    record = json.loads((tmp_path / "stability.json").read_text())
    assert record["schemes"][0]["quiet_up_to_s"] == pytest.approx(1e-4)
    stability_report.print_stability(everything, page, Console(width=120))
    assert "100 µs" in capsys.readouterr().out


def test_where_nothing_rests_it_says_so():
    assert stability_tables.sentence(found([AGITATED])).startswith("No bed is known to rest")
    assert stability_tables.rows(found([AGITATED]))[0][1] == stability_tables.NOWHERE


@pytest.mark.parametrize("steps", ["5e-5,x", "0", "-1e-4", "nan", "inf"])
def test_time_steps_that_are_none_are_bad_input(steps, tmp_path):
    ended = crossdem("stability", REFERENCE, "--time-steps", steps, cwd=tmp_path)
    assert ended.returncode == 2 and "Traceback" not in ended.stderr
    assert not list(tmp_path.iterdir())
