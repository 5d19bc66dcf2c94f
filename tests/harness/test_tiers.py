"""How large an ensemble is: a tier, or numbers, or both, of which the numbers come first."""

import pytest
from click.testing import CliRunner
from command_line import REFERENCE, crossdem

from crossdem import ExitCode
from crossdem.adapters.case import CaseError
from crossdem.adapters.dataset import Dataset
from crossdem.adapters.workflow import snakemake
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
    monkeypatch.setattr(commands, "check_cluster", lambda profile: None)
    monkeypatch.setattr("crossdem.compare.runs.os.sched_getaffinity", lambda _: range(7))
    for name, options in (("here", []), ("there", ["--profile", "slurm"])):
        words = ["check", str(REFERENCE), "--jobs", "100", *options]
        cli.main([*words, "--out", str(tmp_path / name)])
    assert taken == [100, 100, 7, 7]


@pytest.mark.parametrize("command", ["check", "run", "record", "explain"])
@pytest.mark.parametrize(
    "ping, told",
    [
        ("echo 'Slurmctld(primary) at here is DOWN\n*** RESTORE ***'; exit 1", "here is DOWN"),
        ("exit 1", "scontrol ping says nothing"),
        ("echo 'scontrol: error: no server' >&2; exit 1", "error: no server"),
        ("exec sleep 60", "no answer after 0 s"),
        (None, "there is no scontrol here"),
    ],
    ids=["down", "mute", "error", "silent", "missing"],
)
def test_a_cluster_that_does_not_answer_is_told_before_anything_runs(
    tmp_path, monkeypatch, capsys, command, ping, told
):
    if ping:
        (tmp_path / "scontrol").write_text(f"#!/bin/sh\n{ping}\n")
        (tmp_path / "scontrol").chmod(0o755)
    monkeypatch.setattr(snakemake, "PING_S", 0.3)
    out = tmp_path / "out"
    words = [command, str(REFERENCE), "--profile", "slurm", "--out", str(out)]
    with monkeypatch.context() as only:  # cases are resolved by the solver, which needs no PATH
        only.setenv("PATH", f"{tmp_path}{':/usr/bin:/bin' if ping else ''}")
        ended = cli.main([*words, *(["--to", "yade"] if command == "explain" else [])])
    said = capsys.readouterr().err
    assert ended == ExitCode.ENGINE_FAILED
    assert said.startswith("--profile slurm: no Slurm controller answers") and told in said
    assert said.count("\n") == 1 and not out.exists()


def test_a_cluster_that_answers_is_taken(tmp_path, monkeypatch):
    (tmp_path / "scontrol").write_text("#!/bin/sh\necho 'Slurmctld(primary) at here is UP'\n")
    (tmp_path / "scontrol").chmod(0o755)
    monkeypatch.setenv("PATH", f"{tmp_path}:/usr/bin:/bin")
    snakemake.check_cluster("slurm")


def test_no_cluster_is_asked_for_runs_here_or_for_another_profile(tmp_path, monkeypatch):
    monkeypatch.setenv("PATH", str(tmp_path))
    for profile in (None, str(tmp_path)):
        snakemake.check_cluster(profile)


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
