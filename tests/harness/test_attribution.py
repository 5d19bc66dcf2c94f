"""Attribution: known effects are recovered, gaps are said, and the page holds it all."""

import json
import math

import numpy as np
import pandas as pd
import pytest
import synthetic
from command_line import REFERENCE, ROOT, crossdem
from rich.console import Console
from test_report import HOSTILE, Page

from crossdem import ExitCode
from crossdem.adapters import gates
from crossdem.adapters.case import CaseError, load_case
from crossdem.adapters.engines import get_engine
from crossdem.compare import explain, explain_report, explain_tables, ingredients
from crossdem.compare.attribution import Station, attribute

SEEDS = range(1, 17)
WORK = {**synthetic.MEAN_RESISTANCE, "quantity": "work_J", "kind": "absolute", "margin": 0.01}
SLOPE = {**synthetic.MEAN_RESISTANCE, "quantity": "resistance_slope_N_m", "kind": "ratio"}
CASE = synthetic.case()
EFFECTS = (0.05, -0.02, 0.0, 0.03)  # of the steps, as shares of the first station's mean


def stations(
    effects=EFFECTS, noise=0.0, beds=0.1, without=(), names=None, restless=(), unsupported=()
):
    """A walk on beds that differ by `beds`, whose steps add `effects` and chaos of `noise`.

    (station, seed): `without` result, `unsupported` if also there, `restless` where the bed does not rest.
    """
    random = np.random.default_rng(1)
    bed = 1 + beds * random.normal(size=len(SEEDS))
    bed /= bed.mean()
    level, found = 0.0, []
    for number, effect in enumerate((0.0, *effects)):
        level += effect
        values = bed + level + noise * random.normal(size=len(SEEDS))
        table = pd.DataFrame(
            {
                "mean_resistance_N": 0.9 * values,
                "work_J": 0.04 * values,
                "resistance_slope_N_m": 15 * np.exp(level) * bed,
            },
            index=pd.Index(SEEDS, name="seed"),
        )
        lost = [seed for place, seed in without if place == number]
        name = names[number] if names else f"step {number}"
        found.append(
            Station(
                ingredients.Ingredient(name, (), "Says what it does."),
                table.drop(index=lost),
                {seed: "native ended with status 1: exploded" for seed in lost},
                _gates([seed for place, seed in restless if place == number]),
                frozenset(seed for place, seed in unsupported if place == number),
                tuple(synthetic.dataset(CASE, seed=seed).manifest for seed in table.index[:2]),
            )
        )
    return tuple(found)


def _gates(restless):
    said = "not comparable: the bed does not rest at this time step (1 J)"
    return {gates.REST: {seed: said for seed in restless}} if restless else {}


def attributed(title="A title", **options):
    case = synthetic.case(checks=[synthetic.MEAN_RESISTANCE, WORK, SLOPE], title=title)
    return attribute(case, "yade", stations(**options))


def test_known_effects_are_recovered_and_add_up_to_the_total():
    resistance, work, slope = attributed().endpoints
    assert [step.mean for step in resistance.steps] == pytest.approx(EFFECTS, abs=1e-12)
    assert resistance.total.mean == pytest.approx(sum(EFFECTS))
    assert resistance.to_scheme.mean == pytest.approx(sum(EFFECTS[:-1]))
    assert resistance.adds_up and work.adds_up and slope.adds_up
    assert [step.mean for step in work.steps] == pytest.approx([0.04 * e for e in EFFECTS])
    assert [step.mean for step in slope.steps] == pytest.approx(EFFECTS)  # logarithms


def test_beds_cancel_and_an_interval_tells_an_effect_from_chaos():
    """Beds scatter by 10 %, chaos by 0.5 %: packing by packing an effect of 3 % is clear, and none is none."""
    steps = attributed(noise=0.005).endpoints[0].steps
    assert [step.clear for step in steps] == [True, True, False, True]
    for step, effect in zip(steps, EFFECTS):
        low, high = step.interval
        assert low < effect < high and high - low < 0.012


def test_the_interval_is_the_95_percent_one_of_the_t_distribution():
    """Of differences of two packings, -1 and 3: mean 1, half width 12.706 x 2."""
    pair = stations(effects=(0.0,))
    for station, values in zip(pair, ([1.0, 1.0], [0.0, 4.0])):
        station.values.drop(index=range(3, 17), inplace=True)
        station.values["mean_resistance_N"] = values
    [change] = attribute(synthetic.case(), "yade", pair).endpoints[0].steps
    assert change.mean == 1.0
    assert change.interval == pytest.approx((1 - 25.412, 1 + 25.412), abs=1e-3)


