"""The faults that the nightly tests seed are texts of the sources as they are now."""

import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "tests" / "mutation"))

from faults import FAULTS  # noqa: E402


@pytest.mark.parametrize("fault", FAULTS, ids=lambda fault: fault.slug)
def test_a_fault_has_its_one_place_in_the_sources(fault):
    assert (ROOT / "solver" / "src" / fault.file).read_text().count(fault.right) == 1
    assert fault.wrong != fault.right
