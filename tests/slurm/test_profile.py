"""The scripts of the profile for Slurm, with commands of Slurm that answer what the test wants."""

import os
import subprocess
from pathlib import Path

import pytest
from test_workflow import wait_for

PROFILE = Path(__file__).parents[2] / "adapters" / "workflow" / "slurm"
JOB = "7:crossdem-0123456789ab"
RECORD = "JobId=7 JobName=crossdem-0123456789ab UserId=me(1) JobState={} Reason=None"
AWAY = "slurm_load_jobs error: Unable to contact slurm controller (connect failure)"
FORGOTTEN = "slurm_load_jobs error: Invalid job id specified"


@pytest.fixture
def call(tmp_path):
    """A function that calls a script of the profile among the commands given as shell text; its output and exit status."""
    commands = tmp_path / "commands"
    commands.mkdir()

    def run(script, *arguments, environment={}, **texts):
        for name in ("sbatch", "squeue", "scontrol", "scancel"):
            text = texts.get(name, f"echo unexpected {name} >&2; exit 99")
            (commands / name).write_text(f"#!/bin/bash\n{text}\n")
            (commands / name).chmod(0o755)
        done = subprocess.run(
            [PROFILE / script, *arguments],
            cwd=tmp_path,
            env={**os.environ, "PATH": f"{commands}:/usr/bin:/bin", **environment},
            capture_output=True,
            text=True,
            timeout=60,
        )
        return done.stdout.strip(), done.returncode

    return run


@pytest.mark.parametrize(
    "state, answer",
    [
        *((state, "running") for state in ("PENDING", "RUNNING", "COMPLETING", "SUSPENDED")),
        *((state, "running") for state in ("REQUEUED", "CONFIGURING", "A_STATE_OF_THE_FUTURE")),
        ("COMPLETED", "success"),
        *((state, "failed") for state in ("FAILED", "CANCELLED", "TIMEOUT", "NODE_FAIL")),
        *((state, "failed") for state in ("OUT_OF_MEMORY", "PREEMPTED", "BOOT_FAIL", "DEADLINE")),
    ],
)
def test_status_follows_the_state(call, state, answer):
    assert call("status", JOB, scontrol=f"echo '{RECORD.format(state)}'") == (answer, 0)


def test_a_job_goes_on_while_the_controller_is_away(call):
    assert call("status", JOB, scontrol=f"echo '{AWAY}' >&2; exit 1") == ("running", 0)


def test_a_job_that_slurm_has_forgotten_has_failed(call):
    assert call("status", JOB, scontrol=f"echo '{FORGOTTEN}' >&2; exit 1") == ("failed", 0)


def test_a_job_of_another_name_is_another_job(call):
    record = RECORD.format("RUNNING").replace("0123456789ab", "ba9876543210")
    assert call("status", JOB, scontrol=f"echo '{record}'") == ("failed", 0)


def test_the_mark_of_a_job_is_worth_more_than_its_record(call, tmp_path):
    (tmp_path / "slurm").mkdir()
    (tmp_path / "slurm" / "crossdem-0123456789ab.done").touch()
    assert call("status", JOB, scontrol=f"echo '{RECORD.format('NODE_FAIL')}'") == ("success", 0)


def test_submit_says_by_what_the_job_is_known(call, tmp_path):
    printed, status = call(
        *("submit", "--mem=5M", "job.sh"),
        environment={"CROSSDEM_SBATCH": "--mem=9M --nice"},
        sbatch='printf "%s\\n" "$@" >arguments; echo "12;cluster"',
    )
    job, name = printed.split(":")
    given = (tmp_path / "arguments").read_text().split()
    assert (job, status) == ("12", 0)
    assert f"--job-name={name}" in given and "--no-requeue" in given
    assert given[-4:] == ["--mem=5M", "--mem=9M", "--nice", "job.sh"]


def test_submit_waits_for_a_controller_that_is_away(call):
    away = "[ -e tried ] && { echo 12; exit; }; touch tried; exit 1"
    printed, _ = call("submit", "job.sh", sbatch=away, squeue="exit 1", scontrol="exit 1")
    assert printed.startswith("12:")


def test_submit_hands_in_no_job_twice(call, tmp_path):
    """The controller took the job, and its answer got lost."""
    lost = "echo once >>tries; exit 1"
    printed, _ = call(
        "submit", "job.sh", sbatch=lost, squeue='[[ "$*" = *--name=crossdem-* ]] && echo 12'
    )
    assert printed.startswith("12:")
    assert (tmp_path / "tries").read_text() == "once\n"


def test_submit_gives_up_on_a_job_that_slurm_refuses(call):
    up = "echo 'Slurmctld(primary) at here is UP'"
    assert call("submit", "job.sh", sbatch="exit 1", squeue="", scontrol=up) == ("", 1)


def test_cancel_names_the_jobs_alone(call, tmp_path):
    cancelled = 'echo "$@" >part; mv part cancelled'
    assert call("cancel", JOB, "8:crossdem-1", scancel=cancelled) == ("", 0)
    wait_for((tmp_path / "cancelled").exists)
    assert (tmp_path / "cancelled").read_text() == "--quiet 7 8\n"


def test_a_job_is_marked_when_it_went_well(tmp_path):
    (tmp_path / "slurm").mkdir()
    template = (PROFILE / "jobscript.sh").read_text()
    for task, mark in (("true && exit 0 || exit 1", True), ("false && exit 0 || exit 1", False)):
        script = template.format(properties="{}", exec_job=task)
        done = subprocess.run(
            ["sh", "-c", script], cwd=tmp_path, env={"SLURM_JOB_NAME": str(mark)}, timeout=60
        )
        assert (done.returncode == 0) == mark
        assert (tmp_path / "slurm" / f"{mark}.done").exists() == mark
