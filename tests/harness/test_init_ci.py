"""crossdem init-ci: files that GitHub and CMake take, of which this repository's own workflow is one."""

import json
import os
import shutil
import subprocess
from pathlib import Path

import pytest
import yaml
from command_line import REFERENCE, ROOT, crossdem

from crossdem import __version__

WORKFLOW, SNIPPET = ".github/workflows/crossdem.yml", "cmake/crossdem.cmake"
DESCRIPTION = ROOT / "examples" / "tutorial" / "discs.toml"
ADDRESS = "https://example.org/crossdem.git"
WAYS = {
    "own code": ("--engine", "codes/my code.toml", "--source", f"{ADDRESS}#v0.1.0"),
    "cloned": ("cases/slope.toml", "--source", "git@example.org:dem/crossdem.git"),
    "in a folder": ("--source", "external/crossdem", "--tier", "nightly"),
    "this repository": ("--source", "."),
}


def repository(folder):
    """The files that WAYS name, in the top folder of a repository."""
    for name in (".git", "cases", "codes"):
        (folder / name).mkdir(parents=True, exist_ok=True)
    shutil.copy(REFERENCE, folder / "cases" / "slope.toml")
    shutil.copy(DESCRIPTION, folder / "codes" / "my code.toml")
    return folder


def written(folder, *arguments):
    ended = crossdem("init-ci", *arguments, "--out", repository(folder))
    assert ended.returncode == 0, ended.stderr
    return folder


def refused(folder, *arguments):
    """What is said against it; nothing is written."""
    ended = crossdem("init-ci", *arguments, "--out", folder)
    assert ended.returncode == 2
    assert not (folder / WORKFLOW).exists() and not (folder / SNIPPET).exists()
    return ended.stderr


def steps_of(folder):
    return yaml.safe_load((folder / WORKFLOW).read_text())["jobs"]["crossdem"]["steps"]


def test_the_workflow_of_this_repository_is_what_it_writes(tmp_path):
    written(tmp_path, *WAYS["this repository"])
    assert (ROOT / WORKFLOW).read_text() == (tmp_path / WORKFLOW).read_text()


@pytest.mark.parametrize("way", WAYS)
def test_a_workflow_follows_githubs_schema(way, tmp_path):
    workflow = written(tmp_path, *WAYS[way]) / WORKFLOW
    assert faults_of(workflow) == []


def faults_of(workflow):
    node = ["node", ROOT / "tests" / "browser" / "workflow.mjs", workflow]
    said = subprocess.run(node, capture_output=True, text=True, check=True, timeout=60)
    return json.loads(said.stdout)


@pytest.mark.parametrize(
    "right, wrong", [("runs-on:", "run-on:"), ("      - name: Git", "      - nam: Git")]
)
def test_the_schema_notices_what_it_does_not_know(right, wrong, tmp_path):
    workflow = written(tmp_path, *WAYS["own code"]) / WORKFLOW
    workflow.write_text(workflow.read_text().replace(right, wrong))
    assert faults_of(workflow)


@pytest.mark.parametrize("way", WAYS)
def test_its_steps_are_shell_and_take_names_from_the_environment(way, tmp_path):
    steps = [step["run"] for step in steps_of(written(tmp_path, *WAYS[way])) if "run" in step]
    for step in steps:
        subprocess.run(["bash", "-n", "-c", step], check=True, timeout=10)
        assert "my code" not in step and "example.org" not in step and "slope" not in step


def test_its_commands_are_commands_of_crossdem(tmp_path):
    commands = set()
    for way, arguments in WAYS.items():
        for step in steps_of(written(tmp_path / way, *arguments)):
            if '/crossdem" ' in (run := step.get("run", "")):
                words = run.split()
                commands.add((words[1], *(word for word in words if word.startswith("--"))))
    assert {command for command, *_ in commands} == {"check", "conform"}
    for command, *options in commands:
        offered = crossdem(command, "--help").stdout
        assert all(option in offered for option in options)


def test_a_file_that_is_there_is_not_replaced_unless_forced(tmp_path):
    written(tmp_path, *WAYS["own code"])
    written(tmp_path, *WAYS["own code"])  # nothing to say against the same
    (tmp_path / WORKFLOW).write_text("mine")
    ended = crossdem("init-ci", *WAYS["own code"], "--out", tmp_path)
    assert ended.returncode == 2
    assert WORKFLOW in ended.stderr and "--force" in ended.stderr
    assert (tmp_path / WORKFLOW).read_text() == "mine"
    written(tmp_path, *WAYS["own code"], "--force")
    assert (tmp_path / WORKFLOW).read_text() != "mine"


