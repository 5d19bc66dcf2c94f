"""The command line on good input: exit codes, output folder, reuse, interruption. Only the native engine runs here."""

import errno
import fcntl
import json
import os
import signal
import subprocess
import time
from importlib.metadata import version

import pytest
from command_line import REFERENCE, ROOT, crossdem
from test_workflow import alive, wait_for

from crossdem import ExitCode, __version__
from crossdem.adapters.case import load_case
from crossdem.adapters.solver import find_solver

SMALL = ["particles.count=100", "time.penetration_s=0.2", "time.rest_s=0.1"]
OVERRIDES = [word for override in SMALL for word in ("--set", override)]
QUICK = [REFERENCE, *OVERRIDES, "--engines", "native"]


@pytest.fixture(scope="module")
def finished(tmp_path_factory):
    """The output folder of `crossdem run` with two seeds."""
    out = tmp_path_factory.mktemp("cli") / "out"
    ended = crossdem("run", *QUICK, "--seeds", "2", "--out", out)
    assert ended.returncode == 0, ended.stderr
    return out


def _datasets(out):
    return sorted((out / "runs").iterdir())


def _without_engines(tmp_path):
    """A PATH with all that the launcher needs, and no engine."""
    for name in ("dirname", "readlink"):
        (tmp_path / name).symlink_to(f"/usr/bin/{name}")
    return str(tmp_path)


def test_version():
    assert crossdem("--version").stdout.split() == ["crossdem,", "version", __version__]


@pytest.mark.parametrize(
    "command",
    [
        "check",
        "run",
        "generate",
        "resolve",
        "compare",
        "explain",
        "horizon",
        "stability",
        "bench",
        "doctor",
    ],
)
def test_every_command_explains_itself(command):
    ended = crossdem(command, "--help")
    assert ended.returncode == 0 and "Usage: crossdem " + command in ended.stdout
    assert "--profile NAME" in ended.stdout or "--profile" not in ended.stdout


def test_an_unknown_command_is_bad_input():
    ended = crossdem("penetrate")
    assert ended.returncode == ExitCode.BAD_INPUT
    assert "No such command" in ended.stderr


def test_the_launcher_works_from_any_folder_by_a_link_and_with_an_empty_environment(tmp_path):
    link = tmp_path / "crossdem"
    link.symlink_to(ROOT / "crossdem")
    ended = subprocess.run([link, "--version"], cwd=tmp_path, env={}, capture_output=True)
    assert ended.returncode == 0, ended.stderr


def test_resolve_prints_the_canonical_case():
    ended = crossdem("resolve", REFERENCE)
    assert ended.returncode == 0
    assert ended.stdout.encode() == load_case(REFERENCE).canonical + b"\n"


def test_a_warning_of_the_solver_reaches_the_user():
    ended = crossdem("resolve", REFERENCE, "--set", "time.step_s=2e-4")
    assert ended.returncode == 0
    assert "warning: time.step_s" in ended.stderr


def test_doctor_knows_the_solver_and_what_runs_the_engines():
    said = dict(line.split(maxsplit=1) for line in crossdem("doctor").stdout.splitlines())
    assert said["native"].startswith("crossdem-solver ")
    assert said["snakemake"] == version("snakemake")


def test_doctor_says_what_to_install(tmp_path):
    ended = crossdem("doctor", PATH=_without_engines(tmp_path))
    assert ended.returncode == ExitCode.ENGINE_FAILED
    assert "apt install liggghts" in ended.stdout


def test_a_run_leaves_a_dataset_per_seed(finished):
    names = [folder.name for folder in _datasets(finished)]
    assert [name.rsplit("-", 1)[0] for name in names] == ["native-seed1", "native-seed2"]
    assert json.loads((finished / "crossdem.json").read_text())["made_by"] == "crossdem"


