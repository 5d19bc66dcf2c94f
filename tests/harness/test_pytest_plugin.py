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


def run_tests(folder, text, fault="none", cwd=None):
    """What pytest, started in `cwd`, says of a file of tests beside a user's code, behind which stands the native solver."""
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
        command, cwd=cwd or folder, env=environment, capture_output=True, text=True, timeout=400
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


MISTAKES = {
    "door.tml": "door.tml: cannot be read",
    "bad.toml": "substeps: how many time steps",
    "door.py:Dor": "holds no class Dor derived from",
    "missing.toml": "missing: its program ./nothing cannot be run",
}


def test_a_mistake_is_told_in_a_line_and_files_are_found_beside_the_test(tmp_path):
    folder, elsewhere = tmp_path / "tests", tmp_path / "elsewhere"
    folder.mkdir()
    elsewhere.mkdir()
    (folder / "bad.toml").write_text(DESCRIPTION + "substeps = 0\n")
    missing = DESCRIPTION.replace("/usr/bin/python3", "./nothing").replace('"door"', '"missing"')
    (folder / "missing.toml").write_text(missing)
    (folder / "bad_case.toml").write_text("schema_version = 1\n")
    (elsewhere / "here.toml").write_text(DESCRIPTION + "substeps = -7\n")
    calls = {f"crossdem_check({engine!r})": said for engine, said in MISTAKES.items()} | {
        "crossdem_check('door.toml', tier='smok')": "unknown tier 'smok'; did you mean 'smoke'?",
        "crossdem_check('door.toml', case='bad_case.toml')": "bad_case.toml: container: missing",
        "crossdem_check('door.toml', case='none.toml')": "none.toml: cannot be read",
        "crossdem_check('here.toml')": "here.toml: substeps: how many time steps",
    }
    tests = [
        f"def test_{number}(crossdem_check):\n    {call}\n" for number, call in enumerate(calls)
    ]
    said = run_tests(folder, "\n".join(tests), cwd=elsewhere)
    assert f"{len(calls)} failed" in said.stdout and "Traceback" not in said.stdout, said.stdout
    assert "During handling" not in said.stdout and "pytest_plugin.py" not in said.stdout
    for expected in calls.values():
        assert expected in said.stdout, said.stdout
