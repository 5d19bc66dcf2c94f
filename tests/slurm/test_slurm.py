"""Nodes of a real Slurm die under the runs of `crossdem --profile slurm`: none is lost, none disturbs another."""

import os
import signal
from collections import Counter

from runs_on_cluster import RunsOnCluster

from crossdem.adapters.dataset import Dataset

SEEDS = 40
LONGER = ("time.rest_s=10",)  # a second and a half per run
ODD = "an out folder; {curly} * #"  # that no shell could be handed as it is


def at_work(attempts, processes):
    """The attempts of these processes that have not ended."""
    return [attempt for attempt in attempts if not attempt.how and attempt.process in processes]


def check_that_each_run_was_published_once(runs, seeds):
    attempts = runs.attempts()
    published = Counter(attempt.run for attempt in attempts if attempt.how == "published")
    assert len(published) == seeds and set(published.values()) == {1}
    folders = Counter(attempt.folder for attempt in attempts)
    assert set(folders.values()) == {1}, "two attempts worked in one folder"
    left = sorted(folder.name for folder in (runs.workspace / "runs").iterdir())
    assert left == sorted(published), "something else lies beside the datasets"
    datasets = [Dataset.read(runs.workspace / "runs" / name) for name in left]
    assert sorted(dataset.manifest["seed"] for dataset in datasets) == list(range(1, seeds + 1))


def test_forty_runs_survive_a_node_that_loses_power(cluster, tmp_path):
    with RunsOnCluster(cluster, tmp_path / ODD, SEEDS, 8, *LONGER) as runs:
        runs.wait_until(
            lambda attempts: any(attempt.how == "published" for attempt in attempts)
            and at_work(attempts, cluster.job_processes("node1"))
        )
        cluster.kill_node("node1")
        interrupted = [attempt for attempt in runs.attempts() if not attempt.how]
        status, output = runs.wait(timeout_s=240)
    assert status == 0, output
    check_that_each_run_was_published_once(runs, SEEDS)
    lost = [attempt for attempt in runs.attempts() if not attempt.how]
    assert lost and set(lost) <= set(interrupted), "no run was under way on the node when it died"
    tries = Counter(attempt.run for attempt in runs.attempts())
    assert {run for run, times in tries.items() if times > 1} == {attempt.run for attempt in lost}
    assert max(tries.values()) == 2
    assert cluster.nodes()["node1"].startswith("down")


def test_a_run_that_outlives_its_node_does_not_disturb_its_retry(cluster, tmp_path):
    seeds = 4
    for name in ("status", "cancel", "jobscript.sh"):  # of the user, where crossdem is started
        (tmp_path / name).write_text("#!/bin/sh\nexit 1\n")
        (tmp_path / name).chmod(0o755)
    with RunsOnCluster(cluster, tmp_path / ODD, seeds, seeds, "time.rest_s=25") as runs:
        runs.wait_until(lambda attempts: at_work(attempts, cluster.job_processes("node1")))
        cluster.kill_daemon("node1")
        orphans = cluster.job_processes("node1")
        for process in orphans:
            os.kill(process, signal.SIGSTOP)
        orphaned = at_work(runs.attempts(), orphans)
        runs.wait_until(
            lambda attempts: all(
                any(again.run == attempt.run and again != attempt for again in attempts)
                for attempt in orphaned
            )
        )
        for process in orphans:
            os.kill(process, signal.SIGCONT)
        status, output = runs.wait(timeout_s=120)
        assert status == 0, output
        runs.wait_until(lambda attempts: all(attempt.how for attempt in attempts))
    check_that_each_run_was_published_once(runs, seeds)
    endings = Counter(attempt.how for attempt in runs.attempts())
    assert set(endings) == {"published", "was there"}
    assert endings["was there"] >= len(orphaned) > 0