@pytest.mark.parametrize("option", ["case", "--engine", "--source"])
@pytest.mark.parametrize(
    "text", ["a$(touch x)", "a'; b", 'a" b', "${{ secrets.X }}", "a\nb: c", "a;b", "a\\", "`a`"]
)
def test_texts_that_could_be_code_are_refused(option, text, tmp_path):
    given = {"--source": "."} | ({} if option == "case" else {option: text})
    arguments = [word for pair in given.items() for word in pair]
    ended = crossdem(
        "init-ci", *([text] if option == "case" else []), *arguments, "--out", tmp_path
    )
    assert ended.returncode == 2
    assert "cannot stand in a workflow" in ended.stderr
    assert not list(tmp_path.iterdir())


def test_without_an_address_it_asks_for_one(tmp_path):
    """As in a checkout that was cloned from a folder."""
    ended = crossdem(
        "init-ci", "--out", tmp_path, GIT_CONFIG_GLOBAL="/dev/null", GIT_DIR=str(tmp_path)
    )
    assert ended.returncode == 2
    assert "--source ADDRESS#TAG" in ended.stderr


@pytest.mark.parametrize(
    "arguments, said",
    [
        (("--engine", "codes/none.toml"), "codes/none.toml"),
        (("--engine", "codes/none.py:Mine"), "is no Python file"),
        (("--engine", "codes/typo.toml"), "comand"),
        (("cases/none.toml",), "cases/none.toml"),
        (("cases/typo.toml",), "dimensionn"),
        (("empty",), "holds no case"),
        (("--engine", "codes/my code.toml", "cases"), "cases"),
    ],
)
def test_an_engine_or_case_that_cannot_be_read_is_refused(arguments, said, tmp_path):
    repository(tmp_path)
    (tmp_path / "empty").mkdir()
    (tmp_path / "codes" / "typo.toml").write_text(f'comand = "x"\n{DESCRIPTION.read_text()}')
    (tmp_path / "cases" / "typo.toml").write_text(f"dimensionn = 2\n{REFERENCE.read_text()}")
    assert said in refused(tmp_path, *arguments, "--source", ADDRESS)


@pytest.mark.parametrize("option", ["CASE", "--engine", "--source"])
@pytest.mark.parametrize("way", ["absolute", "above"])
def test_a_path_that_leads_out_of_the_repository_is_refused(option, way, tmp_path):
    repository(tmp_path / "other")
    path = {
        "CASE": "other/cases/slope.toml",
        "--engine": "other/codes/my code.toml",
        "--source": "other",
    }[option]
    given = tmp_path / path if way == "absolute" else Path("..") / path
    source = () if option == "--source" else ("--source", ADDRESS)
    arguments = (given,) if option == "CASE" else (option, given)
    said = refused(repository(tmp_path / "mine"), *arguments, *source)
    assert f"{option}: {given} is not in the repository" in said


def test_a_case_of_crossdem_itself_need_not_be_there_yet(tmp_path):
    written(tmp_path, "crossdem/reference_cases/micro", "--source", ADDRESS)


def test_outside_the_top_of_a_git_repository_it_warns(tmp_path):
    arguments = ("init-ci", "--source", f"{ADDRESS}#v1", "--out")
    ended = crossdem(*arguments, tmp_path)
    assert ended.returncode == 0
    assert f"warning: {tmp_path} is not the top of a git repository" in ended.stdout
    assert "warning" not in crossdem(*arguments, repository(tmp_path)).stdout


def test_a_tag_that_was_not_given_is_named(tmp_path):
    said = crossdem("init-ci", "--source", ADDRESS, "--out", tmp_path / "a").stdout
    assert f"assumed: the tag v{__version__} of {ADDRESS}. It must exist there" in said
    said = crossdem("init-ci", "--source", f"{ADDRESS}#v7", "--out", tmp_path / "b").stdout
    assert "assumed" not in said


def test_out_that_is_a_file_is_refused(tmp_path):
    (tmp_path / "file").touch()
    ended = crossdem("init-ci", "--source", ".", "--out", tmp_path / "file")
    assert ended.returncode == 2
    assert "is a file" in ended.stderr


def test_a_pipe_in_the_place_of_a_file_is_not_waited_for(tmp_path):
    (tmp_path / "cmake").mkdir()
    os.mkfifo(tmp_path / SNIPPET)
    ended = crossdem("init-ci", "--source", ADDRESS, "--out", tmp_path)
    assert ended.returncode == 2
    assert SNIPPET in ended.stderr and "--force" in ended.stderr


