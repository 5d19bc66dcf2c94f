"""Closed forms that the ladder's cases are measured against, each with its derivation; SI units.

None knows a time step: they are what an engine must come to as its step vanishes. Where the codes' laws differ even
then, the law is an argument. Impacts with friction, damping and gravity at once are in impact.py.
"""

from __future__ import annotations

import math
from collections.abc import Sequence


def damping_ratio(mass: float, stiffness: float, damping: float) -> float:
    """zeta = eta / (2 sqrt(k m)); of two discs `mass` is the reduced one, m1 m2 / (m1 + m2)."""
    return damping / (2 * math.sqrt(stiffness * mass))


def restitution(zeta: float) -> float:
    """Of an impact whose dashpot may pull, up to the parting of the surfaces.

    The overlap is v exp(-zeta w t) sin(w' t) / w' with w' = w sqrt(1 - zeta^2). It vanishes again at w' t = pi, where
    its rate is -v exp(-zeta pi / sqrt(1 - zeta^2)). From zeta = 1 on it never does: 0.
    """
    if zeta >= 1:
        return 0.0
    return math.exp(-zeta * math.pi / math.sqrt(1 - zeta**2))


def restitution_clipped(zeta: float) -> float:
    """Of an impact whose normal force never pulls.

    The force ends earlier, where the same overlap no longer accelerates: k x + eta x' = 0, at
    tan(w' t) = 2 zeta sqrt(1 - zeta^2) / (2 zeta^2 - 1) with w' t in (0, pi); there the speed is v exp(-zeta w t).
    From zeta = 1 on, root and angle become hyperbolic, with exp(-2) at 1.
    T. Schwager, T. Poeschel, Granular Matter 9 (2007) 465-469.
    """
    root = math.sqrt(abs(1 - zeta**2))
    if zeta < 1:
        phase = math.atan2(2 * zeta * root, 2 * zeta**2 - 1)
    elif zeta > 1:
        phase = math.log((zeta + root) / (zeta - root))
    else:
        return math.exp(-2)
    return math.exp(-zeta / root * phase)


def fall(gravity: float, speed_down: float, time: float) -> float:
    """The way fallen [m]: v t + g t^2 / 2."""
    return speed_down * time + gravity * time**2 / 2


def column_top(
    radii: Sequence[float],
    weights: Sequence[float],
    floor_stiffness: float,
    pair_stiffness: float,
) -> float:
    """Height of the topmost centre of discs at rest one above the other, from the floor up.

    Each contact's overlap is the weight of all discs above it over the contact's stiffness.
    """
    height = radii[0] - sum(weights) / floor_stiffness
    for k in range(1, len(radii)):
        height += radii[k - 1] + radii[k] - sum(weights[k:]) / pair_stiffness
    return height


def rolling_speed(speed: float, spin: float, radius: float, arm: float) -> float:
    """Of a disc on the floor that slid or span at first, once it rolls; x to the right, spin counter-clockwise.

    The floor's impulse J acts at the `arm` below the centre: m (v - v0) = -J, I (w - w0) = -J a. Rolling means
    v + a w = 0; with I = m r^2 / 2, J / m = (v0 + a w0) / (1 + 2 a^2 / r^2). With the arm r, v0 becomes 2/3 v0 (for a
    sphere 5/7), and a spin w0 alone gives -r w0 / 3.
    """
    return speed - (speed + arm * spin) / (1 + 2 * (arm / radius) ** 2)


def rolling_slowing(rolling_friction: float, radius: float, arm: float) -> float:
    """By how much a disc that rolls on the floor slows down, over g.

    The floor's force F brakes, m v' = -F, and keeps it rolling at the `arm` a: v = -a w. The moment M against rolling is
    at its cap mu_r r m g: I w' = M - a F. With I = m r^2 / 2 that is v' = -M a / (I + m a^2): 2/3 mu_r g with the arm r.
    """
    return rolling_friction * radius * arm / (radius**2 / 2 + arm**2)


def parting_speed_from_joint(strength: float, stiffness: float, mass: float, speed: float) -> float:
    """Of two that are drawn apart at `speed` and break their joint, which holds T^2 / 2 k then: m v^2 / 2 is less by that.

    0 where they cannot break it. `mass`: the reduced one.
    """
    return math.sqrt(max(0.0, speed**2 - strength**2 / (stiffness * mass)))


def pinched_sink(bar_speed: float, wall_arm: float, bar_arm: float) -> float:
    """Speed downwards of a disc that rolls, without slip, between a wall at rest and a bar that moves down.

    v = a_wall w at the wall, V - v = a_bar w at the bar: v = V a_wall / (a_wall + a_bar).
    """
    return bar_speed * wall_arm / (wall_arm + bar_arm)


def pinched_spin(bar_speed: float, wall_arm: float, bar_arm: float) -> float:
    """Angular speed of the disc of pinched_sink: V / (a_wall + a_bar)."""
    return bar_speed / (wall_arm + bar_arm)


def pinched_load(weight: float, wall_arm: float, bar_arm: float) -> float:
    """The share of the pinched disc's weight [N] that hangs on the bar.

    No moment is left when f_wall a_wall = f_bar a_bar, no force when f_wall + f_bar = m g.
    """
    return weight * wall_arm / (wall_arm + bar_arm)
