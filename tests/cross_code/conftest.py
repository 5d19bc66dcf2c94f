"""Real engines: each must be here in CI; elsewhere a missing one is skipped, and says so."""

import os
import sys
from pathlib import Path

import pytest

from crossdem.adapters.engine import EngineNotFound
from crossdem.adapters.engines import ENGINES, attach, get_engine
from crossdem.compare.bench_clocks import LAMMPS

attach(str(LAMMPS))  # by the door for users' codes; from here on an engine like the others

sys.path.insert(0, str(Path(__file__).parents[1] / "harness"))  # small_case.py


@pytest.fixture(params=list(ENGINES))
def engine(request):
    """Each engine in turn."""
    return _require(request.param)


@pytest.fixture(scope="session")
def required():
    """A function that ends the test unless this engine is here."""
    return _require


def _require(name):
    found = get_engine(name)
    try:
        found.version()
    except EngineNotFound as error:
        if os.environ.get("CI"):
            raise
        pytest.skip(str(error))
    return found
