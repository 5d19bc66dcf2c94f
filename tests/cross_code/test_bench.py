"""The clocks of the real engines: they tell of the steps of a run, and change nothing of it."""

import json
import os
import subprocess

import pytest
from command_line import crossdem
from small_case import small_file

from crossdem.adapters.case import load_case
from crossdem.adapters.packing import make_packing
from crossdem.adapters.run_folder import prepare
from crossdem.compare.bench_clocks import CLOCKS, timed_command, told


@pytest.fixture(scope="module")
def found(required, tmp_path_factory):
    """What `crossdem bench --quick` wrote of a small case."""
    for name in CLOCKS:
        required(name)
    folder = tmp_path_factory.mktemp("bench")
    options = ["--quick", "--workloads", "bar,time-to-solution", "--case", small_file(folder)]
    ended = crossdem("bench", *options, "--out", folder / "out")
    assert ended.returncode == 0, ended.stderr
    return json.loads((folder / "out" / "bench.json").read_text())


def test_every_engine_is_timed_in_turn(found):
    ran = [(t["round"], t["workload"], t["engine"]) for t in found["timings"]]
    workloads = ("bar", "time-to-solution")
    assert ran == [(k, w, engine) for k in range(2) for w in workloads for engine in CLOCKS]
    assert not found["failures"] and not found["left_out"]


def test_all_make_the_same_steps_but_for_the_time_to_solution(found):
    steps = {(row["workload"], row["engine"]): row["steps"] for row in found["rows"]}
    assert {steps["bar", engine] for engine in CLOCKS} == {40}
    assert [steps["time-to-solution", engine] for engine in CLOCKS] == [*(2000, 4000, 4000, 4000)]


def test_only_the_steps_are_timed(found):
    """Not half a second of Python's start, of which YADE's process mostly consists here."""
    for timing in found["timings"]:
        assert 0 < timing["wall_s"] < timing["process_wall_s"]
        if timing["engine"] == "yade" and timing["workload"] == "bar":
            assert timing["wall_s"] < 0.2 * timing["process_wall_s"]


def test_the_clock_changes_nothing_of_what_yade_does(required, tmp_path):
    engine = required("yade")
    case = load_case(small_file(tmp_path))
    packing = make_packing(case, 1, tmp_path / "packing")
    outputs = []
    for name in ("plain", "timed"):
        prepare(case, packing, engine, tmp_path / name)
        plain = engine.command(case, tmp_path / name)
        command = plain if name == "plain" else timed_command(engine, case, tmp_path / name)
        ended = subprocess.run(
            command,
            cwd=tmp_path / name,
            env=os.environ | engine.environment(),
            capture_output=True,
            text=True,
        )
        assert ended.returncode == 0, ended.stderr
        files = sorted((tmp_path / name / "output").iterdir())
        outputs.append({file.name: file.read_bytes() for file in files})
    assert outputs[0] == outputs[1] and len(outputs[0]) == 2
    assert told(engine, case, ended.stdout).steps == 4000
