"""A cluster of its own for each test: must be had in CI; elsewhere its tests are skipped, and say what to install."""

import os
import sys
import tempfile
from pathlib import Path

import pytest
from loopback import Loopback, missing_packages

sys.path.insert(0, str(Path(__file__).parents[1] / "harness"))  # small_case.py, command_line.py


@pytest.fixture
def cluster_folder():
    """With a short path, as sockets lie in it."""
    if lacking := missing_packages():
        complaint = f"no Slurm here: apt-get install {' '.join(lacking)}"
        assert not os.environ.get("CI"), complaint
        pytest.skip(complaint)
    with tempfile.TemporaryDirectory(prefix="crossdem-slurm-") as folder:
        yield Path(folder)


@pytest.fixture
def cluster(cluster_folder):
    with Loopback(cluster_folder) as running:
        yield running
