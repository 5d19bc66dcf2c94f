"""The stability map: at which time steps does a bed rest, under each native scheme, and what do the bounds say?

A bed from the packing runs its rest at each time step. What is left of its kinetic energy tells: below the gate it is
quiet, above it agitated; where the solver gives up, it has blown up.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from crossdem.adapters.case import Case, CaseError, varied
from crossdem.adapters.solver import BEYOND_REASON

from .variants import Variant, VariantRun

QUIET, AGITATED, BLOWN_UP, FAILED = "quiet", "agitated", "blown up", "failed"
OUTCOMES = (QUIET, AGITATED, BLOWN_UP, FAILED)  # from good to bad
DEFAULT_REST_S = 1.2  # for a case that has no rest of its own
RECORDED_STEPS = 100  # after the rest: the least that a run records
STEPS_IN_MAP = 22  # from half the lowest bound to a tenth above the highest
AVERAGED_GAIN, CONVENTIONAL_GAIN = 6.0, 2.0  # linear analysis of a pure dashpot


@dataclass(frozen=True)
class Scheme:
    """A row of the map."""

    name: str
    overrides: tuple[str, ...]
    averages: bool  # its step displacement is the mean of two, Eqs (19)-(21)


SCHEMES = (
    Scheme("paper", ("scheme.name=paper",), averages=True),
    Scheme("yade_averaged", ("scheme.name=yade_averaged",), averages=True),
    Scheme("liggghts_averaged", ("scheme.name=liggghts_averaged",), averages=True),
    Scheme(
        "paper with leap-frog",
        ("scheme.name=paper", "scheme.integrator=leap_frog"),
        averages=False,
    ),
    Scheme("liggghts", ("scheme.name=liggghts",), averages=False),
    Scheme("yade", ("scheme.name=yade",), averages=False),
)


@dataclass(frozen=True)
class Bounds:
    """Time steps [s] that theory names."""

    eq32_s: float  # Eq (32): one particle meets a wall
    averaged_s: float  # linear, a disc with four contacts: gain 6, averaged displacement
    conventional_s: float  # the same with gain 2: leap-frog, velocity Verlet

    def of(self, scheme: Scheme) -> float:
        return self.averaged_s if scheme.averages else self.conventional_s


@dataclass(frozen=True)
class Trial:
    """One bed at one time step."""

    scheme: str
    step_s: float
    seed: int
    outcome: str
    kinetic_energy_J: float  # at the end of the rest; NaN where there is no end
    why: str  # of a bed that did not get there


@dataclass(frozen=True)
class Place:
    """A scheme at a time step, and the case that tries it."""

    scheme: Scheme
    step_s: float
    variant: Variant


@dataclass(frozen=True)
class StabilityMap:
    case: Case
    bounds: Bounds
    rest_s: float
    trials: tuple[Trial, ...]
    left_out: dict[str, str]  # scheme: why it cannot have the case's readings
    manifests: tuple[dict, ...] = ()  # of the runs with a result

    @property
    def schemes(self) -> list[Scheme]:
        found = {trial.scheme for trial in self.trials}
        return [scheme for scheme in SCHEMES if scheme.name in found]

    def of(self, scheme: Scheme) -> list[Trial]:
        return [trial for trial in self.trials if trial.scheme == scheme.name]

    def quiet_up_to_s(self, scheme: Scheme) -> float | None:
        """The largest time step at which every bed is quiet, and below which none is known not to be; None: there is none."""
        loud_s = self.loud_from_s(scheme) or math.inf
        unknown = {trial.step_s for trial in self.of(scheme) if trial.outcome == FAILED}
        steps = {trial.step_s for trial in self.of(scheme)} - unknown
        return max((step_s for step_s in steps if step_s < loud_s), default=None)

    def perhaps_further(self, scheme: Scheme) -> bool:
        """Whether no bed, next above the quiet ones, shows where they end."""
        quiet_s, loud_s = self.quiet_up_to_s(scheme) or 0.0, self.loud_from_s(scheme)
        if loud_s is None:
            return True
        return any(quiet_s < trial.step_s < loud_s for trial in self.of(scheme))

    def loud_from_s(self, scheme: Scheme) -> float | None:
        """The smallest time step at which some bed is known not to be quiet; a run that failed tells nothing."""
        return self._least_s(scheme, (AGITATED, BLOWN_UP))

    def blown_up_from_s(self, scheme: Scheme) -> float | None:
        return self._least_s(scheme, (BLOWN_UP,))

    def _least_s(self, scheme: Scheme, outcomes: tuple[str, ...]) -> float | None:
        steps = [trial.step_s for trial in self.of(scheme) if trial.outcome in outcomes]
        return min(steps, default=None)


def bounds(case: Case) -> Bounds:
    """Of the smallest disc and the stiffest, most damped kind of contact: as the solver has them."""
    particles, contact = case.resolved["particles"], case.resolved["contact"].values()
    radius_m = min(particles["diameters_m"]) / 2
    thickness_m = case.resolved["container"]["thickness_m"]
    mass_kg = particles["density_kg_m3"] * math.pi * radius_m**2 * thickness_m
    stiffness_N_m = max(kind["normal_stiffness_N_m"] for kind in contact)
    damping_N_s_m = max(kind["shear_damping_N_s_m"] for kind in contact)
    gain_s = mass_kg / (16 * damping_N_s_m) if damping_N_s_m > 0 else math.inf
    return Bounds(
        0.75 * math.sqrt(mass_kg / stiffness_N_m),
        AVERAGED_GAIN * gain_s,
        CONVENTIONAL_GAIN * gain_s,
    )


def default_steps_s(case: Case) -> list[float]:
    """Time steps of two digits on a logarithmic scale about all bounds, and those that the case names."""
    known = bounds(case)
    finite = [bound for bound in vars(known).values() if math.isfinite(bound)]
    ends = 0.5 * min(finite), 1.1 * max(finite)
    grid = [float(f"{step:.1e}") for step in np.geomspace(*ends, STEPS_IN_MAP)]
    named = [case.resolved["time"]["step_s"]]
    named += [engine["step_s"] for engine in case.resolved.get("engines", {}).values()]
    return sorted({*grid, *(step for step in named if ends[0] <= step <= ends[1])})


def resting(case: Case, scheme: Scheme, step_s: float) -> Variant:
    """The rest of `case` under `scheme` at this time step, and next to nothing after it."""
    rest_s = case.resolved["time"]["rest_s"] or DEFAULT_REST_S
    recorded_s = RECORDED_STEPS * step_s
    changes = [
        *scheme.overrides,
        f"time.step_s={step_s!r}",
        f"time.rest_s={round(rest_s / step_s) * step_s!r}",
        *(
            f"time.{key}={recorded_s!r}"
            for key in ("penetration_s", "sample_interval_s", "frame_interval_s")
        ),
        "time.allow_above_eq32=true",
        # Not used here, but they too must divide the intervals.
        *(f"engines.{name}.step_s={step_s!r}" for name in case.resolved.get("engines", {})),
    ]
    return Variant(f"{scheme.name} at {1e6 * step_s:.4g} \N{MICRO SIGN}s", varied(case, changes))


def trial(scheme: Scheme, step_s: float, run: VariantRun) -> Trial:
    """What became of a bed."""
    seed = run.packing.seed
    if run.failure:
        outcome = BLOWN_UP if run.exit_status == BEYOND_REASON else FAILED
        return Trial(scheme.name, step_s, seed, outcome, math.nan, run.failure)
    dataset = run.dataset()
    energy_J = float(dataset.resistance["kinetic_energy_J"].iloc[0])
    quiet = energy_J < dataset.case["gates"]["rest_kinetic_energy_J"]
    return Trial(scheme.name, step_s, seed, QUIET if quiet else AGITATED, energy_J, "")


def grid(case: Case, steps_s: Sequence[float]) -> tuple[list[Place], dict[str, str]]:
    """Every place of the map; and by scheme, why one cannot have the case's readings.

    Raises CaseError where that is so of all of them: then it is the time steps, or the case, that are at fault.
    """
    places, left_out = [], {}
    for scheme in SCHEMES:
        try:
            row = [Place(scheme, step_s, resting(case, scheme, step_s)) for step_s in steps_s]
        except CaseError as error:
            left_out[scheme.name] = "; ".join(error.faults)
            refused = error
        else:
            places += row
    if not places:
        raise refused
    return places, left_out
