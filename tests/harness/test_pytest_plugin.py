"""The fixture crossdem_check: a test of one line for a code of one's own, in a process of pytest as users have it."""

import json
import os
import shutil
import subprocess
from pathlib import Path

import pytest
from command_line import ROOT
from test_own_engine import CLASS, DESCRIPTION

from crossdem.adapters.solver import find_solver

HERE = Path(__file__).parent
CONFTEST = 'pytest_plugins = ["crossdem.compare.pytest_plugin"]\n'


def run_tests(folder, text, fault="none"):
    """What pytest says of a file of tests beside a user's code, behind which stands the native solver."""
    (folder / "conftest.py").write_text(CONFTEST)
    (folder / "test_mine.py").write_text(text)
    (folder / "door.toml").write_text(DESCRIPTION)
    (folder / "door.py").write_text(CLASS)
    shutil.copy(HERE / "door_engine.py", folder)
    options = ["-q", "-p", "no:cacheprovider", f"--basetemp={folder / 'tmp'}"]
    command = ["/usr/bin/python3", "-m", "pytest", *options, folder]
    environment = os.environ | {"PYTHONPATH": str(ROOT), "CROSSDEM_SOLVER": str(find_solver())}
    environment |= {"FAULT": fault, "CONFORMS": "1"}
    return subprocess.run(
        command, cwd=folder, env=environment, capture_output=True, text=True, timeout=400
    )


def test_a_code_that_agrees_passes_in_one_line(tmp_path):
    said = run_tests(tmp_path, "def test_mine(crossdem_check):\n    crossdem_check('door.toml')\n")
    assert said.returncode == 0 and "1 passed" in said.stdout, said.stdout
    [about] = {file.resolve() for file in (tmp_path / "tmp").glob("*/crossdem/conform.json")}
    checks = json.loads(about.read_bytes())["bed"]["checks"]
    assert {frozenset(check["pair"]) for check in checks} == {
        frozenset({"door", name}) for name in ("native", "liggghts", "yade")
    }
    summary = about.with_suffix(".md").read_text(encoding="utf-8")
    assert all(check["explanation"] in summary for check in checks)


def test_a_class_may_be_given_as_itself_and_what_differs_is_told(tmp_path):
    test = "from door import Door\n\ndef test_mine(crossdem_check):\n    crossdem_check(Door)\n"
    said = run_tests(tmp_path, test, fault="slow velocities")
    assert said.returncode == 1, said.stdout
    assert "DIFFERS: door, door 1.0: ladder" in said.stdout
    assert "free_fall" in said.stdout and "Look first: " in said.stdout
    assert "conform.html" in said.stdout
