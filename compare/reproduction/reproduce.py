"""`crossdem reproduce`: runs every study of the paper's claims and says what came of each claim."""

from __future__ import annotations

from dataclasses import dataclass

from rich.console import Console

from crossdem import ExitCode
from crossdem.adapters.case import Case, varied
from crossdem.adapters.workspace import Workspace

from ..progress import ProgressDisplay
from ..runs import here
from ..stability_runs import map_stability
from . import (
    assumptions,
    hard_balls,
    missing_physics,
    penetration_resistance,
    soil_motion,
    time_step,
    wall_friction,
)
from .collisions import collide
from .runs import Found, Size, run_settings
from .study import Claim, Findings

REST_S = 2.0  # at least: beds under another friction, or of finer discs, take longer to rest than those of the case
STUDIES = (
    soil_motion,
    wall_friction,
    penetration_resistance,
    hard_balls,
    missing_physics,
    assumptions,
)


@dataclass(frozen=True)
class Reproduction:
    found: Found
    findings: tuple[Findings, ...]

    @property
    def claims(self) -> list[Claim]:
        return [claim for one in self.findings for claim in one.claims]

    @property
    def exit_code(self) -> ExitCode:
        failed = any(sample.failures for sample in self.found.samples.values())
        return ExitCode.ENGINE_FAILED if failed else ExitCode.AGREES


def reproduce_paper(
    case: Case,
    size: Size,
    workspace: Workspace,
    jobs: int | None,
    console: Console,
    profile: str | None = None,
) -> Reproduction:
    """All studies of `case`. What is there is not run again. Raises CaseError, SolverError."""
    with ProgressDisplay(console) as display:
        collisions = collide(case, workspace, here(jobs, profile), display)
    stability = map_stability(case, (), 1, workspace, here(jobs, profile), console)
    if case.resolved["time"]["rest_s"] < REST_S:
        case = varied(case, [f"time.rest_s={REST_S}"])
    with ProgressDisplay(console) as display:
        settings = [setting for study in STUDIES for setting in study.settings(case)]
        found = run_settings(case, settings, size, workspace, jobs, display, profile)
    of_beds = [study.findings(found) for study in STUDIES]
    in_order = (
        *of_beds[:3],
        time_step.findings(collisions, stability),
        *of_beds[3:],
    )  # the paper's
    return Reproduction(found, in_order)
