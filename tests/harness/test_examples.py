"""The examples of docs/own_engine.md: a code with a bug is caught and mended, and LAMMPS declines what it cannot say."""

import importlib.util
import json
import shutil
import subprocess

import pytest
from command_line import REFERENCE, ROOT, crossdem

from crossdem.adapters.case import load_case, varied_table
from crossdem.adapters.engine_file import read_engine

EXAMPLES = ROOT / "examples"
DECLARED = """
[[difference]]
case = "spin_start"
quantity = "rolling_speed_over_slip"
value = 0.0476
tolerance = 0.001
reason = "inertia of a hoop"
"""
FLAGS = ["-O2", "-Wall", "-Wextra", "-Werror"]


def built(folder):
    subprocess.run(["cc", *FLAGS, "-o", "discs", "discs.c", "-lm"], cwd=folder, check=True)


@pytest.fixture(scope="module")
def tutorial(tmp_path_factory):
    """The folder of the tutorial's code, and what `crossdem conform` says of it with its bug, with one rung of that declared,
    without the bug, and then of the ladder alone.
    """
    folder = tmp_path_factory.mktemp("tutorial") / "code"
    shutil.copytree(EXAMPLES / "tutorial", folder)
    said = []
    for out in ("bug", "declared", "mended", "no bed"):
        built(folder)
        file = folder / "discs.toml"
        if out == "declared":
            file = folder / "declared.toml"
            file.write_text((folder / "discs.toml").read_text() + DECLARED)
        options = ["--no-bed"] if out == "no bed" else []
        ended = crossdem("conform", file, *options, "--out", folder / out, cwd=folder)
        about = json.loads((folder / out / "conform.json").read_text(encoding="utf-8"))
        said.append((ended, about))
        if out == "declared":
            with open(folder / "fix.patch", encoding="ascii") as fix:
                subprocess.run(["patch"], cwd=folder, stdin=fix, check=True)
    return folder, said


def test_the_bug_of_the_tutorial_is_found_by_the_case_that_tells_it(tutorial):
    _, [(ended, about), *_] = tutorial
    assert ended.returncode == 1, ended.stderr
    first = about["ladder"]["differing"][0]
    assert first["case"] == "spin_start" and "0.2857" in first["said"] and "0.3333" in first["said"]
    assert "moment of inertia" in about["look_first"]
    assert about["bed"] is None and "The bed was not run" not in about["look_first"]


def test_mended_it_holds_on_every_rung_that_it_offers(tutorial):
    folder, [(_, bug), _, (ended, about), _] = tutorial
    ladder = about["ladder"]
    assert ladder["held"] == ladder["compared"] > bug["ladder"]["held"]
    assert set(ladder["not_offered"]) >= {"pinch", "bar_corner", "joint_pulled_apart"}
    assert about["bed"]["verdict"] == "INCONCLUSIVE" and ended.returncode == 4  # it knows no bar
    assert f"ladder {ladder['held']}/{ladder['held']}" in (folder / "mended/badge.svg").read_text()
    badge = json.loads((folder / "mended/badge.json").read_text())
    assert badge.keys() == {"schemaVersion", "label", "message", "color"}


def test_a_declared_difference_is_told_apart_from_a_rung_that_holds(tutorial):
    folder, [(_, bug), (_, about), *_] = tutorial
    ladder = about["ladder"]
    [declared] = ladder["declared"]
    assert declared["case"] == "spin_start" and declared["reason"] == "inertia of a hoop"
    assert ladder["held"] == bug["ladder"]["held"] and not bug["ladder"]["declared"]
    assert len(ladder["differing"]) == len(bug["ladder"]["differing"]) - 1
    for name in ("badge.json", "conform.html", "conform.md"):
        said = (folder / "declared" / name).read_text(encoding="utf-8")
        assert f"ladder {ladder['held']}/{ladder['compared']} + 1 declared" in said
        assert name == "badge.json" or "inertia of a hoop" in said


def test_the_ladder_alone_decides_where_that_is_asked_for(tutorial):
    _, [*_, (mended, with_bed), (ended, about)] = tutorial
    assert "--no-bed leaves the verdict to the ladder" in with_bed["look_first"]
    assert (mended.returncode, ended.returncode) == (4, 0)
    assert about["verdict"] == "AGREES" and about["bed"] is None
    assert "The bed was not asked for" in about["look_first"]


def test_the_page_says_what_is_in_the_files(tutorial):
    folder, [(ended, about), *_] = tutorial
    page = (folder / "bug/conform.html").read_text(encoding="utf-8")
    assert about["verdict"] in page and "spin_start" in page and "moment of inertia" in page
    assert str(folder / "bug/conform.html") in ended.stdout.replace("\n", "")
    assert (folder / "bug/ladder/ladder.html").exists()


def test_lammps_declines_what_its_deck_cannot_say():
    source = EXAMPLES / "lammps/run_lammps.py"
    spec = importlib.util.spec_from_file_location("run_lammps", source)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    paper = load_case(REFERENCE)
    contact = paper.resolved["contact"]

    def lacking(**tables):
        return module.what_is_lacking(varied_table(paper, **tables).resolved)

    def particles(**values):
        return contact | {"particle_particle": contact["particle_particle"] | values}

    assert lacking() == ""
    assert "scheme.attraction" in lacking(scheme={"attraction": "clipped"})
    assert "scheme.bar_corner" in lacking(scheme={"bar_corner": "faces_only"})
    assert "scheme.inertia" in lacking(scheme={"inertia": "sphere"})
    assert "tensile_strength_N" in lacking(contact=particles(tensile_strength_N=0.1))
    assert "rolling_friction" in lacking(contact=particles(rolling_friction=0.1))
    assert "particle_particle" in lacking(contact=particles(normal_damping_N_s_m=0.0))


@pytest.mark.parametrize("path", sorted(EXAMPLES.glob("*/*.toml")), ids=lambda path: path.name)
def test_every_description_among_the_examples_is_sound(path):
    engine = read_engine(path)
    assert all((path.parent / name).is_file() for name in engine.files)
