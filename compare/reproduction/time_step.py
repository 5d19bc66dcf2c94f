"""Section 2.7, Eq (32): the bound of the time step, derived again, on one collision and on a packed bed."""

from __future__ import annotations

from functools import partial

import numpy as np
from matplotlib.figure import Figure

from ..drawing import INK
from ..stability import SCHEMES, StabilityMap
from ..stability_figure import draw_map
from .collisions import Collisions
from .study import CORRECTED, NOT_REPRODUCED, REPRODUCED, UNDECIDED, Claim, Findings, Picture

PRINTED = 0.75  # of Eq (32), in units of sqrt(m/k)
PAPER = next(scheme for scheme in SCHEMES if scheme.name == "paper")


def root() -> float:
    """The bound of Eq (31) in units of sqrt(m/k): the one root above 0 of a^3 + 2 sqrt(2) a^2 + a - 2 sqrt(2)."""
    roots = np.roots([1.0, 2 * np.sqrt(2), 1.0, -2 * np.sqrt(2)])
    return float(max(one.real for one in roots if abs(one.imag) < 1e-9))


def findings(collisions: Collisions, stability: StabilityMap) -> Findings:
    return Findings(
        "Stability of the solution: section 2.7",
        (_derivation(), _collision(collisions), _bed(stability)),
        (
            Picture(
                "eq32_collision",
                "Eq (32) on one collision",
                "Energy of a disc that meets the floor, over its energy before, against the time step: after the first "
                "step of the contact, where that begins at once, and after the collision, for contacts that begin at "
                "sixteen places of a step.",
                (900, 340),
                partial(_draw_collisions, collisions),
                collisions.table,
            ),
            Picture(
                "eq32_bed",
                "Eq (32) on a packed bed",
                f"The bed {stability.rest_s:.3g} s after the packing, at many time steps, under each native scheme.",
                (900, 370),
                lambda figure: draw_map(stability, figure.add_subplot()),
            ),
        ),
    )


def _derivation() -> Claim:
    exact = root()
    return Claim(
        "section 2.7, Eqs (29) to (32)",
        "The time step has to stay below 0.75 sqrt(m/k).",
        f"The cubic of Eq (31) has its root above 0 at {exact:.4f}: what is printed is that, cut off, on the safe side.",
        REPRODUCED if abs(exact - PRINTED) < 0.01 and PRINTED < exact else NOT_REPRODUCED,
        f"{exact:.4f}",
        "reproduced where the root is the printed number to its two digits",
    )


def _collision(collisions: Collisions) -> Claim:
    first, whole = collisions.first_step_gains_from, collisions.collision_gains_from
    if first is None or abs(first - root()) > collisions.spacing:
        verdict = NOT_REPRODUCED
    else:
        verdict = CORRECTED if whole and whole < root() - collisions.spacing else REPRODUCED
    said = "the first step of a contact adds energy at none of these time steps"
    if first:
        said = f"the first step of a contact adds energy from {first:.4f} sqrt(m/k) on"
    later = "no whole collision ends with more energy than it began with"
    if whole:
        later = (
            "as the step displacement is averaged and a contact may begin anywhere in a step, a whole collision can end with "
            f"more energy than it began with from {whole:.2f} sqrt(m/k) on"
        )
    return Claim(
        "section 2.7, Eqs (26) to (32)",
        "A disc that meets a wall gains no energy below that bound.",
        f"In the native solver {said}; {later}.",
        verdict,
        f"first step {first:.4f}, collision {whole:.2f}" if first and whole else "",
        "reproduced where the first step adds energy from the root of Eq (31) on; with a correction where a whole collision does "
        "so earlier",
    )


def _bed(stability: StabilityMap) -> Claim:
    quiet_s, blown_s = stability.quiet_up_to_s(PAPER), stability.blown_up_from_s(PAPER)
    loud_s, bound_s = stability.loud_from_s(PAPER), stability.bounds.eq32_s
    if quiet_s is None or loud_s is None:
        verdict = UNDECIDED
    else:
        verdict = REPRODUCED if loud_s >= 0.99 * bound_s else CORRECTED
    share = quiet_s / bound_s if quiet_s else float("nan")
    blown = f", and blows up from {1e6 * blown_s:.0f} µs on" if blown_s else ""
    limit = 1e6 * stability.bounds.averaged_s
    return Claim(
        "section 2.7, Eq (32)",
        "Below that bound the solution is stable.",
        f"A packed bed rests up to {1e6 * (quiet_s or 0):.0f} µs, {share:.2f} of the {1e6 * bound_s:.0f} µs of Eq (32){blown}. "
        f"What comes first is the shear dashpots of several contacts, which act on the spin of one disc: their linear bound is "
        f"{limit:.0f} µs.",
        verdict,
        f"{share:.2f} of Eq (32)",
        "reproduced where the bed rests up to the bound; with a correction where it needs a smaller time step",
    )


def _draw_collisions(collisions: Collisions, figure: Figure) -> None:
    panel = figure.subplots()
    table = collisions.table
    panel.plot(
        table["share"],
        table["first_step"],
        color="#3b82d6",
        linewidth=2,
        label="after the first step",
    )
    panel.fill_between(
        table["share"], table["least"], table["largest"], color="#e0752d", alpha=0.35, linewidth=0
    )
    panel.plot(
        table["share"],
        table["largest"],
        color="#e0752d",
        linewidth=1.5,
        label="after the collision: range",
    )
    panel.axhline(1, color=INK, linewidth=0.8)
    panel.axvline(root(), color=INK, linestyle="--", linewidth=1)
    panel.annotate(
        f"root of Eq (31): {root():.4f}",
        (root(), 0.02),
        xycoords=("data", "axes fraction"),
        fontsize=8,
    )
    panel.set(xlabel="time step over sqrt(m/k)", ylabel="energy after over before", ylim=(0, 2))
    panel.legend(loc="upper left")
