"""The exact values of the answers: from how a case starts, and from the engine's law as its time step vanishes."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from . import closed_forms
from .engine_laws import EngineLaw
from .impact import Rebound
from .impact import rebound as solved_rebound
from .start import Start


def one(start: Start, law: EngineLaw) -> float:
    return 1.0


def nothing(start: Start, law: EngineLaw) -> float:
    return 0.0


def _rebound(start: Start, law: EngineLaw) -> Rebound:
    return solved_rebound(start.impact(), law.contact)


def fall(start: Start, law: EngineLaw) -> float:
    return closed_forms.fall(
        start.gravity, -start.velocity[0, 1], start.case["time"]["penetration_s"]
    )


def fall_speed(start: Start, law: EngineLaw) -> float:
    return start.gravity * start.case["time"]["penetration_s"] - start.velocity[0, 1]


def column_top(start: Start, law: EngineLaw) -> float:
    order = np.argsort(start.position[:, 1])
    contact = start.case["contact"]
    return closed_forms.column_top(
        start.radius[order],
        (start.mass * start.gravity)[order],
        contact["particle_wall"]["normal_stiffness_N_m"],
        contact["particle_particle"]["normal_stiffness_N_m"],
    )


def rebound_speed(start: Start, law: EngineLaw) -> float:
    return _rebound(start, law).normal_speed / start.approach(start.velocity)


def restitution(start: Start, law: EngineLaw) -> float:
    return _formula(law)(_damping_ratio(start, start.reduced_mass, start.contact()))


def sideways_speed(start: Start, law: EngineLaw) -> float:
    """A third of the change of slip is of translation: m* = 3 m_slip."""
    change = start.slip() - _rebound(start, law).slip_speed
    return 1 - change / 3 / start.sideways(start.velocity)


def rolling(start: Start, law: EngineLaw) -> float:
    """Two thirds of the change of slip are of rotation."""
    change = start.slip() - _rebound(start, law).slip_speed
    return (start.rolling(start.spin) - 2 / 3 * change) / start.slip()


def rolling_speed(start: Start, law: EngineLaw) -> float:
    sunk = start.weight / start.contact()["normal_stiffness_N_m"]
    radius = float(start.radius[0])
    arm = law.wall_arm(radius, sunk)
    speed = closed_forms.rolling_speed(
        float(start.velocity[0, 0]), float(start.spin[0]), radius, arm
    )
    return speed / start.slip()


def rolling_slowing(start: Start, law: EngineLaw) -> float:
    contact, radius = start.contact(), float(start.radius[0])
    arm = law.wall_arm(radius, start.weight / contact["normal_stiffness_N_m"])
    return closed_forms.rolling_slowing(contact.get("rolling_friction", 0.0), radius, arm)


def parting_speed(start: Start, law: EngineLaw) -> float:
    contact, speed = start.contact(), -start.approach(start.velocity)
    strength, stiffness = contact.get("tensile_strength_N", 0.0), contact["normal_stiffness_N_m"]
    left = closed_forms.parting_speed_from_joint(strength, stiffness, start.reduced_mass, speed)
    return left / speed


def _pinch(start: Start, law: EngineLaw) -> tuple[float, float, float, float]:
    """Speed of the bar, arms at wall and bar, and the overlap, alike at both: half of what the gap lacks."""
    bar = start.case["bar"]
    to_wall = bar["centre_x_m"]
    if _right_of_bar(start):
        to_wall = start.case["container"]["width_m"] - to_wall
    gap = to_wall - bar["width_m"] / 2
    radius = float(start.radius[0])
    overlap = (2 * radius - gap) / 2
    return (
        bar["speed_m_s"],
        law.wall_arm(radius, overlap),
        law.bar_arm(radius, overlap),
        overlap,
    )


def _right_of_bar(start: Start) -> bool:
    return float(start.position[0, 0]) > start.case["bar"]["centre_x_m"]


def sink(start: Start, law: EngineLaw) -> float:
    speed, wall_arm, bar_arm, _ = _pinch(start, law)
    return closed_forms.pinched_sink(speed, wall_arm, bar_arm) / speed


def pinched_rolling(start: Start, law: EngineLaw) -> float:
    speed, wall_arm, bar_arm, _ = _pinch(start, law)
    return closed_forms.pinched_spin(speed, wall_arm, bar_arm) * float(start.radius[0]) / speed


def side_force(start: Start, law: EngineLaw) -> float:
    *_, overlap = _pinch(start, law)
    force = start.contact()["normal_stiffness_N_m"] * overlap
    return -force if _right_of_bar(start) else force


def bar_load(start: Start, law: EngineLaw) -> float:
    _, wall_arm, bar_arm, _ = _pinch(start, law)
    return closed_forms.pinched_load(1.0, wall_arm, bar_arm)


def push(start: Start, law: EngineLaw) -> float:
    """The corner drives the particle off at its own speed and that of the rebound."""
    return 1 + _formula(law)(_damping_ratio(start, float(start.mass[0]), start.contact()))


def pull(start: Start, law: EngineLaw) -> float:
    found = _rebound(start, law)
    return found.largest_pull / found.largest_push


def _formula(law: EngineLaw) -> Callable[[float], float]:
    return closed_forms.restitution_clipped if law.contact.clipped else closed_forms.restitution


def _damping_ratio(start: Start, mass: float, contact: dict) -> float:
    return closed_forms.damping_ratio(
        mass, contact["normal_stiffness_N_m"], contact["normal_damping_N_s_m"]
    )
