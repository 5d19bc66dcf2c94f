"""Section 4.4: what the paper names as missing from its discs, cohesion and interlocking, put in as options."""

from __future__ import annotations

from functools import partial

from crossdem.adapters.case import Case

from .changes import change_table, draw_changes
from .estimates import ratio_of
from .observation import SHARE
from .penetration_resistance import NO_EFFECT, RESISTANCE, all_below, explains
from .runs import Found
from .soil_motion import AS_PRINTED
from .study import Claim, Findings, Picture, Setting

STRENGTHS_N = (0.02, 0.05, 0.1)  # of a joint; a disc weighs 2 to 3 mN
REST_S = 4.0  # a packing holds no stretched joints: the bed settles anew
ROLLING = (0.1, 0.3)  # coefficients of rolling friction


def settings(case: Case) -> list[Setting]:
    return [AS_PRINTED, *cohesive(), *rolling()]


def cohesive() -> list[Setting]:
    return [
        Setting(
            f"cohesion {1000 * strength_N:g} mN",
            (
                f"contact.particle_particle.tensile_strength_N={strength_N}",
                f"time.rest_s={REST_S}",
            ),
        )
        for strength_N in STRENGTHS_N
    ]


def rolling() -> list[Setting]:
    return [
        Setting(
            f"rolling friction {coefficient:g}",
            tuple(
                f"contact.{kind}.rolling_friction={coefficient}"
                for kind in ("particle_particle", "particle_wall")
            ),
        )
        for coefficient in ROLLING
    ]


def findings(found: Found) -> Findings:
    varied = [*cohesive(), *rolling()]
    picture = Picture(
        "missing_physics",
        "Cohesion and rolling resistance",
        "Native: ratio to the case as the paper has it, and its 95 % interval. Cohesion is the tension that a joint of two "
        "discs carries before it breaks; rolling friction limits the moment of a rolling spring at each contact.",
        (960, 90 + 34 * len(varied)),
        partial(draw_changes, found, AS_PRINTED, varied),
        change_table(found, AS_PRINTED, varied),
    )
    return Findings(
        "What the paper names as missing: section 4.4",
        (_cohesion(found), _interlocking(found)),
        (picture,),
    )


def _cohesion(found: Found) -> Claim:
    base = found.of(AS_PRINTED)
    shares = {one.name: ratio_of(found.of(one)[SHARE], base[SHARE]) for one in cohesive()}
    forces = {one.name: ratio_of(found.of(one)[RESISTANCE], base[RESISTANCE]) for one in cohesive()}
    said = "; ".join(
        f"{name} {share.as_change()}, the resistance itself {forces[name].as_change()}"
        for name, share in shares.items()
    )
    return Claim(
        "section 4.4",
        "The joints carry no tension: that is the other reason for the fluctuation.",
        f"With joints that do, the fluctuation as a share of the resistance changes: {said}.",
        all_below(shares, 1.0),
        list(shares.values())[-1].as_change(),
        "reproduced where cohesive discs fluctuate less, each interval below no change",
    )


def _interlocking(found: Found) -> Claim:
    base = found.of(AS_PRINTED)
    ratios = {one.name: ratio_of(found.of(one)[RESISTANCE], base[RESISTANCE]) for one in rolling()}
    said = "; ".join(f"{name} {ratio.as_change()}" for name, ratio in ratios.items())
    most = list(ratios.values())[-1]
    return Claim(
        "section 4.4",
        "Discs do not interlock, they roll: that is the other reason for the low resistance.",
        f"With a rolling resistance, which stands for interlocking, the mean resistance changes: {said}.",
        explains(most),
        most.as_change(),
        f"reproduced where the largest rolling friction raises the resistance by more than {100 * (NO_EFFECT - 1):.0f} %",
    )
