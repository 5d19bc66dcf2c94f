"""A run's README names one command that runs it again, in the folder as it is, and gives the same."""

import os
import shutil
import subprocess

import numpy as np
import pytest
from small_case import small_case

from crossdem.adapters.dataset import Dataset
from crossdem.adapters.packing import make_packing
from crossdem.adapters.run import RunRequest, run_all
from crossdem.adapters.run_folder import prepare
from crossdem.adapters.solver import find_solver


@pytest.fixture(scope="module")
def case():
    return small_case()


@pytest.fixture(scope="module")
def packing(case, tmp_path_factory):
    return make_packing(case, 1, tmp_path_factory.mktemp("packing") / "seed1")


def run_by_hand(folder):
    """What README.txt of `folder` says, in a shell, crossdem-solver being on the PATH."""
    [command] = [
        line.strip()
        for line in (folder / "README.txt").read_text().splitlines()
        if line.startswith("    ")
    ]
    path = f"{find_solver().parent}:{os.environ['PATH']}"
    environment = {"PATH": path, "HOME": os.environ["HOME"]}
    subprocess.run(["bash", "-c", command], cwd=folder, env=environment, check=True, timeout=120)


def test_a_finished_run_runs_again_by_hand_and_gives_the_same(engine, case, packing, tmp_path):
    [result] = run_all([RunRequest(case, packing, engine.name)], tmp_path / "out", 1)
    assert result.status == "done", result.failure
    run = Dataset.read(result.dataset_folder)
    moved = shutil.copytree(result.dataset_folder, tmp_path / "elsewhere")
    run_by_hand(moved)
    again = engine.read_output(case, packing, moved, run.manifest)
    assert again.resistance.equals(run.resistance)
    assert np.array_equal(again.motion.position_m, run.motion.position_m)


def test_prepared_input_runs_by_hand(engine, case, packing, tmp_path):
    prepare(case, packing, engine, tmp_path / "run")
    run_by_hand(tmp_path / "run")
    assert len(
        (tmp_path / "run" / engine.samples_file).read_text().splitlines()
    ) == engine.lines_in_all(case)
