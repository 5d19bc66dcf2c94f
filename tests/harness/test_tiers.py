"""How large an ensemble is: a tier, or numbers, or both, of which the numbers come first."""

import pytest
from click.testing import CliRunner
from command_line import REFERENCE, crossdem

from crossdem import ExitCode
from crossdem.adapters.case import CaseError
from crossdem.adapters.dataset import Dataset
from crossdem.compare import cli, commands

QUICK = ["particles.count=60", "time.penetration_s=0.1", "time.rest_s=0.1"]


@pytest.mark.parametrize("command", ["check", "run"])
@pytest.mark.parametrize(
    "options, seeds, twins",
    [
        ([], 2, 0),
        (["--tier", "smoke"], 4, 0),
        (["--tier", "nightly"], 16, 2),
        (["--tier", "release"], 32, 2),
        (["--seeds", "5", "--tier", "nightly"], 5, 2),
        (["--tier", "nightly", "--twins", "0"], 16, 0),
        (["--twins", "3"], 2, 3),
    ],
)
def test_numbers_come_before_the_tier(monkeypatch, command, options, seeds, twins):
    taken = {}
    monkeypatch.setattr(commands, command, lambda **options: taken.update(options))
    ended = CliRunner().invoke(cli.cli, [command, str(REFERENCE), *options])
    assert ended.exit_code == 0, ended.output
    assert (taken["seeds"], taken["twins"]) == (seeds, twins)


@pytest.mark.parametrize(
    "options, jobs", [([], 7), (["--jobs", "3"], 3), (["--profile", "slurm"], None)]
)
def test_a_profile_has_its_own_number_of_jobs(monkeypatch, options, jobs):
    taken = {}
    monkeypatch.setattr(commands, "run", lambda **options: taken.update(options))
    monkeypatch.setattr("crossdem.compare.runs.os.sched_getaffinity", lambda _: range(7))
    ended = CliRunner().invoke(cli.cli, ["run", str(REFERENCE), *options])
    assert ended.exit_code == 0, ended.output
    assert taken["jobs"] == jobs


def test_the_number_of_jobs_of_a_cluster_is_not_that_of_processes_here(monkeypatch, tmp_path):
    taken = []

    def settle(*arguments):
        taken.append(arguments[3])
        return [], {}

    def horizon_of_runs(*arguments):
        taken.append(arguments[4])
        raise CaseError(["far enough"])

    monkeypatch.setattr("crossdem.compare.runs.settle", settle)
    monkeypatch.setattr(commands, "horizon_of_runs", horizon_of_runs)
    monkeypatch.setattr("crossdem.compare.runs.os.sched_getaffinity", lambda _: range(7))
    for name, options in (("here", []), ("there", ["--profile", "slurm"])):
        words = ["check", str(REFERENCE), "--jobs", "100", *options]
        cli.main([*words, "--out", str(tmp_path / name)])
    assert taken == [100, 100, 7, 7]


def test_a_profile_that_is_not_there_is_bad_input(tmp_path):
    ended = crossdem("run", REFERENCE, "--profile", "slurmm", cwd=tmp_path)
    assert ended.returncode == ExitCode.BAD_INPUT
    assert "slurmm: neither slurm nor a folder with a config.yaml" in ended.stderr
    assert not any(tmp_path.iterdir())


def test_twins_are_runs_beside_those_of_the_packing_itself(tmp_path):
    overrides = [word for override in QUICK for word in ("--set", override)]
    size = ["--seeds", "1", "--twins", "2", "--engines", "native"]
    ended = crossdem("run", REFERENCE, *overrides, *size, "--out", tmp_path / "out")
    assert ended.returncode == 0, ended.stderr
    runs = [Dataset.read(folder) for folder in (tmp_path / "out" / "runs").iterdir()]
    assert sorted(run.twin for run in runs) == [0, 1, 2]
    starts = {run.twin: run.motion.position_m[0] for run in runs}
    assert 0 < abs(starts[1] - starts[0]).max() < 1e-9
