"""A case small enough that real runs take a second, its packing, and an engine with faults."""

import os
import shutil
from pathlib import Path

import pytest
from hypothesis import HealthCheck, Phase, settings
from small_case import small_case

from crossdem.adapters.packing import make_packing

HERE = Path(__file__).parent

# Always the same examples; CROSSDEM_EXAMPLES is how many. What a fixture gives is restored by the tests themselves.
settings.register_profile(
    "crossdem",
    derandomize=True,
    phases=[Phase.explicit, Phase.generate],  # to shrink a case takes longer than a test may
    database=None,
    deadline=None,
    max_examples=int(os.environ.get("CROSSDEM_EXAMPLES", "25")),
    suppress_health_check=list(HealthCheck),
)
settings.load_profile("crossdem")


@pytest.fixture(scope="session")
def case():
    return small_case()


@pytest.fixture(scope="session")
def packing(case, tmp_path_factory):
    return make_packing(case, 1, tmp_path_factory.mktemp("packings") / "seed1")


@pytest.fixture
def fake(tmp_path, monkeypatch):
    """Puts the fake LIGGGHTS first on the PATH; gives a function that sets its fault, and how often it started."""
    programs = tmp_path / "bin"
    programs.mkdir()
    shutil.copy(HERE / "fake_liggghts.py", programs / "liggghts")
    monkeypatch.setenv("PATH", f"{programs}:{os.environ['PATH']}")
    monkeypatch.setenv("FAKE_STARTS", str(tmp_path / "starts"))
    return Fake(monkeypatch, tmp_path / "starts")


class Fake:
    def __init__(self, monkeypatch, starts):
        self._monkeypatch = monkeypatch
        self._starts = starts

    def fault(self, name):
        self._monkeypatch.setenv("FAKE_FAULT", name)

    def process_ids(self):
        return (
            [int(line) for line in self._starts.read_text().split()]
            if self._starts.exists()
            else []
        )