@pytest.mark.parametrize("way, page", [("own code", "conform.md"), ("cloned", "report.md")])
def test_the_summary_is_the_page_if_there_is_one(way, page, tmp_path):
    steps = {step.get("name"): step for step in steps_of(written(tmp_path, *WAYS[way]))}
    summary = tmp_path / "summary"
    for text in ("", "# AGREES"):
        if text:
            (tmp_path / "results" / "crossdem").mkdir(parents=True)
            (tmp_path / "results" / "crossdem" / page).write_text(text)
        subprocess.run(
            ["bash", "-eo", "pipefail", "-c", steps["Summary"]["run"]],
            cwd=tmp_path,
            env={**os.environ, "GITHUB_STEP_SUMMARY": str(summary)},
            check=True,
        )
        assert (summary.read_text() if summary.exists() else "") == text


CMAKE = """\
cmake_minimum_required(VERSION 3.20)
project(mine NONE)
enable_testing()
include(cmake/crossdem.cmake)
"""
STAND_IN = '#!/bin/sh\nprintf "%s|" "$@" >"$0.said"\nexit "${CROSSDEM_ENDS:-0}"\n'


@pytest.mark.parametrize("way, command", [("own code", "conform"), ("in a folder", "check")])
def test_the_snippet_adds_a_test_that_runs_crossdem_where_it_is(
    way, command, tmp_path, monkeypatch
):
    """A stand-in for crossdem writes down what it was asked."""
    written(tmp_path, *WAYS[way])
    (tmp_path / "CMakeLists.txt").write_text(CMAKE)
    where = tmp_path / ("external/crossdem" if way == "in a folder" else "crossdem")
    where.mkdir(parents=True)
    (where / "crossdem").write_text(STAND_IN)
    (where / "crossdem").chmod(0o755)
    build = tmp_path / "build"
    subprocess.run(["cmake", "-S", tmp_path, "-B", build], check=True, capture_output=True)
    ctest = ["ctest", "--test-dir", build, "-L", "crossdem"]
    assert "100% tests passed" in subprocess.run(ctest, capture_output=True, text=True).stdout
    said = (where / "crossdem.said").read_text().split("|")
    assert said[0] == command
    assert Path(said[said.index("--out") + 1]) == build / "crossdem"
    monkeypatch.setenv("CROSSDEM_ENDS", "1")
    assert subprocess.run(ctest, capture_output=True).returncode != 0


@pytest.mark.parametrize("engine", [(), ("--engine", "codes/my code.toml")])
def test_crossdem_on_the_path_is_asked_for_its_own_reference_case(engine, tmp_path, monkeypatch):
    """It stands there as a link into the folder that it is part of."""
    mine = written(tmp_path / "mine", *engine, "--source", ADDRESS)
    (mine / "CMakeLists.txt").write_text(CMAKE)
    folder, path = tmp_path / "elsewhere", tmp_path / "bin"
    folder.mkdir()
    path.mkdir()
    (folder / "crossdem").write_text(STAND_IN)
    (folder / "crossdem").chmod(0o755)
    (path / "crossdem").symlink_to(folder / "crossdem")
    monkeypatch.setenv("PATH", f"{path}:{os.environ['PATH']}")
    build = mine / "build"
    subprocess.run(["cmake", "-S", mine, "-B", build], check=True, capture_output=True)
    subprocess.run(["ctest", "--test-dir", build], check=True, capture_output=True)
    command, first, second, *_ = (path / "crossdem.said").read_text().split("|")
    if engine:
        assert (command, first, second) == ("conform", "codes/my code.toml", "--tier")
    else:
        reference = folder / "reference_cases" / "bar_penetration.toml"
        assert (command, first) == ("check", str(reference))


def test_without_crossdem_the_snippet_says_so_and_adds_nothing(tmp_path, monkeypatch):
    monkeypatch.setenv("PATH", "/usr/bin:/bin")
    written(tmp_path, *WAYS["in a folder"])
    (tmp_path / "CMakeLists.txt").write_text(CMAKE)
    configure = ["cmake", "-S", tmp_path, "-B", tmp_path / "build"]
    said = subprocess.run(configure, check=True, capture_output=True, text=True).stdout
    assert "crossdem is neither on the PATH nor in external/crossdem" in said
    listed = subprocess.run(
        ["ctest", "--test-dir", tmp_path / "build", "-N"], capture_output=True, text=True
    )
    assert "Total Tests: 0" in listed.stdout
