"""docs/detection.* say what the faults are, and every fault is noticed somewhere or its escape is explained."""

from detection import OUTCOME, caught_by, endpoints_of
from detection_matrix import DOCS, SOUND, read_table
from detection_page import page
from escapes import UNSEEN_BY_LADDER
from faults import FAULTS

from crossdem.compare.checks import DIFFERENT

TABLE = read_table().set_index("fault", drop=False)
LAYERS = {name: caught_by(row) for name, row in TABLE.iterrows()}


def test_the_table_has_a_row_for_each_fault_and_one_for_the_sound_solver():
    assert list(TABLE.index) == [SOUND.name, *(fault.name for fault in FAULTS)]


def test_the_sound_solver_is_noticed_by_no_layer():
    assert LAYERS[SOUND.name] == []
    sound = TABLE.loc[SOUND.name]
    assert all(sound[name + OUTCOME] != DIFFERENT for name in endpoints_of(TABLE))


def test_every_fault_is_noticed_by_the_ladder_or_the_ensemble():
    assert [
        fault.name for fault in FAULTS if not {"ladder", "ensemble"} & set(LAYERS[fault.name])
    ] == []


def test_every_escape_from_the_ladder_has_a_reason_and_every_reason_an_escape():
    escaped = {fault.name for fault in FAULTS if "ladder" not in LAYERS[fault.name]}
    assert escaped == set(UNSEEN_BY_LADDER)


def test_the_page_is_that_of_the_table():
    assert (DOCS / "detection.md").read_text(encoding="utf-8") == page(read_table())
