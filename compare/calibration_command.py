"""`crossdem calibrate`: the judge on the recorded native runs, at the sizes that comparisons have."""

from __future__ import annotations

import multiprocessing
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import click
import pandas as pd

from crossdem import ExitCode
from crossdem.adapters.case import Case, CaseError
from crossdem.adapters.gates import REFERENCE

from .calibration import Calibration, Design, calibrate, dealt
from .calibration_report import print_calibration, write_calibration
from .calibration_tables import misses
from .checks import Check
from .ensemble import of_engine
from .recorded import Record

# Of the tiers; "nightly" also with the packings alone, for what twins are worth.
DESIGNS = (Design(4, 1), Design(16, 1), Design(16, 3))


def calibrate_case(
    case: Case, recorded: Record, splits: int, folder: Path, jobs: int | None
) -> ExitCode:
    checks = Check.of_case(case.resolved)
    if not checks:
        raise CaseError([f"{case.file_name}: check: there is none to be judged"])
    runs = of_engine(recorded.ensemble.endpoints, REFERENCE)
    found = calibrated(checks, runs, splits, jobs, DESIGNS)
    for design in DESIGNS:
        if design not in [one.design for one in found]:
            click.echo(
                f"{design}: not judged, as it takes {design.packings} recorded packings with {2 * design.runs} native "
                "runs each",
                err=True,
            )
    if not found:
        return ExitCode.INCONCLUSIVE
    page = write_calibration(case, recorded, found, splits, folder)
    print_calibration(found, splits, page)
    if misses(found):
        return ExitCode.DIFFERS
    return ExitCode.AGREES if len(found) == len(DESIGNS) else ExitCode.INCONCLUSIVE


def calibrated(
    checks: Sequence[Check],
    runs: pd.DataFrame,
    splits: int,
    jobs: int | None,
    designs: Sequence[Design],
) -> list[Calibration]:
    """Of each design that there are enough runs for; the same numbers however many processes compute them."""
    with ProcessPoolExecutor(jobs, multiprocessing.get_context("fork")) as pool:
        return [
            calibrate(checks, runs, design, found, pool)
            for design in designs
            if (found := dealt(runs, design, splits))
        ]