def test_a_station_that_blew_up_everywhere_is_stepped_over_and_said():
    found = attributed(without=[(2, seed) for seed in SEEDS])
    steps = found.endpoints[0].steps
    assert math.isnan(steps[1].mean) and steps[1].interval is None
    assert steps[2].against == "step 1"
    assert steps[2].mean == pytest.approx(EFFECTS[1] + EFFECTS[2])
    assert found.endpoints[0].adds_up
    assert explain_tables.remarks(found.stations[2]) == [
        "no result in 16 of 16: native ended with status 1: exploded"
    ]


def test_a_bed_that_does_not_rest_is_marked_and_not_counted(tmp_path):
    found = attributed(noise=0.005, restless=[(2, 7)])
    steps = found.endpoints[0].steps
    assert [step.restless for step in steps] == [False, True, True, False]
    assert steps[1].leaves_out_zero and not steps[1].clear and not steps[1].telling
    cells = [row.cells[0] for row in explain_tables.change_rows(found)]
    assert [cell.endswith("*") for cell in cells] == [False, True, True, False, False, False]
    assert steps[1] not in found.clear_steps
    page = Page(explain_report.write_explanation(found, tmp_path).read_text(encoding="utf-8"))
    assert "would refuse 1 of 16: the bed does not rest" in page.text
    assert "Asterisk" in page.text
    table = pd.read_csv(tmp_path / "explain.csv")
    assert list(table["all_beds_rest"][:4]) == [True, False, False, True]


@pytest.mark.parametrize("place, failed", [(0, True), (1, False), (3, True), (4, True)])
def test_a_run_that_failed_at_an_end_of_the_walk_is_an_engine_that_failed(place, failed):
    assert attributed(without=[(place, 5)]).engine_failed == failed
    assert not attributed(without=[(place, 5)], unsupported=[(place, 5)]).engine_failed


def test_without_a_total_there_is_no_conclusion():
    everywhere = [(4, seed) for seed in SEEDS]
    found = attributed(without=everywhere, unsupported=everywhere)
    assert not found.has_total and not found.engine_failed
    assert attributed().has_total


def test_shares_of_a_first_station_without_result_are_not_those_of_another():
    resistance, work, _ = attributed(without=[(0, seed) for seed in SEEDS]).endpoints
    assert all(math.isnan(step.mean) for step in resistance.steps)
    assert math.isfinite(work.steps[1].mean)  # in its unit


PLACED = ROOT / "reference_cases" / "micro" / "head_on_pair.toml"


def test_particles_placed_by_hand_are_refused_with_what_to_do(tmp_path):
    ended = crossdem("explain", PLACED, "--to", "yade", cwd=tmp_path)
    assert ended.returncode == ExitCode.BAD_INPUT, ended.stderr
    for needed in ("[[particle]]", "crossdem check", "[[check]]", "[bar]"):
        assert needed in ended.stderr
    assert not list(tmp_path.iterdir())


def test_readings_that_a_walk_cannot_start_from_are_told():
    case = load_case(synthetic.REFERENCE_CASE, ["scheme.attraction=clipped"])
    with pytest.raises(CaseError, match="starts from the paper's default readings"):
        explain.route(case, "yade")


def test_an_engine_on_fewer_packings_leaves_something_over_and_it_is_said():
    found = attributed(noise=0.02, without=[(4, seed) for seed in SEEDS if seed > 4])
    endpoint = found.endpoints[0]
    assert endpoint.total.seeds == (1, 2, 3, 4) and not endpoint.adds_up
    assert endpoint.left_over == pytest.approx(endpoint.total.mean - endpoint.sum_of_steps)
    assert explain_tables.change_rows(found)[-1][0] == explain_tables.LEFT_OVER
    assert "do not add up" in " ".join(explain_tables.sentences(found))


def test_a_start_without_results_is_no_crash(tmp_path):
    found = attributed(without=[(0, seed) for seed in SEEDS])
    assert math.isnan(found.endpoints[0].total.mean)
    assert "There is no total" in " ".join(explain_tables.sentences(found))
    assert explain_report.write_explanation(found, tmp_path).exists()


