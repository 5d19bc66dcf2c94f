"""The fixture `crossdem_check` of pytest: a test of one line for a code of one's own. docs/ci.md tells how to have it."""

from __future__ import annotations

import inspect
from pathlib import Path

import pytest
from rich.console import Console

from crossdem.adapters.case import load_case
from crossdem.adapters.engines import attach
from crossdem.adapters.workspace import Workspace

from .recorded import RECORDS
from .runs import cores

REFERENCE_CASE = RECORDS.parent / "bar_penetration.toml"


@pytest.fixture
def crossdem_check(tmp_path):
    """crossdem_check(engine, case=..., tier="smoke"): fails unless the code holds on the ladder and agrees on the bed.

    `engine` is FILE.toml, FILE.py:CLASS, or the class itself. Gives the compare.conformity.Conformity, for tests that ask
    more.
    """

    def check(engine: str | Path | type, case: str | Path = REFERENCE_CASE, tier: str = "smoke"):
        from .conform_command import examine  # here: its solvers of equations take a second

        name = attach(_description(engine))
        workspace = Workspace(tmp_path / "crossdem")
        quiet = Console(quiet=True)
        found, page = examine(name, load_case(Path(case)), tier, None, workspace, cores(), quiet)
        if found.exit_code:
            told = [f"{found.word}: {name}, {found.version}: {found.message}"]
            told += [f"{rung.case}, {rung.name}: {rung.sentence}" for rung in found.differing]
            told += [f"Look first: {found.look_first}", f"Report: {page}"]
            pytest.fail("\n".join(told), pytrace=False)
        return found

    return check


def _description(engine: str | Path | type) -> str:
    if isinstance(engine, type):
        return f"{inspect.getsourcefile(engine)}:{engine.__name__}"
    return str(engine)
