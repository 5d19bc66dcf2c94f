"""A case small enough that real runs take a second, and its packing."""

import pytest
from small_case import small_case

from crossdem.adapters.packing import make_packing


@pytest.fixture(scope="session")
def case():
    return small_case()


@pytest.fixture(scope="session")
def packing(case, tmp_path_factory):
    return make_packing(case, 1, tmp_path_factory.mktemp("packings") / "seed1")
