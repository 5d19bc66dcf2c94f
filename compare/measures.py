"""What the ladder measures on a run of few particles: one number each."""

from __future__ import annotations

import numpy as np

from crossdem.adapters.dataset import Dataset

from .start import Start


def fall_m(run: Dataset) -> float:
    """Way that the first particle has come down at the end."""
    heights = run.motion.position_m[:, 0, 1]
    return float(heights[0] - heights[-1])


def fall_speed_m_s(run: Dataset) -> float:
    """Speed downwards of the first particle at the end."""
    return float(-run.motion.velocity_m_s[-1, 0, 1])


def floor_force_over_weight(run: Dataset) -> float:
    """Force on the floor at the end, over the weight of all particles."""
    return _floor_force(run, -1)


def floor_force_over_weight_at_rest(run: Dataset) -> float:
    """Force on the floor when the rest is over and the bar starts, over the weight of all particles."""
    return _floor_force(run, 0)


def column_top_m(run: Dataset) -> float:
    """Height of the highest centre at the end."""
    return float(run.motion.position_m[-1, :, 1].max())


def rebound_over_impact_speed(run: Dataset) -> float:
    """Speed at which the first particle leaves the floor over that at which it came, from its energy at the end."""
    start = Start.of(run.case)
    height_m = run.motion.position_m[-1, 0, 1] - start.position[0, 1]
    square = run.motion.velocity_m_s[-1, 0, 1] ** 2 + 2 * start.gravity * height_m
    return float(np.sqrt(square)) / start.approach(start.velocity) if square >= 0 else np.nan


def restitution(run: Dataset) -> float:
    """Speed of parting over speed of approach, along the normal of the first touch."""
    start = Start.of(run.case)
    return -start.approach(run.motion.velocity_m_s[-1]) / start.approach(start.velocity)


def restitution_at_step(run: Dataset) -> float:
    """As restitution, at the engine's own time step alone."""
    return restitution(run)


def sideways_speed_ratio(run: Dataset) -> float:
    """Speed of the centres across the normal of the first touch, at the end over that at the start."""
    start = Start.of(run.case)
    return start.sideways(run.motion.velocity_m_s[-1]) / start.sideways(start.velocity)


def rolling_over_slip(run: Dataset) -> float:
    """Sum of radius x spin at the end, over the slip of the surfaces at first touch."""
    start = Start.of(run.case)
    return start.rolling(run.motion.angular_velocity_rad_s[-1]) / start.slip()


def momentum_change(run: Dataset) -> float:
    """Change of the particles' momentum, over the sum of its amounts at the start."""
    start = Start.of(run.case)
    change = start.mass @ (run.motion.velocity_m_s[-1] - start.velocity)
    return float(np.hypot(*change) / (start.mass @ np.hypot(*start.velocity.T)))


def energy_gain(run: Dataset) -> float:
    """Largest excess of kinetic and potential energy over that of the start, as a share of the latter; the floor is the
    potential's zero, and what springs hold is left out.
    """
    start = Start.of(run.case)
    energies = [
        _energy(start, start.position, start.velocity, start.spin),
        *map(
            lambda *frame: _energy(start, *frame),
            run.motion.position_m,
            run.motion.velocity_m_s,
            run.motion.angular_velocity_rad_s,
        ),
    ]
    return max(energies) / energies[0] - 1


def rolling_speed_over_slip(run: Dataset) -> float:
    """Speed to the right of the first particle at the end, over the slip of its surface on the floor at the start."""
    return float(run.motion.velocity_m_s[-1, 0, 0]) / Start.of(run.case).slip()


def rolling_slowing_over_g(run: Dataset) -> float:
    """Speed to the right that the first particle loses in the second half of the time, over g times that time."""
    middle = len(run.motion.time_s) // 2
    lost_m_s = float(run.motion.velocity_m_s[middle, 0, 0] - run.motion.velocity_m_s[-1, 0, 0])
    time_s = float(run.motion.time_s[-1] - run.motion.time_s[middle])
    return lost_m_s / (Start.of(run.case).gravity * time_s)


