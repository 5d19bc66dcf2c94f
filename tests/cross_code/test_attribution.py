"""The walk from the paper's scheme to each real code, on a bed small enough that it takes seconds."""

import json

import pytest
from command_line import REFERENCE, crossdem
from small_case import SMALL

from crossdem.compare.ingredients import TARGETS, walk

OVERRIDES = [word for text in SMALL for word in ("--set", text)]


@pytest.fixture(params=TARGETS)
def target(request):
    return request.param


def test_the_walk_ends_at_the_code_itself(target, tmp_path, required):
    required(target)
    out = tmp_path / "out"
    ended = crossdem("explain", REFERENCE, *OVERRIDES, "--to", target, "--seeds", "2", "--out", out)
    assert ended.returncode == 0, ended.stderr
    assert f"paper scheme to {target}" in ended.stdout
    record = json.loads((out / f"explain-{target}" / "explain.json").read_text())
    assert [len(station["values"]) for station in record["stations"]] == [2] * (
        len(walk(target)) + 1
    )
    assert abs(record["left_over"]["mean_resistance_N"]) < 1e-9
    steps = [row for row in record["changes"] if row["quantity"] == "mean_resistance_N"]
    last = next(row for row in steps if row["step"] == f"{target} itself")
    first = next(row for row in steps if row["step"] == "time step")
    # The short way lies before the horizon: code and native scheme are still the same, two time steps are not.
    assert abs(last["change"]) < 1e-6 < abs(first["change"])


def test_a_step_that_never_rests_is_shown_and_the_walk_goes_on(tmp_path, required):
    required("liggghts")
    out = tmp_path / "out"
    agitated = ["--set", "engines.liggghts.step_s=1e-4"]
    ended = crossdem(
        "explain",
        REFERENCE,
        *OVERRIDES,
        *agitated,
        "--to",
        "liggghts",
        "--seeds",
        "1",
        "--out",
        out,
    )
    assert ended.returncode == 0, ended.stderr
    assert "refuse 1 of 1: the bed does not rest" in " ".join(ended.stdout.split())
