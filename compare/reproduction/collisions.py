"""Single collisions in the native solver: discs that meet the floor at time steps about the bound of Eq (32)."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import pandas as pd

from crossdem.adapters.case import Case, varied_table
from crossdem.adapters.dataset import Dataset
from crossdem.adapters.packing import Packing
from crossdem.adapters.workspace import Workspace

from ..progress import ProgressDisplay
from ..variants import Variant, run_many_variants, settled

PHASES = 16  # of a step in which contacts begin
SPEED_M_S = 0.1  # of the discs, downwards
SHARES = (
    *np.round(np.arange(0.1, 0.7, 0.05), 3),
    *np.round(np.arange(0.7, 0.84, 0.01), 3),
    *np.round(np.arange(0.85, 1.3, 0.05), 3),
)
STEPS = 40  # recorded: several times as long as the contact lasts
NO_GAP_M = 1e-13  # between disc and floor where the contact is to begin with the step


@dataclass(frozen=True)
class Collisions:
    # A row per time step: share (of sqrt(m/k)), energies over those before: first_step, and least and largest after the
    # collision over the phases.
    table: pd.DataFrame
    spacing: float  # of the time steps about the bound, in units of sqrt(m/k)

    @property
    def first_step_gains_from(self) -> float | None:
        """Time step over sqrt(m/k), interpolated, from which the first step of a contact adds energy; None: nowhere."""
        return self._crossing("first_step")

    @property
    def collision_gains_from(self) -> float | None:
        """The same of a whole collision in its worst phase."""
        return self._crossing("largest")

    def _crossing(self, column: str) -> float | None:
        share, excess = self.table["share"].to_numpy(), self.table[column].to_numpy() - 1.0
        above = np.flatnonzero((excess[1:] > 0) & (excess[:-1] <= 0))
        if not len(above):
            return None
        k = above[0]
        return float(share[k] - excess[k] * (share[k + 1] - share[k]) / (excess[k + 1] - excess[k]))


def collide(case: Case, workspace: Workspace, jobs: int, display: ProgressDisplay) -> Collisions:
    """Runs or reuses the collisions under the case's own law of the wall. Raises CaseError, SolverError."""
    trials = [(share, _trial(case, float(share))) for share in SHARES]
    pairs: list[tuple[Variant, Packing]] = []
    for share, trial in trials:
        (packing,) = settled(trial, 1, workspace, jobs, display)
        pairs.append((Variant(f"collision at {share:g} sqrt(m/k)", trial), packing))
    runs = run_many_variants(case, pairs, workspace, jobs, display)
    rows = [
        {"share": share, **_energies(run.dataset())}
        for (share, _), run in zip(trials, runs)
        if run.folder
    ]
    return Collisions(pd.DataFrame(rows), spacing=0.01)


def _trial(case: Case, share: float) -> Case:
    """Discs of the larger diameter side by side above the floor, each a sixteenth of a step later than the one before."""
    values = case.resolved
    radius_m = max(values["particles"]["diameters_m"]) / 2
    mass_kg = (
        values["particles"]["density_kg_m3"]
        * math.pi
        * radius_m**2
        * values["container"]["thickness_m"]
    )
    wall = values["contact"]["particle_wall"]
    step_s = share * math.sqrt(mass_kg / wall["normal_stiffness_N_m"])
    damping = math.sqrt(2 * mass_kg * wall["normal_stiffness_N_m"])  # the rule of section 2.7
    particles = [
        {
            "x_m": (4 * phase + 2) * radius_m,
            "y_m": radius_m + NO_GAP_M + phase / PHASES * SPEED_M_S * step_s,
            "radius_m": radius_m,
            "velocity_y_m_s": -SPEED_M_S,
        }
        for phase in range(PHASES)
    ]
    return varied_table(
        case,
        particle=particles,
        particles={"density_kg_m3": values["particles"]["density_kg_m3"]},
        container=values["container"] | {"width_m": 4 * PHASES * radius_m},
        contact=values["contact"] | {"particle_wall": wall | {"normal_damping_N_s_m": damping}},
        time={
            "step_s": step_s,
            "penetration_s": STEPS * step_s,
            "sample_interval_s": step_s,
            "frame_interval_s": step_s,
            "allow_above_eq32": True,
        },
        gravity_m_s2=0.0,
        engines=None,
        packing=None,
        bar=None,
        check=None,
        marks=None,
    )


def _energies(dataset: Dataset) -> dict[str, float]:
    """Over the energy before: after the first step of the contact that begins at once, and after the collisions."""
    case, motion = dataset.case, dataset.motion
    mass_kg = (
        case["particles"]["density_kg_m3"]
        * math.pi
        * dataset.radius_m[0] ** 2
        * case["container"]["thickness_m"]
    )
    stiffness_N_m = case["contact"]["particle_wall"]["normal_stiffness_N_m"]
    speed_m_s = motion.velocity_m_s[:, :, 1]
    before_J = 0.5 * mass_kg * SPEED_M_S**2
    pressed_m = (
        SPEED_M_S * dataset.manifest["time_step_s"]
    )  # Eqs (25), (28): the way of the step before
    met = int(
        np.argmax(speed_m_s[:, 0] != speed_m_s[0, 0])
    )  # the frame at whose step the force first acts
    first_J = 0.5 * mass_kg * speed_m_s[met, 0] ** 2 + 0.5 * stiffness_N_m * pressed_m**2
    after = 0.5 * mass_kg * speed_m_s[-1] ** 2 / before_J
    return {"first_step": first_J / before_J, "least": after.min(), "largest": after.max()}