def test_a_second_time_packings_and_runs_are_reused(finished):
    before = [folder.stat().st_mtime_ns for folder in _datasets(finished)]
    packings = [folder.stat().st_mtime_ns for folder in sorted((finished / "packings").iterdir())]
    ended = crossdem("run", *QUICK, "--seeds", "2", "--out", finished)
    assert ended.returncode == 0, ended.stderr
    assert [folder.stat().st_mtime_ns for folder in _datasets(finished)] == before
    assert [f.stat().st_mtime_ns for f in sorted((finished / "packings").iterdir())] == packings


def test_a_torn_packing_is_made_again(finished, tmp_path):
    table = next((finished / "packings").glob("seed1-*")) / "packing.csv"
    whole = table.read_bytes()
    table.write_bytes(whole[: len(whole) // 2])
    ended = crossdem("run", *QUICK, "--seeds", "1", "--out", finished)
    assert ended.returncode == 0, ended.stderr
    assert table.read_bytes() == whole


def test_one_engine_alone_is_inconclusive_and_has_a_report(finished):
    ended = crossdem("check", *QUICK, "--seeds", "2", "--out", finished)
    assert ended.returncode == ExitCode.INCONCLUSIVE, ended.stderr
    for name in ("report.html", "report.md", "report.json", "junit.xml"):
        assert (finished / name).stat().st_size > 0
    assert str(finished / "report.html") in ended.stdout


def test_compare_takes_the_datasets_of_a_run(finished, tmp_path):
    ended = crossdem("compare", *_datasets(finished), cwd=tmp_path)
    assert ended.returncode == ExitCode.INCONCLUSIVE, ended.stderr
    assert (tmp_path / "results" / "bar_penetration-compare" / "report.html").exists()


def test_compare_refuses_the_same_run_twice(finished, tmp_path):
    run = _datasets(finished)[0]
    ended = crossdem("compare", run, run, cwd=tmp_path)
    assert ended.returncode == ExitCode.BAD_INPUT
    assert "native, seed 1: given more than once" in ended.stderr
    assert not any(tmp_path.iterdir())


def test_a_missing_engine_does_not_stop_the_others(tmp_path):
    out = tmp_path / "out"
    path = _without_engines(tmp_path)
    case = [REFERENCE, *OVERRIDES]
    ended = crossdem(
        "run", *case, "--engines", "liggghts,native", "--seeds", "1", "--out", out, PATH=path
    )
    assert ended.returncode == ExitCode.ENGINE_FAILED
    assert "liggghts, seed 1: liggghts is not installed: apt install liggghts" in ended.stderr
    assert [folder.name.split("-")[0] for folder in _datasets(out)] == ["native"]


def test_a_packing_that_does_not_settle_is_told_for_each_run(tmp_path):
    short = ["--set", "packing.settling_s=0.01", "--set", "packing.longest_settling_s=0.02"]
    ended = crossdem("run", *QUICK, *short, "--seeds", "1", "--out", tmp_path / "out")
    assert ended.returncode == ExitCode.ENGINE_FAILED
    assert "native, seed 1: " in ended.stderr and "did not settle" in ended.stderr


def test_generate_writes_inputs_and_the_command_to_run_them(tmp_path):
    ended = crossdem("generate", REFERENCE, *OVERRIDES, "--seeds", "1", "--out", tmp_path / "out")
    assert ended.returncode == 0, ended.stderr
    folders = sorted((tmp_path / "out" / "inputs").iterdir())
    assert [folder.name.split("-")[0] for folder in folders] == ["liggghts", "native", "yade"]
    for folder in folders:
        assert (folder / "inputs" / "case.json").exists()
        assert (folder / "README.txt").exists()
        assert list((folder / "output").iterdir()) == []
    assert not (tmp_path / "out" / "runs").exists()


def test_by_default_results_lie_under_the_case_name_and_variants_apart(tmp_path):
    ended = crossdem("generate", *QUICK, "--seeds", "1", cwd=tmp_path)
    assert ended.returncode == 0, ended.stderr
    variant = load_case(REFERENCE, SMALL).hash[:8]
    assert [place.name for place in (tmp_path / "results").iterdir()] == [
        f"bar_penetration-{variant}"
    ]


def test_without_the_solver_it_says_how_to_get_it(tmp_path):
    ended = crossdem("resolve", REFERENCE, CROSSDEM_SOLVER=str(tmp_path / "none"))
    assert ended.returncode == ExitCode.ENGINE_FAILED
    assert "CROSSDEM_SOLVER" in ended.stderr


@pytest.mark.parametrize("number, code", [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_an_interrupted_run_ends_at_once_and_leaves_nothing_that_looks_complete(
    tmp_path, number, code
):
    long = ["--set", "time.penetration_s=9", "--engines", "native", "--seeds", "1"]
    out = tmp_path / "out"
    running = subprocess.Popen(
        [ROOT / "crossdem", "run", REFERENCE, *long, "--out", out],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
    )
    deadline = time.monotonic() + 60
    while not list(out.glob("runs/.*.work/output/resistance.csv")):
        assert running.poll() is None and time.monotonic() < deadline
        time.sleep(0.05)
    running.send_signal(number)
    _, said = running.communicate(timeout=30)
    assert running.returncode == code
    assert said.strip().startswith("interrupted; what is finished is kept")
    assert not list(out.glob("runs/[!.]*"))


def test_a_kill_while_settling_leaves_no_solver_and_the_next_call_no_unfinished_packing(tmp_path):
    solver, mark, out = tmp_path / "solver", tmp_path / "process", tmp_path / "out"
    settle = (
        f'[ "$1" = pack ] && {{ echo $$ >"{mark}.new"; mv "{mark}.new" "{mark}"; exec sleep 600; }}'
    )
    solver.write_text(f'#!/bin/sh\n{settle}\nexec {find_solver()} "$@"\n')
    solver.chmod(0o755)
    command = [ROOT / "crossdem", "run", *QUICK, "--seeds", "1", "--out", out]
    running = subprocess.Popen(command, env={**os.environ, "CROSSDEM_SOLVER": str(solver)})
    wait_for(mark.exists)
    running.kill()
    running.wait()
    wait_for(lambda: not alive(int(mark.read_text())), "the solver goes on")
    assert len(list((out / "packings").glob(".seed1-*"))) == 1
    ended = crossdem(*command[1:])
    assert ended.returncode == 0, ended.stderr
    assert len(list((out / "packings").iterdir())) == 1


def test_files_of_the_user_are_not_taken_for_modules_of_the_same_name(tmp_path):
    for name in ("snakemake.py", "pandas.py", "crossdem.py"):
        (tmp_path / name).write_text("raise SystemExit('taken for a module')")
    ended = crossdem("run", *QUICK, "--seeds", "1", "--out", "out", cwd=tmp_path)
    assert ended.returncode == ExitCode.AGREES, ended.stderr


def test_two_at_a_time_do_not_share_an_output_folder(finished):
    with open(finished / "crossdem.json") as marker:
        fcntl.flock(marker, fcntl.LOCK_EX)
        ended = crossdem("run", *QUICK, "--seeds", "1", "--out", finished)
    assert ended.returncode == ExitCode.BAD_INPUT
    assert "another crossdem is writing to it" in ended.stderr


def test_what_the_system_refuses_is_no_bug(monkeypatch, capsys):
    from crossdem.compare import cli, commands

    def full(**_):
        raise OSError(errno.ENOSPC, "No space left on device", "out/plan.json")

    monkeypatch.setattr(commands, "resolve", full)
    assert cli.main(["resolve", str(REFERENCE)]) == ExitCode.SYSTEM
    [line] = capsys.readouterr().err.splitlines()
    assert "No space left on device: 'out/plan.json'" in line and "repeat the command" in line


def test_a_bug_is_called_a_bug(tmp_path, monkeypatch, capsys):
    from crossdem.compare import cli, commands

    def broken(**_):
        raise AssertionError("two plus two")

    monkeypatch.setattr(commands, "resolve", broken)
    assert cli.main(["resolve", str(REFERENCE)]) == ExitCode.BUG
    assert "this is a bug in crossdem; please report it" in capsys.readouterr().err
