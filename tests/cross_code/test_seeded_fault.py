"""That the ladder notices a native solver that computes with something else than the case says.

The faults seeded in its sources are in tests/mutation; these need no compiler, so that every build can have them.
"""

import os
import shutil
from textwrap import dedent

import pytest
from command_line import ROOT, crossdem

from crossdem import ExitCode
from crossdem.adapters.solver import find_solver

MICRO = ROOT / "reference_cases" / "micro"

FAULTS = {
    "half the damping at walls": (
        "oblique_sticking",
        "case['contact']['particle_wall']['normal_damping_N_s_m'] /= 2",
    ),
    "tangent of the friction coefficient": (
        "oblique_sliding",
        "case['contact']['particle_wall']['friction'] = math.tan(case['contact']['particle_wall']['friction'])",
    ),
    "torque arm to the contact point": (
        "slide_to_roll",
        "case['scheme']['torque_arm'] = 'contact_point'",
    ),
    "inertia of a sphere": ("slide_to_roll", "case['scheme']['inertia'] = 'sphere'"),
}


@pytest.fixture
def faulty_solver(tmp_path):
    """A program that runs another case than the one it was given, and otherwise is the solver."""

    def with_fault(change):
        program = tmp_path / "crossdem-solver"
        program.write_text(
            dedent(
                f"""\
                #!/usr/bin/python3
                import json, math, os, sys
                arguments = sys.argv[1:]
                if arguments[0] == "run":
                    with open(arguments[1]) as file:
                        case = json.load(file)
                    {change}
                    arguments[1] = "other_case.json"
                    with open(arguments[1], "w") as file:
                        json.dump(case, file)
                os.execv({str(find_solver())!r}, ["crossdem-solver", *arguments])
                """
            )
        )
        program.chmod(0o755)
        return program

    return with_fault


@pytest.mark.parametrize("fault", FAULTS)
def test_a_wrong_number_fails_the_ladder_at_its_first_rung(fault, faulty_solver, tmp_path):
    case_name, change = FAULTS[fault]
    (tmp_path / "ladder").mkdir()
    shutil.copy(MICRO / f"{case_name}.toml", tmp_path / "ladder")
    done = crossdem(
        "check",
        tmp_path / "ladder",
        "--engines=native",
        f"--out={tmp_path / 'out'}",
        CROSSDEM_SOLVER=str(faulty_solver(change)),
    )
    assert done.returncode == ExitCode.DIFFERS, done.stdout + done.stderr
    for word in (case_name, "native", "twin"):
        assert word in done.stdout, done.stdout
