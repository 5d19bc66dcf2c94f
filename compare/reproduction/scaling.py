"""Other discs for the same bed: sizes, stiffnesses and densities, with the dashpots and the time step that go with them.

The paper's rules: dashpots grow as the root of mass times stiffness (section 2.7), time steps as the root of mass over
stiffness (Eq 32).
"""

from __future__ import annotations

import math

from crossdem.adapters.case import Case

ROUND_OFF = 1e-9


def scaled(
    case: Case, size: float = 1.0, stiffness: float = 1.0, density: float = 1.0
) -> tuple[str, ...]:
    """Overrides for discs of `size` times the diameters, at the same volume of the bed, `stiffness` times the springs and
    `density` times the density."""
    values = case.resolved
    mass = size**2 * density
    count = round(values["particles"]["count"] / size**2)
    step_s = largest_step_s(case, math.sqrt(mass / stiffness) * values["time"]["step_s"])
    overrides = [
        f"particles.count={count}",
        f"particles.diameters_m={[size * diameter for diameter in values['particles']['diameters_m']]}",
        f"particles.density_kg_m3={density * values['particles']['density_kg_m3']!r}",
        f"packing.lattice_spacing_m={size * values['packing']['lattice_spacing_m']!r}",
        f"packing.jitter_m={size * values['packing']['jitter_m']!r}",
        f"packing.step_s={step_s!r}",
        f"time.step_s={step_s!r}",
    ]
    for kind, contact in values["contact"].items():
        for direction in ("normal", "shear"):
            spring, dashpot = f"{direction}_stiffness_N_m", f"{direction}_damping_N_s_m"
            overrides.append(f"contact.{kind}.{spring}={stiffness * contact[spring]!r}")
            damping = math.sqrt(mass * stiffness) * contact[dashpot]
            overrides.append(f"contact.{kind}.{dashpot}={damping!r}")
    overrides += [f"engines.{engine}.step_s={step_s!r}" for engine in values.get("engines", {})]
    return tuple(overrides)


def largest_step_s(case: Case, wanted_s: float) -> float:
    """The largest time step [s] up to `wanted_s` of which samples are taken after a whole number."""
    sample_s = case.resolved["time"]["sample_interval_s"]
    return sample_s / math.ceil(sample_s / wanted_s * (1 - ROUND_OFF))