def parting_over_pulling_speed(run: Dataset) -> float:
    """Speed of parting of two particles at the end, over that at which they are drawn apart at the start."""
    start = Start.of(run.case)
    return start.approach(run.motion.velocity_m_s[-1]) / start.approach(start.velocity)


def sink_over_bar_speed(run: Dataset) -> float:
    """Speed downwards of the first particle at the end, over that of the bar."""
    return fall_speed_m_s(run) / run.case["bar"]["speed_m_s"]


def rolling_over_bar_speed(run: Dataset) -> float:
    """Radius x spin of the first particle at the end, over the speed of the bar."""
    spin = abs(float(run.motion.angular_velocity_rad_s[-1, 0]))
    return spin * float(run.radius_m[0]) / run.case["bar"]["speed_m_s"]


def bar_side_force_N(run: Dataset) -> float:
    """Horizontal force on the bar at the end."""
    return float(run.resistance["force_x_N"].iloc[-1])


def bar_load_over_weight(run: Dataset) -> float:
    """Force downwards on the bar at the end, over the weight of all particles."""
    weight = Start.of(run.case).weight
    return float(-run.resistance["force_y_N"].iloc[-1]) / weight if weight else np.nan


def push_over_corner_speed(run: Dataset) -> float:
    """Speed at which the bar's corner drives off the first particle along the line from it to the particle's centre at
    first touch, over the corner's own speed along that line.
    """
    along, _ = _from_corner(run)
    return along


def sideways_over_corner_speed(run: Dataset) -> float:
    """As push_over_corner_speed, across that line."""
    _, across = _from_corner(run)
    return across


def corner_restitution(run: Dataset) -> float:
    """Speed away from both walls of a corner over that at which the first particle came; the mean of both."""
    ratio = -run.motion.velocity_m_s[-1, 0] / Start.of(run.case).velocity[0]
    return float(ratio.mean())


def corner_asymmetry(run: Dataset) -> float:
    """Difference between the two walls' restitutions, and the spin that it leaves, over the speed of approach."""
    start = Start.of(run.case)
    ratio = run.motion.velocity_m_s[-1, 0] / start.velocity[0]
    spin = start.rolling(run.motion.angular_velocity_rad_s[-1]) / np.hypot(*start.velocity[0])
    return float(abs(ratio[0] - ratio[1]) + abs(spin))


def pull_over_push(run: Dataset) -> float:
    """Largest force upwards on the floor over the largest one downwards."""
    force_N = run.resistance["floor_force_y_N"]
    return float(max(force_N.max(), 0.0) / -force_N.min())


def floor_force_when_parted_N(run: Dataset) -> float:
    """Largest force on the floor, up or down, in the last quarter of the time."""
    force_N = run.resistance["floor_force_y_N"]
    return float(force_N.iloc[3 * len(force_N) // 4 :].abs().max())


def _floor_force(run: Dataset, sample: int) -> float:
    weight = Start.of(run.case).weight
    return float(-run.resistance["floor_force_y_N"].iloc[sample]) / weight if weight else np.nan


def _energy(start: Start, position_m, velocity_m_s, spin_rad_s) -> float:
    inertia = start.mass * start.radius**2 / 2
    kinetic = start.mass @ (velocity_m_s**2).sum(axis=1) + inertia @ spin_rad_s**2
    return float(kinetic / 2 + start.gravity * start.mass @ position_m[:, 1])


def _from_corner(run: Dataset) -> tuple[float, float]:
    start = Start.of(run.case)
    bar = run.case["bar"]
    side = np.sign(start.position[0, 0] - bar["centre_x_m"])
    corner_m = np.array([bar["centre_x_m"] + side * bar["width_m"] / 2, run.motion.bar_tip_m[0]])
    line = (start.position[0] - corner_m) / np.linalg.norm(start.position[0] - corner_m)
    velocity = run.motion.velocity_m_s[-1, 0]
    corner_speed = -bar["speed_m_s"] * line[1]
    across = velocity @ np.array([-line[1], line[0]])
    return float(velocity @ line / corner_speed), float(across / corner_speed)
