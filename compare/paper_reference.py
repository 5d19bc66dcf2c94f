"""The paper's scheme once more, in plain Python, equation by equation: what the native solver is checked against.

Written from the paper (Eqs 1-24), the list of its readings and the two options beyond it (joints with a strength, springs
against rolling), not from the solver: every pair is looked at in every step, and nothing is fast. Good for a few dozen particles. What it shares with the solver is the order of the sums and
which constants are multiplied first, so that the two can come to the same bits. Units are SI; angles count
counter-clockwise.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np
import pandas as pd

from ..adapters.dataset_faults import RESISTANCE_COLUMNS
from ..adapters.motion_file import Motion
from ..adapters.packing import Packing
from ..adapters.schedule import Schedule

TABLE = [column for column in RESISTANCE_COLUMNS if column != "depth_m"]


def paper_reference(case: dict, packing: Packing) -> tuple[Motion, pd.DataFrame]:
    """The motion at the frames of the resolved `case`, and the dataset's table at its samples but for the depth: forces
    as of the step that ends there, contacts and kinetic energy after it. The time step is the case's own.
    """
    assert case["scheme"]["name"] == "paper"
    schedule = Schedule.of(case, case["time"]["step_s"])
    frame_s, sample_s = case["time"]["frame_interval_s"], case["time"]["sample_interval_s"]
    bed = _Bed(case, packing)
    for _ in range(schedule.rest):
        bed.step()
    bed.start_bar()
    frames, samples = [], []
    for step in range(schedule.penetration + 1):
        if step > 0:
            bed.step()
        if step % schedule.frame == 0:
            frames.append((len(frames) * frame_s, *bed.frame()))
        if step % schedule.sample == 0:
            samples.append((len(samples) * sample_s, *bed.sample()))
    time_s, position, velocity, spin, angle, tip = map(np.array, zip(*frames))
    motion = Motion(time_s, position, velocity, spin, angle, None if bed.bar is None else tip)
    return motion, pd.DataFrame(samples, columns=TABLE)


class _Touch(NamedTuple):
    """What particle i touches, as seen from i."""

    partner: int | str  # another particle, or a wall or the bar by name
    law: dict  # the parameters of the contact
    overlap: float  # [m] > 0, in a joint also below
    cos: float  # of alpha: the direction from i's centre to the partner
    sin: float


class _Bed:
    """Particles, walls and bar, and the springs of their contacts. Motions and loads have entries x, y, rotation."""

    def __init__(self, case: dict, packing: Packing):
        self.case, self.reading = case, case["scheme"]
        self.dt = case["time"]["step_s"]
        self.bar = case.get("bar")
        self.tip = self.tip_at_start = packing.bar_tip_m
        self.bar_steps, self.bar_speed = 0, 0.0  # [m/s] downwards
        table = packing.particles
        self.radius = table["radius_m"].tolist()
        self.particles = range(len(self.radius))
        density, thickness = case["particles"]["density_kg_m3"], case["container"]["thickness_m"]
        share = {"disc": 1 / 2, "sphere": 2 / 5}[self.reading["inertia"]]
        self.mass = [density * math.pi * r * r * thickness for r in self.radius]
        self.inertia = [share * m * r * r for m, r in zip(self.mass, self.radius)]
        self.position = [[x, y, 0.0] for x, y in zip(table["x_m"], table["y_m"])]
        velocity = ["velocity_x_m_s", "velocity_y_m_s", "angular_velocity_rad_s"]
        self.velocity = table[velocity].to_numpy().tolist()
        before = self.dt if self.reading["initial_displacement"] == "velocity" else 0.0
        self.displacement = [[before * component for component in v] for v in self.velocity]

        # (particle, partner): (e_n, e_s, e_r); "in turn" has two entries for a pair
        self.springs_before = {}
        self.springs = {
            (i, touch.partner): (touch.law["normal_stiffness_N_m"] * touch.overlap, 0.0, 0.0)
            for i in self.particles
            for touch in (*self.neighbours(i, self.particles), *self.surfaces(i))
        }
        self.clear_loads()
        # The forces until the first evaluation, and of an integrator's first kick: those of the springs as they are.
        self.collect_all(lambda i, touch: (self.springs[i, touch.partner][0], 0.0, 0.0))

    def start_bar(self) -> None:
        self.bar_speed = self.bar["speed_m_s"] if self.bar else 0.0

    def frame(self) -> tuple:
        """Position, velocity, spin and angle of every particle, and the height of the bar's bottom face."""
        position, velocity = [p[:2] for p in self.position], [v[:2] for v in self.velocity]
        spin, angle = [v[2] for v in self.velocity], [p[2] for p in self.position]
        return position, velocity, spin, angle, self.tip

    def sample(self) -> tuple:
        """All that TABLE has but the time."""
        energy = sum(
            0.5 * (m * (vx * vx + vy * vy) + inertia * spin * spin)
            for m, inertia, (vx, vy, spin) in zip(self.mass, self.inertia, self.velocity)
        )
        pairs = (self.neighbours(i, self.particles[i + 1 :]) for i in self.particles)
        contacts = sum(touch.overlap > 0 for touches in pairs for touch in touches)
        tip, shaft = self.tip_force, self.bar_force[1] - self.tip_force
        return (*self.bar_force, tip, shaft, self.floor_force, contacts, energy)

    def step(self) -> None:
        """The bar moves, then forces act and particles move."""
        if self.reading["integrator"] == "velocity_verlet":
            for i in self.particles:
                self.accelerate(i, self.dt / 2)
                self.displace(i, averaged=False)
        if self.bar:
            self.bar_steps += 1 if self.bar_speed else 0
            self.tip = self.tip_at_start - self.bar_speed * (self.bar_steps * self.dt)
        self.clear_loads()
        self.springs_before, self.springs = self.springs, {}  # what does not touch is forgotten
        if self.reading["update_order"] == "in_turn":
            for i in self.particles:
                for touch in (*self.neighbours(i, self.particles), *self.surfaces(i)):
                    f_n, f_s, f_r = self.force(i, touch)
                    self.receive(i, touch, f_n, f_s, self.rolling_levers(i, touch)[0] * f_r)
                self.move(i)
        else:
            self.collect_all(self.force)
            for i in self.particles:
                self.move(i)

    def collect_all(self, force: Callable) -> None:
        """The loads of all contacts, each pair once."""
        for i in self.particles:
            for touch in self.neighbours(i, self.particles[i + 1 :]):
                f_n, f_s, f_r = force(i, touch)
                of_i, of_j = self.rolling_levers(i, touch)
                self.receive(i, touch, f_n, f_s, of_i * f_r)
                seen_from_j = touch._replace(cos=-touch.cos, sin=-touch.sin)
                self.receive(touch.partner, seen_from_j, f_n, f_s, -of_j * f_r)
        for i in self.particles:
            for touch in self.surfaces(i):
                self.receive(i, touch, *force(i, touch))

    def neighbours(self, i: int, others: range) -> Iterator[_Touch]:
        """Those of `others` in contact with particle i, or held by a joint that its strength would not stretch so far."""
        x, y, _ = self.position[i]
        r, law = self.radius[i], self.case["contact"]["particle_particle"]
        stretch = law.get("tensile_strength_N", 0.0) / law["normal_stiffness_N_m"]
        for j in others:
            dx, dy = self.position[j][0] - x, self.position[j][1] - y
            reach = r + self.radius[j]
            farthest = reach + (stretch if (i, j) in self.springs_before else 0.0)
            if dx * dx + dy * dy < farthest * farthest and j != i:
                distance = math.sqrt(dx * dx + dy * dy)
                inverse = 1 / distance
                yield _Touch(j, law, reach - distance, dx * inverse, dy * inverse)

    def surfaces(self, i: int) -> Iterator[_Touch]:
        """Walls and bar in contact with particle i."""
        x, y, _ = self.position[i]
        r, law = self.radius[i], self.case["contact"]["particle_wall"]
        width = self.case["container"]["width_m"]
        if x < r:
            yield _Touch("left", law, r - x, -1.0, 0.0)
        if width - x < r:
            yield _Touch("right", law, r - (width - x), 1.0, 0.0)
        if y < r:
            yield _Touch("floor", law, r - y, 0.0, -1.0)
        if self.bar:
            dx, dy = self.to_bar(x, y)
            distance = math.sqrt(dx * dx + dy * dy)
            at_corner = dx != 0 and dy != 0
            if distance < r and not (at_corner and self.reading["bar_corner"] == "faces_only"):
                yield _Touch("bar", law, r - distance, dx / distance, dy / distance)

    def to_bar(self, x: float, y: float) -> tuple[float, float]:
        """From (x, y) to the nearest point of the rectangle."""
        centre, half = self.bar["centre_x_m"], self.bar["width_m"] / 2
        top = self.tip + self.bar["length_m"]
        return min(max(x, centre - half), centre + half) - x, min(max(y, self.tip), top) - y

    def clear_loads(self) -> None:
        self.load = [[0.0] * 3 for _ in self.particles]  # X, Y, -M / r
        self.bar_force, self.tip_force, self.floor_force = (0.0, 0.0), 0.0, 0.0

    def receive(self, i: int, touch: _Touch, f_n: float, f_s: float, rim_force: float) -> None:
        """Eqs 10-12; `rim_force` acts against rolling, at the radius of i."""
        x = -f_n * touch.cos + f_s * touch.sin
        y = -f_n * touch.sin - f_s * touch.cos
        load = self.load[i]
        load[0] += x
        load[1] += y
        load[2] += self.lever(i, touch) * f_s + rim_force
        if touch.partner == "bar":
            self.bar_force = (self.bar_force[0] - x, self.bar_force[1] - y)
            if self.position[i][1] < self.tip:
                self.tip_force -= y
        elif touch.partner == "floor":
            self.floor_force -= y

    def lever(self, i: int, touch: _Touch) -> float:
        """From i's centre to where the shear force acts, in radii."""
        to_contact_point = self.reading["torque_arm"] == "contact_point"
        return 1 - touch.overlap / 2 / self.radius[i] if to_contact_point else 1.0

    def arm(self, i: int, touch: _Touch) -> float:
        return self.lever(i, touch) * self.radius[i]

    def relative(self, motion: list, i: int, touch: _Touch, bar_motion: float) -> tuple:
        """Eqs 1, 2 for the displacements of a step, or for velocities."""
        x, y, turn = motion[i]
        turning = self.arm(i, touch) * turn
        if touch.partner == "bar":
            y -= bar_motion
        elif isinstance(touch.partner, int):
            x_j, y_j, turn_j = motion[touch.partner]
            x, y = x - x_j, y - y_j
            turning += self.arm(touch.partner, touch) * turn_j
        return x * touch.cos + y * touch.sin, -x * touch.sin + y * touch.cos + turning

    def rolling_levers(self, i: int, touch: _Touch) -> tuple[float, float]:
        """The radius r_i r_j / (r_i + r_j) by which i rolls on its partner, in radii of i and of that."""
        if not isinstance(touch.partner, int):
            return 1.0, 0.0
        r_i, r_j = self.radius[i], self.radius[touch.partner]
        return r_j / (r_i + r_j), r_i / (r_i + r_j)

    def rolled(self, i: int, touch: _Touch) -> float:
        """The way by which i has rolled on its partner."""
        of_i, of_j = self.rolling_levers(i, touch)
        way = of_i * (self.radius[i] * self.displacement[i][2])
        if isinstance(j := touch.partner, int):
            way -= of_j * (self.radius[j] * self.displacement[j][2])
        return way

    def force(self, i: int, touch: _Touch) -> tuple[float, float, float]:
        """Eqs 1-9: f_n and f_s of one contact, and f_r against rolling."""
        reading, law, dt = self.reading, touch.law, self.dt
        u_n, u_s = self.relative(self.displacement, i, touch, -self.bar_speed * dt)
        damped_n, damped_s = u_n, u_s
        strength = law.get("tensile_strength_N", 0.0)
        e_n, e_s, e_r = self.springs_before.get((i, touch.partner), (None, None, None))
        if e_n is None:
            e_n = e_s = e_r = 0.0
            u_s *= {  # Eq 4
                "clamped_share": min(touch.overlap / u_n, 1.0) if u_n > 0 else 0.0,
                "raw_share": touch.overlap / u_n if u_n != 0 else 0.0,
                "whole_step": 1.0,
            }[reading["first_contact_shear"]]
            u_n = touch.overlap  # Eq 3
            damped_s = u_s
            if reading["first_contact_normal"] == "spring_and_dashpot":
                damped_n = u_n
        if reading["dashpot_velocity"] == "true_velocity":
            v_n, v_s = self.relative(self.velocity, i, touch, -self.bar_speed)
            damped_n, damped_s = v_n * dt, v_s * dt

        e_n += law["normal_stiffness_N_m"] * u_n  # Eq 5
        if reading["normal_spring"] == "overlap":
            e_n = law["normal_stiffness_N_m"] * touch.overlap
        if e_n < -strength:  # Eq 8
            kept = {"keep_zero": 0.0, "keep_negative": e_n}.get(reading["lost_contact"])
            if kept is not None:
                self.springs[i, touch.partner] = (kept, 0.0, 0.0)
            return 0.0, 0.0, 0.0
        f_n = e_n + law["normal_damping_N_s_m"] / dt * damped_n  # Eq 6
        if reading["attraction"] == "clipped":
            f_n = max(f_n, -strength)

        e_s += law["shear_stiffness_N_m"] * u_s  # Eq 7
        f_s = e_s + law["shear_damping_N_s_m"] / dt * damped_s
        pressed = abs(f_n + strength) if reading["slip_cap"] == "total" else e_n + strength
        if abs(e_s) > law["friction"] * pressed:  # Eq 9
            f_s = e_s = math.copysign(law["friction"] * pressed, e_s)

        # as Eqs 7 and 9, without a dashpot
        e_r += law["shear_stiffness_N_m"] * self.rolled(i, touch)
        e_r = math.copysign(min(abs(e_r), law.get("rolling_friction", 0.0) * pressed), e_r)
        self.springs[i, touch.partner] = (e_n, e_s, e_r)
        return f_n, f_s, e_r

    def move(self, i: int) -> None:
        """Eqs 13-24 for particle i; velocity Verlet has moved it before, and gives it the second half of its kick."""
        integrator = self.reading["integrator"]
        if integrator == "velocity_verlet":
            return self.accelerate(i, self.dt / 2)
        self.accelerate(i, self.dt)
        self.displace(i, averaged=integrator == "averaged_displacement")

    def accelerate(self, i: int, dt: float) -> None:
        """Eqs 12-18."""
        x, y, shear = self.load[i]
        push, turn = dt / self.mass[i], self.radius[i] * (dt / self.inertia[i])
        gained = (x * push, y * push - self.case["gravity_m_s2"] * dt, -shear * turn)
        self.velocity[i] = [v + more for v, more in zip(self.velocity[i], gained)]

    def displace(self, i: int, averaged: bool) -> None:
        """Eqs 19-24; if not averaged, a step's displacement is velocity times time."""
        moved = [v * self.dt for v in self.velocity[i]]
        if averaged:
            moved = [(old + new) / 2 for old, new in zip(self.displacement[i], moved)]
        self.displacement[i] = moved
        self.position[i] = [p + u for p, u in zip(self.position[i], moved)]
