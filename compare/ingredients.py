"""What sets the paper's scheme apart from those of LIGGGHTS and YADE, ingredient by ingredient, in the order of the walk.

An ingredient changes some values of the case and leaves all else; the next one is taken on top of it.
"""

from __future__ import annotations

from dataclasses import dataclass

LIGGGHTS, YADE = "liggghts", "yade"
TARGETS = (LIGGGHTS, YADE)


@dataclass(frozen=True)
class Ingredient:
    """One step of the walk."""

    name: str
    overrides: tuple[str, ...]  # KEY=VALUE; {step_s} stands for the target's time step
    says: str  # one sentence: what changes
    only: str | None = None  # the target that has it; None: all of them


PAPER = Ingredient("paper scheme", ("scheme.name=paper",), "The scheme as the case has it.")

INGREDIENTS = (
    Ingredient(
        "time step",
        ("time.step_s={step_s}",),
        "The paper's scheme at the time step of the other code.",
    ),
    Ingredient(
        "leap-frog",
        ("scheme.integrator=leap_frog",),
        "Velocities half a step off the positions in place of the averaged displacement of Eqs (19)-(21).",
        only=YADE,
    ),
    Ingredient(
        "velocity Verlet",
        ("scheme.integrator=velocity_verlet",),
        "Two half steps of the velocity in place of the averaged displacement of Eqs (19)-(21).",
        only=LIGGGHTS,
    ),
    Ingredient(
        "absolute overlap",
        ("scheme.normal_spring=overlap",),
        "The normal spring force is stiffness times overlap, not the sum of increments of Eq (5).",
    ),
    Ingredient(
        "slip cap on the total force",
        ("scheme.slip_cap=total",),
        "Friction is limited by the whole normal force, dashpot included, not by the spring force of Eq (9).",
    ),
    Ingredient(
        "whole step at first contact",
        ("scheme.first_contact_normal=spring_only", "scheme.first_contact_shear=whole_step"),
        "A new contact counts the whole time step, not the share spent in contact of Eqs (3) and (4).",
    ),
    Ingredient(
        "arm to the contact point",
        ("scheme.torque_arm=contact_point",),
        "Friction acts at the radius less half the overlap, in torque and slip, not at the full radius of Eqs (2) and (12).",
    ),
    Ingredient(
        "attraction clipped",
        ("scheme.attraction=clipped",),
        "The dashpot cannot pull two particles together.",
        only=YADE,
    ),
)

# What is left once every ingredient is taken, said by target.
REMAINDER = {
    LIGGGHTS: "What is left of the scheme: shear history kept as a vector and projected on the contact plane, "
    "velocities of the half step in dashpot and friction, edges and corners of the bar's mesh.",
    YADE: "What is left of the scheme: shear history kept as a vector and turned with the contact, arms at walls and "
    "bar, the slip test on spring force and cap, the corner of the box.",
}


def walk(target: str) -> tuple[Ingredient, ...]:
    """The ingredients from the paper's scheme to the native scheme `target`, that scheme being the last."""
    mixed = (part for part in INGREDIENTS if part.only in (None, target))
    native = Ingredient(f"native scheme {target}", (f"scheme.name={target}",), REMAINDER[target])
    return (PAPER, *mixed, native)


def engine_itself(target: str) -> Ingredient:
    """The last step: from the native scheme of that name to the engine that it stands for."""
    return Ingredient(
        f"{target} itself",
        (),
        f"The same steps done by the real {target}: nothing should differ but rounding, and the chaos that it sets off.",
    )
