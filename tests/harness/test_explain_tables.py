"""What an attribution says in words: gaps, the last step, refused runs."""

import math
from types import SimpleNamespace

import synthetic
from test_attribution import CASE, SEEDS, SLOPE, WORK, attributed, stations

from crossdem.adapters import gates
from crossdem.compare import explain, explain_figure, explain_tables, ingredients
from crossdem.compare.attribution import attribute
from crossdem.compare.checks import Check


def test_a_step_over_a_station_without_result_names_both():
    found = attributed(without=[(2, seed) for seed in SEEDS])
    names = [row.name for row in explain_tables.change_rows(found)]
    assert names[:4] == ["step 1", "step 2", "step 3 (with step 2)", "step 4"]
    assert found.endpoints[0].steps[2].over == ("step 2",)
    assert found.endpoints[0].steps[3].over == ()
    said = " ".join(explain_tables.sentences(found))
    assert "add up" in said and "same packings" not in said
    assert "same packings" in " ".join(explain_tables.sentences(attributed()))


def test_a_value_that_one_quantity_lacks_is_said_in_its_cell():
    walked = stations(noise=0.01)
    walked[2].values["work_J"] = math.nan
    case = synthetic.case(checks=[synthetic.MEAN_RESISTANCE, WORK, SLOPE])
    row = explain_tables.change_rows(attribute(case, "yade", walked))[2]
    assert row.name == "step 3"
    assert row.cells[1].endswith("[step 3 (with step 2)]") and "[" not in row.cells[0]


def test_fewer_packings_stand_beside_the_step():
    found = attributed(noise=0.02, without=[(4, seed) for seed in SEEDS if seed > 4])
    names = [row.name for row in explain_tables.change_rows(found)]
    assert names[:4] == ["step 1", "step 2", "step 3", "step 4, 4 packings"]
    assert names[5] == "all, up to yade, 4 packings"


def last_step(**options):
    """What is said of it."""
    return explain_tables.sentences(attributed(**options))[-2]


def test_the_last_step_is_judged_by_its_numbers():
    assert "same bits in 3 quantities, on 16 packings" in last_step(effects=(0.05, 0.0), beds=0.1)
    clear = last_step(effects=(0.05, 0.03), noise=0.005)
    assert "leaves out zero in 3 of 3 quantities" in clear and "crossdem horizon" in clear
    chaos = last_step(effects=(0.05, 0.0, 0.0), noise=0.02)
    assert "not told from none" in chaos and "horizon" not in chaos
    alone = [(place, seed) for place in (1, 2) for seed in SEEDS if seed > 1]
    assert "cannot be told from chaos on 1 packing" in last_step(
        effects=(0.05, 0.01), noise=0.02, without=alone
    )


def test_a_last_step_over_the_native_scheme_is_no_test_of_the_engine():
    said = last_step(without=[(3, seed) for seed in SEEDS])
    assert "more than yade itself" in said and "same bits" not in said
    assert "has no result" in last_step(without=[(4, seed) for seed in SEEDS])


def test_steps_that_are_zero_to_the_last_bit_are_no_intervals_of_chance():
    said = explain_tables.sentences(attributed(effects=(0.05, 0.0, 0.0), noise=0.0, beds=0.0))
    assert "3 of 3 intervals leave out zero; about 0.2 would by chance." in said[1]


def test_every_failed_gate_is_told():
    ingredient = ingredients.PAPER
    run_of = synthetic.dataset(CASE)
    run_of.manifest["gates"] = [
        {"name": name, "passed": passed, "message": f"not comparable: {name} it is"}
        for name, passed in (("one", False), ("two", True), (gates.CONTACTS, False))
    ]
    run = SimpleNamespace(
        folder="there", packing=SimpleNamespace(seed=3), dataset=lambda: run_of, failure=None
    )
    found = explain.station(ingredient, Check.of_case(CASE.resolved), [run])
    assert explain_tables.remarks(found) == [
        "`crossdem check` would refuse 1 of 1: one it is",
        "`crossdem check` would refuse 1 of 1: contacts_share it is",
    ]
    assert not found.unrested and found.manifests == (run_of.manifest,)


def test_short_intervals_are_said_to_be_cut_off():
    few = attributed(noise=0.02, without=[(4, seed) for seed in SEEDS if seed > 3])
    assert explain_figure.cut_off(few)
    assert not explain_figure.cut_off(attributed(noise=0.02))


def test_changes_read_well():
    shown = [cells for _, _, cells in explain_tables.change_rows(attributed(noise=1e-9))]
    assert shown[0] == ["+5.0 ± 0.0 %", "+2.0 ± 0.0 mJ", "× 1.05 ± 0 %"]