def test_a_missing_code_is_said_and_the_rest_of_the_walk_is_there(tmp_path):
    for name in ("dirname", "readlink"):
        (tmp_path / name).symlink_to(f"/usr/bin/{name}")
    small = ["particles.count=60", "time.penetration_s=0.1", "time.rest_s=0.1"]
    overrides = [word for text in small for word in ("--set", text)]
    out = tmp_path / "out"
    options = ["--to", "liggghts", "--seeds", "1", "--out", out]
    ended = crossdem("explain", REFERENCE, *overrides, *options, PATH=str(tmp_path))
    assert ended.returncode == ExitCode.ENGINE_FAILED, ended.stderr
    said = " ".join(ended.stdout.split())
    assert "liggghts itself: no result in 1 of 1: liggghts is not installed" in said
    stations = json.loads((out / "explain-liggghts" / "explain.json").read_text())["stations"]
    assert [len(station["values"]) for station in stations] == [1] * (len(stations) - 1) + [0]


def test_a_case_without_checks_is_refused(tmp_path):
    ended = crossdem("explain", REFERENCE, "--set", "check=[]", "--to", "yade", cwd=tmp_path)
    assert ended.returncode == ExitCode.BAD_INPUT and "[[check]]" in ended.stderr
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("target", ingredients.TARGETS)
def test_every_station_of_the_walk_is_another_case_and_ends_at_the_engine(target):
    case = load_case(synthetic.REFERENCE_CASE)
    steps = explain.route(case, target)
    hashes = [variant.case.hash for _, variant in steps]
    assert (
        hashes[0] == hashes[-1] == case.hash
    )  # the paper's scheme, and the engine on the case as it is
    assert len(set(hashes)) == len(hashes) - 1
    assert [variant.engine for _, variant in steps] == ["native"] * (len(steps) - 1) + [target]
    everything = steps[-3][1].case.resolved["scheme"]
    assert everything["name"] == "paper"
    taken = {"normal_spring": "overlap", "slip_cap": "total", "torque_arm": "contact_point"}
    assert everything | taken == everything  # each on top of those before it
    native = steps[-2][1].case.resolved
    assert native["scheme"]["name"] == target
    assert native["time"]["step_s"] == get_engine(target).step_s(case)
    assert len({ingredient.name for ingredient, _ in steps}) == len(steps)


def test_the_walk_leaves_all_but_its_ingredients_as_it_is():
    """Among them what a time step would otherwise fill in: intervals, packing, the engines' steps."""
    case = load_case(synthetic.REFERENCE_CASE)
    for _, variant in explain.route(case, "yade"):
        assert variant.case.resolved | {"scheme": 0, "time": 0} == case.resolved | {
            "scheme": 0,
            "time": 0,
        }


def test_the_page_is_inert_and_holds_chart_table_and_steps(tmp_path):
    found = attributed(HOSTILE, noise=0.02, without=[(2, 3)])
    page = explain_report.write_explanation(found, tmp_path)
    text = page.read_text(encoding="utf-8")
    parsed = Page(text)
    assert not {"script", "img", "link", "a"} & set(parsed.tags)
    assert "yade 1.0" not in parsed.text and "native 1.0" in parsed.text  # versions of the runs
    assert found.stations[0].manifests[0]["packing_hash"][:12] in parsed.text
    assert "Says what it does." in parsed.text and "no result in 1 of 16" in parsed.text
    assert text.count("<svg") == 2
    names = {path.name for path in tmp_path.iterdir()}
    assert names == {"explain.html", "explain.png", "explain.csv", "explain.json"}
    table = pd.read_csv(tmp_path / "explain.csv")
    assert len(table) == 3 * (len(EFFECTS) + 2)
    record = json.loads((tmp_path / "explain.json").read_text())
    assert len(record["stations"]) == len(EFFECTS) + 1 and record["case"]["title"] == HOSTILE


@pytest.mark.parametrize("width", [60, 100, 200])
def test_the_terminal_shows_every_quantity_at_any_width(width, tmp_path, capsys):
    console = Console(width=width)
    explain_report.print_explanation(attributed(noise=0.02), tmp_path / "x.html", console)
    shown = capsys.readouterr().out
    for name in ("mean resistance", "work of the bar", "slope over depth", "step 4"):
        assert name in shown
    assert max(map(len, shown.splitlines()[:-1])) <= width
