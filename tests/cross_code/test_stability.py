"""The stability map of the paper's own bed, at the time steps that readings and engines are chosen by."""

import json

import pytest
from command_line import REFERENCE, crossdem

from crossdem.compare.stability import AGITATED, BLOWN_UP, QUIET


@pytest.fixture(scope="module")
def outcomes(tmp_path_factory):
    out = tmp_path_factory.mktemp("stability") / "out"
    steps = ["--time-steps", "5e-5,1e-4,3.5e-4"]
    ended = crossdem("stability", REFERENCE, *steps, "--out", out)
    assert ended.returncode == 0, ended.stderr
    trials = json.loads((out / "stability" / "stability.json").read_text())["trials"]
    return {(trial["scheme"], trial["step_s"]): trial["outcome"] for trial in trials}


@pytest.mark.parametrize("scheme", ["paper", "yade_averaged"])
def test_the_averaged_displacement_rests_at_the_papers_time_step(outcomes, scheme):
    assert outcomes[scheme, 5e-5] == outcomes[scheme, 1e-4] == QUIET


@pytest.mark.parametrize("scheme", ["liggghts", "yade", "paper with leap-frog"])
def test_a_conventional_scheme_rests_at_half_of_it_only(outcomes, scheme):
    assert outcomes[scheme, 5e-5] == QUIET
    assert outcomes[scheme, 1e-4] in (AGITATED, BLOWN_UP)


def test_just_above_eq_32_nothing_rests(outcomes):
    assert QUIET not in {outcome for (_, step_s), outcome in outcomes.items() if step_s > 3e-4}
