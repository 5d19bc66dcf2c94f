"""Each fault seeded in the native solver must fail the ladder, which then names the case, the engine and the rung."""

import pytest
from faults import FAULTS, Workshop, climb

from crossdem import ExitCode


@pytest.fixture(scope="module")
def workshop(tmp_path_factory):
    return Workshop(tmp_path_factory.mktemp("workshop"))


def test_the_sound_solver_climbs_the_ladder(workshop, tmp_path):
    done = climb(workshop.solver(), tmp_path)
    assert done.returncode == ExitCode.AGREES, done.stdout + done.stderr


@pytest.mark.parametrize("fault", FAULTS, ids=lambda fault: fault.name)
def test_a_fault_fails_the_ladder_at_a_rung(workshop, fault, tmp_path):
    done = climb(workshop.solver(fault), tmp_path)
    assert done.returncode == ExitCode.DIFFERS, done.stdout + done.stderr
    assert "native, twin" in done.stdout, done.stdout
