"""Section 4.4: what the paper names as missing from its discs, cohesion and interlocking, put in as options."""

from __future__ import annotations

from crossdem.adapters.case import Case

from . import causes
from .changes import change_picture
from .runs import Found
from .study import AS_PRINTED, Findings, Setting

STRENGTHS_N = (0.02, 0.05, 0.1)  # of a joint; a disc weighs 2 to 3 mN
REST_S = 4.0  # a packing holds no stretched joints: the bed settles anew
ROLLING = (0.1, 0.3)  # coefficients of rolling friction


def settings(case: Case) -> list[Setting]:
    return [AS_PRINTED, *cohesive(), *rolling(), *settled()]


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


def settled() -> list[Setting]:
    """The strongest of both once more, on beds that settled under them."""
    return [
        Setting(f"{one.name}, beds too", one.overrides, bed=one.overrides)
        for one in (cohesive()[-1], rolling()[-1])
    ]


def findings(found: Found) -> Findings:
    return Findings(
        "What the paper names as missing: section 4.4",
        (
            causes.of_fluctuation(
                found,
                cohesive(),
                "The joints carry no tension: that is the other reason for the fluctuation.",
                "With joints that do, the fluctuation changes",
                "the most cohesive discs",
            ),
            causes.of_low_resistance(
                found,
                rolling(),
                "Discs do not interlock, they roll: that is the other reason for the low resistance.",
                "With a rolling resistance, which stands for interlocking, the mean resistance changes",
                "the largest rolling friction raises",
            ),
        ),
        (
            change_picture(
                "missing_physics",
                "Cohesion and rolling resistance",
                "Cohesion is the tension that a joint of two discs carries before it breaks; rolling friction limits the "
                'moment of a rolling spring at each contact. Beds are those of the case, but where it says "beds too": discs '
                "that cohere, or resist rolling, settle into looser ones.",
                found,
                [*cohesive(), *rolling(), *settled()],
            ),
        ),
    )
