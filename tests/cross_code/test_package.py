"""A package of runs of the real codes: whole, free of this machine's folders, and fit to be compared with."""

import csv
import json
from pathlib import Path

import pytest
from command_line import ROOT, crossdem
from small_case import small_file

ENGINES = "native,liggghts,yade"


@pytest.fixture(scope="module")
def place(tmp_path_factory, required):
    """A folder with the file of a small case, and a package of its runs."""
    for engine in ENGINES.split(","):
        required(engine)
    folder = tmp_path_factory.mktemp("package")
    case = small_file(folder)
    what = ["dataset", "build", case, "--engines", ENGINES, "--seeds", "2", "--native-seeds", "3"]
    built = crossdem(*what, "--out", folder / "work", "-o", folder / "package", timeout=600)
    assert built.returncode == 0, built.stderr
    return folder


def test_it_holds_every_run_and_verifies(place):
    with open(place / "package" / "tables" / "runs.csv", newline="", encoding="utf-8") as file:
        engines = [row["engine"] for row in csv.DictReader(file)]
    assert {name: engines.count(name) for name in engines} == {
        "native": 3,
        "liggghts": 2,
        "yade": 2,
    }
    verified = crossdem("dataset", "verify", place / "package")
    assert verified.returncode == 0, verified.stdout


def test_no_file_of_it_names_a_folder_of_this_machine(place):
    """Debian's own folders, where the codes lie on every machine, may be named."""
    here = [str(place).encode(), str(ROOT).encode(), str(Path.home()).encode() + b"/"]
    for path in filter(Path.is_file, (place / "package").rglob("*")):
        content = path.read_bytes()
        assert not [folder for folder in here if folder in content], path


def test_each_run_says_by_what_it_was_made(place):
    for path in (place / "package" / "runs").glob("*/manifest.json"):
        about = json.loads(path.read_bytes())
        assert about["engine_version"] and about["command"] and about["limitations"] is not None


def test_native_runs_made_here_are_compared_with_those_of_the_package(place):
    what = ["check", place / "small.toml", "--against", place / "package", "--engines", "native"]
    ended = crossdem(*what, "--seeds", "2", "--out", place / "against", timeout=600)
    assert ended.returncode in (0, 1, 4), ended.stderr
    report = json.loads((place / "against" / "report.json").read_bytes())
    assert {"native", "liggghts", "yade"} <= {run["engine"] for run in report["runs"]}
