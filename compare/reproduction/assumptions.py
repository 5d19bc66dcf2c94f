"""What the paper's text does not say, and what other assumptions would change."""

from __future__ import annotations

import math

from crossdem.adapters.case import Case

from .changes import change_picture
from .penetration_resistance import wider
from .runs import Found
from .study import AS_PRINTED, Findings, Setting

LARGER_SHARES = (0.3, 0.7)  # of the larger discs, by number
LOOSE = 0.77  # share of a bed's area that discs fill, less than any settled bed has
ROUGH = 2  # of the largest diameters: so high above its mean height a bed has no particle


def settings(case: Case) -> list[Setting]:
    return [AS_PRINTED, *others(case)]


def others(case: Case) -> list[Setting]:
    return [*_mixtures(case), _higher_start(case), *wider(case)]


def findings(found: Found) -> Findings:
    picture = change_picture(
        "assumptions",
        "Assumptions, and what others would change",
        "The mixture is assumed half and half by number, the bar 1 cm wide and to start at the topmost particle under it.",
        found,
        others(found.case),
    )
    return Findings("What the text leaves open", (), (picture,))


def _mixtures(case: Case) -> list[Setting]:
    if len(case.resolved["particles"]["diameters_m"]) != 2:
        return []
    made = []
    for share in LARGER_SHARES:
        overrides = (f"particles.number_shares={[round(1 - share, 9), share]}",)
        made.append(Setting(f"{100 * share:.0f} % large discs", overrides, bed=overrides))
    return made


def _higher_start(case: Case) -> Setting:
    particles = case.resolved["particles"]
    area_m2 = sum(
        particles["count"] * share * math.pi / 4 * diameter_m**2
        for diameter_m, share in zip(particles["diameters_m"], particles["number_shares"])
    )
    height_m = area_m2 / (LOOSE * case.resolved["container"]["width_m"])
    tip_m = round(height_m + ROUGH * max(particles["diameters_m"]), 4)
    overrides = (f"bar.tip_m={tip_m!r}",)
    return Setting(f"bar starts {100 * tip_m:.1f} cm high", overrides, bed=overrides)
