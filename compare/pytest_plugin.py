"""The fixture `crossdem_check` of pytest: a test of one line for a code of one's own. docs/ci.md tells how to have it."""

from __future__ import annotations

import inspect
import os
from pathlib import Path

import pytest
from rich.console import Console

from crossdem.adapters.case import CaseError, load_case
from crossdem.adapters.engine import EngineNotFound
from crossdem.adapters.engine_file import EngineFileError
from crossdem.adapters.engines import attach
from crossdem.adapters.names import unknown_name
from crossdem.adapters.solver import SolverError
from crossdem.adapters.workspace import Workspace

from .recorded import RECORDS
from .runs import TIERS, cores

REFERENCE_CASE = RECORDS.parent / "bar_penetration.toml"


@pytest.fixture
def crossdem_check(request, tmp_path):
    """crossdem_check(engine, case=..., tier="smoke"): fails unless the code holds on the ladder and agrees on the bed.

    `engine` is FILE.toml, FILE.py:CLASS, or the class itself. Files are looked for beside the test, then from the current
    folder. Gives the compare.conformity.Conformity, for tests that ask more.
    """

    def check(engine: str | Path | type, case: str | Path = REFERENCE_CASE, tier: str = "smoke"):
        from .conform_command import examine  # here: its solvers of equations take a second

        if tier not in TIERS:
            pytest.fail(unknown_name("tier", tier, TIERS), pytrace=False)
        folder = request.path.parent
        workspace = Workspace(tmp_path / "crossdem")
        quiet = Console(quiet=True)
        try:
            name = attach(_beside(folder, _description(engine)))
            asked = load_case(_beside(folder, str(case)))
            found, page = examine(name, asked, tier, None, workspace, cores(), quiet)
        except (CaseError, EngineFileError, EngineNotFound, SolverError) as error:
            raise pytest.fail.Exception(str(error), pytrace=False) from None  # without its causes
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


def _beside(folder: Path, named: str) -> str:
    """`named`, FILE or FILE:CLASS, in `folder` where the file is there; else as it is."""
    there = str(folder / named)
    files = (there, there.rpartition(":")[0])
    return there if any(map(os.path.isfile, files)) else named
