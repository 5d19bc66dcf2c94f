"""Each fault seeded in the native solver must be noticed: by the ladder, which names case, engine and rung, and on the
few packings of the smoke tier, where docs/detection.csv says so.
"""

import pytest
from detection import SMOKE, bed_row
from detection_matrix import read_table, sound_runs
from escapes import UNSEEN_BY_LADDER
from faults import FAULTS
from ladder import climb, name_of
from workshop import Workshop

from crossdem import ExitCode

ROWS = read_table().set_index("fault")
NOTICED = [fault for fault in FAULTS if ROWS.loc[fault.name, "smoke"]]


@pytest.fixture(scope="module")
def workshop(tmp_path_factory):
    return Workshop(tmp_path_factory.mktemp("workshop"))


def test_the_sound_solver_climbs_the_ladder(workshop, tmp_path):
    found = climb(workshop.solver(), tmp_path / "out")
    assert found.exit_code == ExitCode.AGREES, found.said
    assert not found.caught and not found.failing and len(found.rungs) > 60


@pytest.mark.parametrize("fault", FAULTS, ids=lambda fault: fault.slug)
def test_the_ladder_notices_a_fault_at_a_rung_or_is_known_not_to(workshop, fault, tmp_path):
    found = climb(workshop.solver(fault), tmp_path / "out")
    assert found.caught != (fault.name in UNSEEN_BY_LADDER), found.said
    if found.caught:
        assert found.exit_code in (ExitCode.DIFFERS, ExitCode.ENGINE_FAILED), found.said
        first = found.failing[0]
        assert first["case"] in found.said and first["engine"] == "native", name_of(first)


@pytest.fixture(scope="module")
def runs(tmp_path_factory):
    return sound_runs(tmp_path_factory.mktemp("sound") / "out", SMOKE)


def test_the_sound_solver_raises_no_alarm(workshop, runs, tmp_path):
    row = bed_row(workshop.solver(), runs, runs.seeds, tmp_path, jobs=2)
    assert row["packings"] == SMOKE and not row["smoke"] and not row["different"], row


@pytest.mark.parametrize("fault", NOTICED, ids=lambda fault: fault.slug)
def test_a_fault_raises_the_alarm_that_it_raised_before(workshop, runs, fault, tmp_path):
    row = bed_row(workshop.solver(fault), runs, runs.seeds, tmp_path, jobs=2)
    before = set(ROWS.loc[fault.name, "smoke"].split("; "))
    assert before & set(row["smoke"].split("; ")), (before, row)
