"""The Python front of a case: files, overrides, and what it hands to the solver."""

import json

import pytest
from command_line import REFERENCE

from crossdem.adapters.case import Case, CaseError, load_case
from crossdem.adapters.engines import get_engine
from crossdem.adapters.overrides import OverrideError, apply_override


def test_the_reference_case_resolves_to_its_own_values():
    case = load_case(REFERENCE)
    assert case.name == "bar_penetration"
    assert case.resolved["particles"]["count"] == 944
    assert case.resolved["contact"]["particle_wall"]["friction"] == 0.25
    assert case.warnings == ()


def test_each_engine_has_its_own_time_step():
    case = load_case(REFERENCE)
    assert get_engine("native").step_s(case) == 1e-4
    assert get_engine("liggghts").step_s(case) == 5e-5


def test_a_resolved_case_resolves_to_itself_and_keeps_its_hash(tmp_path):
    case = load_case(REFERENCE)
    assert Case.from_resolved(case.resolved).hash == case.hash
    assert Case.from_canonical(case.canonical) == case


def test_the_canonical_text_has_sorted_keys_and_no_white_space():
    canonical = load_case(REFERENCE).canonical
    ordered = json.dumps(json.loads(canonical), sort_keys=True, separators=(",", ":"))
    assert canonical.decode() == ordered


def test_comments_and_order_do_not_change_the_hash(tmp_path):
    lines = REFERENCE.read_text().splitlines()
    shuffled = tmp_path / "shuffled.toml"
    shuffled.write_text("\n".join(line.split(" #")[0] for line in lines))
    assert load_case(shuffled).hash == load_case(REFERENCE).hash


def test_an_override_changes_the_value_and_the_hash():
    case = load_case(REFERENCE, ["contact.particle_wall.friction=0.5"])
    assert case.resolved["contact"]["particle_wall"]["friction"] == 0.5
    assert case.hash != load_case(REFERENCE).hash


def test_runs_are_named_by_all_of_a_case_but_its_title_and_checks():
    case = load_case(REFERENCE)
    judged_otherwise = load_case(REFERENCE, ["title='another'", "check=[]"])
    assert judged_otherwise.run_hash == case.run_hash and judged_otherwise.hash != case.hash
    for override in ("gravity_m_s2=9.8", "gates.contacts_share=0.02", "marks.near_bar_m=0.02"):
        assert load_case(REFERENCE, [override]).run_hash != case.run_hash


def test_an_override_is_validated_like_the_file():
    with pytest.raises(CaseError, match=r"contact\.particle_wall\.friction: "):
        load_case(REFERENCE, ["contact.particle_wall.friction=-1"])


@pytest.mark.parametrize("value", ["nan", "inf", "-inf", "2024-01-01", "99999999999999999999"])
def test_what_json_cannot_say_is_refused_by_its_key(value):
    with pytest.raises(CaseError, match=r"bar\.speed_m_s: "):
        load_case(REFERENCE, [f"bar.speed_m_s={value}"])


@pytest.mark.parametrize(
    "override, path, value",
    [
        ("b.c=1e-3", ["b", "c"], 1e-3),
        ("b.c = true", ["b", "c"], True),
        ("b.c=[1, 2]", ["b", "c"], [1, 2]),
        ("b.c=liggghts-3.8", ["b", "c"], "liggghts-3.8"),
        ('b.c="two words"', ["b", "c"], "two words"),
        ("list[1]=7", ["list", 1], 7),
        ("tables[0].d=7", ["tables", 0, "d"], 7),
        ("new.table.key=7", ["new", "table", "key"], 7),
    ],
)
def test_an_override_sets_one_value(override, path, value):
    tables = {"b": {"c": 0}, "list": [1, 2], "tables": [{"d": 0}]}
    apply_override(tables, override)
    for step in path:
        tables = tables[step]
    assert tables == value and type(tables) is type(value)


@pytest.mark.parametrize(
    "override, message",
    [
        ("b.c", "has no '='"),
        ("=1", "is not a key path"),
        ("b..c=1", "is not a key path"),
        ("b.c=", "not TOML"),
        ("b.c=two words", "needs quotes"),
        ("b.c=1\nd=2", "not TOML"),
        ("b.c.d=1", "b.c is not a table"),
        ("list[2]=1", "list has 2 entries"),
        ("b[0]=1", "b is not a list"),
    ],
)
def test_a_malformed_override_says_what_is_wrong(override, message):
    with pytest.raises(OverrideError, match=message):
        apply_override({"b": {"c": 0}, "list": [1, 2]}, override)


def test_every_malformed_override_is_reported_at_once():
    with pytest.raises(CaseError) as raised:
        load_case(REFERENCE, ["bar", "=1"])
    assert [fault.split(":")[0] for fault in raised.value.faults] == ["--set bar", "--set =1"]


def test_half_a_character_of_json_is_refused(tmp_path):
    path = tmp_path / "case.json"
    path.write_text('{"name": "\\ud83d"}')
    with pytest.raises(CaseError) as raised:
        load_case(path)
    said = "\\ud83d is half a character; give its other half, too"
    assert raised.value.faults == [f"{path}: {said}"]
