"""LAMMPS, attached by the public door alone, on the whole penetration beside recorded runs of the three other codes."""

import json
import sys
from pathlib import Path

from crossdem.adapters.engines import attach, get_engine
from crossdem.compare.bench_clocks import LAMMPS

sys.path.insert(0, str(Path(__file__).parents[1] / "harness"))  # command_line.py
from command_line import REFERENCE, crossdem  # noqa: E402


def test_it_agrees_with_the_others_as_far_as_a_smoke_test_says(tmp_path):
    get_engine(attach(str(LAMMPS))).version()
    what = ["check", REFERENCE, "--replay", "--engine", LAMMPS, "--tier", "smoke"]
    ended = crossdem(*what, "--out", tmp_path / "out", timeout=3000)
    report = json.loads((tmp_path / "out" / "report.json").read_bytes())
    assert ended.returncode == 0, ended.stdout
    pairs = {frozenset(check["pair"]) for check in report["checks"]}
    assert {frozenset({"lammps", name}) for name in ("native", "liggghts", "yade")} <= pairs
