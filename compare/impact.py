"""The contact law as the time step vanishes: one impact of a disc on a wall, or on another disc, solved exactly.

With linear springs and dashpots an impact obeys linear differential equations, which switch where the contact starts
or stops to slip and where the normal force changes its sign. They are integrated piece by piece, to twelve digits.
What a time step adds to that is an engine's own, and must vanish with the step. (For springs alone the pieces are
those of Di Renzo and Di Maio, Chem. Eng. Sci. 59 (2004) 3461-3475.)

Of two discs, the reduced mass m* = m1 m2 / (m1 + m2) takes the place of m. Slip is moved by translation and rotation:
its effective mass is 1 / (1/m* + r1^2/I1 + r2^2/I2), for discs with I = m r^2 / 2 a third of m*.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.integrate import solve_ivp

SLIP_MASS_SHARE = 1 / 3  # of discs
TOLERANCE = 1e-12
LONGEST = 1e3  # in units of sqrt(m / k); an impact takes pi of them, little damped
AT_THE_CAP = 1e-9  # share of the largest force, below which spring and cap are the same


@dataclass(frozen=True)
class ContactLaw:
    """What is left of an engine's law when its time step vanishes."""

    cap_on_total: bool = (
        False  # slip test on the whole normal force, dashpot included; else on its spring alone
    )
    clipped: bool = False  # the normal force never attracts


@dataclass(frozen=True)
class Impact:
    """What meets, and how: at first touch it approaches at `normal_speed` and slips at `slip_speed`."""

    mass: float  # [kg], of two discs the reduced one
    normal_stiffness: float  # [N/m]
    normal_damping: float  # [N s/m]
    shear_stiffness: float  # [N/m]
    shear_damping: float  # [N s/m]
    friction: float
    normal_speed: float  # [m/s], > 0
    slip_speed: float = 0.0  # [m/s] of the two surfaces, rotation included
    pressed: float = 0.0  # [m/s^2] by which gravity drives the two together


@dataclass(frozen=True)
class Rebound:
    """What an impact leaves."""

    normal_speed: float  # [m/s] of parting
    slip_speed: float  # [m/s], > 0 in the direction of the slip at first touch
    duration: float  # [s] from touch to parting
    largest_push: float  # [N]
    largest_pull: float  # [N] of the dashpot, where the law lets it attract


def rebound(impact: Impact, law: ContactLaw) -> Rebound:
    """From touch to parting. Raises ValueError for two that do not meet, or do not part."""
    if not impact.normal_speed > 0:
        raise ValueError("the two do not approach each other")
    equations = _Equations(impact, law)
    state = np.array([0.0, 1.0, 0.0, impact.slip_speed / impact.normal_speed])
    time, forces = 0.0, []
    branch, slips = 1, None
    while True:
        piece = _Piece(equations, branch, slips, state)
        solved = solve_ivp(
            piece.rates,
            (time, time + LONGEST),
            state,
            method="DOP853",
            events=piece.ends(),
            rtol=TOLERANCE,
            atol=TOLERANCE / 10,
            max_step=0.1,
        )
        if solved.status != 1:
            raise ValueError("the two do not part again")
        forces += map(piece.normal_force, solved.y.T)
        time, state = solved.t[-1], piece.with_spring_at_cap(solved.y[:, -1])
        parted, turned, switched = (len(times) > 0 for times in solved.t_events)
        if parted:
            break
        branch = -branch if turned else branch
        slips = not piece.slips if switched else None
    speed = impact.normal_speed
    force_unit = speed * math.sqrt(impact.mass * impact.normal_stiffness)
    return Rebound(
        normal_speed=-state[1] * speed,
        slip_speed=state[3] * speed,
        duration=time * math.sqrt(impact.mass / impact.normal_stiffness),
        largest_push=max(forces) * force_unit,
        largest_pull=0.0 if law.clipped else max(0.0, -min(forces)) * force_unit,
    )


class _Equations:
    """Units: sqrt(m/k) of time, the normal speed. State: overlap, its rate, shear displacement, speed of slip."""

    def __init__(self, impact: Impact, law: ContactLaw):
        impedance = math.sqrt(impact.mass * impact.normal_stiffness)
        self.law = law
        self.damping = impact.normal_damping / impedance
        self.shear_stiffness = impact.shear_stiffness / impact.normal_stiffness
        self.shear_damping = impact.shear_damping / impedance
        self.friction = impact.friction
        self.pressed = (
            impact.pressed * math.sqrt(impact.mass / impact.normal_stiffness) / impact.normal_speed
        )


class _Piece:
    """A stretch of an impact in which nothing switches. `branch` is the sign of spring and dashpot's sum."""

    def __init__(self, equations: _Equations, branch: int, slips: bool | None, state: np.ndarray):
        self.e = equations
        self.branch = branch
        spring = equations.shear_stiffness * state[2]
        at_the_cap = abs(spring) >= self.cap(state) - AT_THE_CAP
        self.direction = math.copysign(1.0, spring if abs(spring) > AT_THE_CAP else state[3])
        if slips is None:  # the law's own test: the spring would grow faster than its cap
            slips = at_the_cap and self._outruns(state) > 0
        self.slips = slips
        free = equations.law.cap_on_total and self._is_clipped()
        self.may_switch = not free and bool(state[2] or state[3])

    def normal_force(self, state) -> float:
        return 0.0 if self._is_clipped() else self._sum(state)

    def cap(self, state) -> float:
        """Of the shear force."""
        normal = abs(self.normal_force(state)) if self.e.law.cap_on_total else state[0]
        return self.e.friction * normal

    def rates(self, _, state) -> list[float]:
        _, approach, shear, slip = state
        if self.slips:
            force = self.direction * self.cap(state)
        else:
            force = self.e.shear_stiffness * shear + self.e.shear_damping * slip
        return [approach, self._acceleration(state), slip, -force / SLIP_MASS_SHARE]

    def with_spring_at_cap(self, state) -> np.ndarray:
        """Slip holds the spring at its cap, whatever the surfaces' way."""
        if self.slips and self.e.shear_stiffness > 0:
            state[2] = self.direction * self.cap(state) / self.e.shear_stiffness
        return state

    def ends(self) -> list:
        """Parting; a change of sign of the normal force; the start or end of slip."""
        switch = self._outruns if self.slips else self._margin
        return [
            _falling(lambda state: state[0]),
            _falling(lambda state: self.branch * self._sum(state)),
            _falling(switch if self.may_switch else lambda state: 1.0),
        ]

    def _margin(self, state) -> float:
        return self.cap(state) - abs(self.e.shear_stiffness * state[2])

    def _outruns(self, state) -> float:
        """The rate at which the spring would grow, less that of its cap."""
        if not self.e.law.cap_on_total:
            cap_rate = self.e.friction * state[1]
        elif self._is_clipped():
            cap_rate = 0.0
        else:
            rate = state[1] + self.e.damping * self._acceleration(state)
            cap_rate = self.e.friction * self.branch * rate
        return self.direction * self.e.shear_stiffness * state[3] - cap_rate

    def _is_clipped(self) -> bool:
        return self.branch < 0 and self.e.law.clipped

    def _sum(self, state) -> float:
        return state[0] + self.e.damping * state[1]

    def _acceleration(self, state) -> float:
        return self.e.pressed - self.normal_force(state)


def _falling(function):
    """An event of solve_ivp that ends a piece where `function` of the state falls through zero."""

    def event(_, state):
        return function(state)

    event.terminal, event.direction = True, -1
    return event
