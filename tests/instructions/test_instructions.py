"""A step costs the instructions that are recorded, within 3 %: neither more, nor fewer without the record saying so."""

import json
import os
import shutil

import pytest
from instructions import RECORD, RECORD_ANEW, built, count

TOLERANCE = 0.03
RECORDED = json.loads(RECORD.read_bytes())


def complaints(counted: dict[str, float], recorded: dict[str, float]) -> list[str]:
    changes = {scheme: counted[scheme] / recorded[scheme] - 1 for scheme in recorded}
    return [
        f"{scheme}: {counted[scheme]:.1f} instructions per particle and step, "
        f"{change:+.1%} of the recorded {recorded[scheme]:.1f}"
        for scheme, change in changes.items()
        if abs(change) > TOLERANCE
    ]


@pytest.fixture
def countable():
    """Must be so in CI; elsewhere the count is skipped, and says why."""
    obstacles = []
    if not shutil.which("valgrind"):
        obstacles.append("no valgrind here: apt-get install valgrind")
    if built() != RECORDED["built"]:
        obstacles.append(
            f"recorded of {RECORDED['built']}, which says nothing of {built()}; "
            f"where the new one stays, record anew: {RECORD_ANEW}"
        )
    if obstacles:
        complaint = "; ".join(obstacles)
        if os.environ.get("CI"):
            pytest.fail(complaint, pytrace=False)
        pytest.skip(complaint)


@pytest.mark.usefixtures("countable")
def test_a_step_costs_the_instructions_that_are_recorded():
    changed = complaints(count(), RECORDED["per_particle_step"])
    if changed:
        advice = f"Where that is meant, record anew and commit it, saying why: {RECORD_ANEW}"
        pytest.fail("\n".join([*changed, advice]), pytrace=False)


@pytest.mark.parametrize(("counted", "told"), [(96.9, 1), (97.1, 0), (102.9, 0), (103.1, 1)])
def test_more_than_three_per_cent_either_way_is_told(counted, told):
    assert len(complaints({"paper": counted}, {"paper": 100.0})) == told
