"""Section 4.5, Fig. 13: balls of alumina against the soil's parameters."""

from __future__ import annotations

import math

from crossdem.adapters.case import Case

from .estimates import mean_of, ratio_of
from .observation import SHARE
from .penetration_resistance import on_springs
from .runs import Found
from .scaling import scaled
from .study import (
    AS_PRINTED,
    NOT_REPRODUCED,
    REPRODUCED,
    RESISTANCE,
    UNDECIDED,
    UNTESTABLE,
    Claim,
    Findings,
    Setting,
)

DENSITY_KG_M3 = 3900.0  # of alumina
STIFFNESS = 10.0  # times that of the soil's springs: as far as the resistance is known to depend on it, and beyond
ALIKE = 1.33  # the factor that the case's own check of the fluctuation allows


def alumina(case: Case) -> Setting:
    density = DENSITY_KG_M3 / case.resolved["particles"]["density_kg_m3"]
    overrides = scaled(case, stiffness=STIFFNESS, density=density)
    return Setting("balls of alumina", overrides, bed=overrides)


def settings(case: Case) -> list[Setting]:
    return [AS_PRINTED, alumina(case), on_springs(case, STIFFNESS)]


def findings(found: Found) -> Findings:
    soil, balls = found.of(AS_PRINTED), found.of(alumina(found.case))
    as_stiff = ratio_of(balls[SHARE], found.of(on_springs(found.case, STIFFNESS))[SHARE])
    share = ratio_of(balls[SHARE], soil[SHARE])
    resistance = ratio_of(balls[RESISTANCE], soil[RESISTANCE])
    density = DENSITY_KG_M3 / found.case.resolved["particles"]["density_kg_m3"]
    return Findings(
        "Balls of alumina: section 4.5",
        (
            Claim(
                "section 4.5, Fig. 13",
                "Hard balls fluctuate as the simulated soil does.",
                f"Simulated with the density of alumina, {DENSITY_KG_M3:g} kg/m³, and springs {STIFFNESS:g} times as stiff, "
                f"the fluctuation is {mean_of(balls[SHARE]).shown(100, '%')} of the resistance, of the soil's discs "
                f"{mean_of(soil[SHARE]).shown(100, '%')}: {share.as_change()}. Beside the soil's discs on springs as stiff it is "
                f"{as_stiff.as_change()}.",
                _alike(share.low, share.high),
                share.as_change(),
                f"alike is taken for an interval of the ratio within 1/{ALIKE:g} to {ALIKE:g}",
            ),
            Claim(
                "section 4.5, Fig. 13",
                "The simulated resistance is smaller than that of the balls, for want of interlocking.",
                f"The resistance of simulated balls is {resistance.mean:.2f} ({resistance.low:.2f} to {resistance.high:.2f}) "
                f"times that of the soil's discs; their weight is {density:.2f} times as large.",
                UNTESTABLE,
                f"{resistance.mean:.2f} times",
                "the measured curve is lost with the scans. Balls that weigh more resist more without any interlocking: a "
                "comparison that leaves out the density says nothing about it",
            ),
        ),
    )


def _alike(low: float, high: float) -> str:
    if not math.isfinite(low):
        return UNDECIDED
    if 1 / ALIKE < low and high < ALIKE:
        return REPRODUCED
    return NOT_REPRODUCED if high < 1 / ALIKE or low > ALIKE else UNDECIDED
