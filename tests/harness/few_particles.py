"""Cases of a few given particles: a heap thrown into a narrow box, or whatever a test needs."""

from __future__ import annotations

import random
from dataclasses import astuple, dataclass
from pathlib import Path

from crossdem.adapters.case import Case, load_case

NAMES = "x_m y_m radius_m velocity_x_m_s velocity_y_m_s angular_velocity_rad_s".split()

CASE = """\
schema_version = 1
name = "few_particles"

[container]
width_m = 0.02
height_m = 0.06
thickness_m = 0.01

[particles]
density_kg_m3 = 1530.0

[contact.particle_particle]
normal_stiffness_N_m = 1000.0
shear_stiffness_N_m = 250.0
normal_damping_N_s_m = 0.774
shear_damping_N_s_m = 0.387
friction = 0.75

[contact.particle_wall]
normal_stiffness_N_m = 1000.0
shear_stiffness_N_m = 250.0
normal_damping_N_s_m = 0.774
shear_damping_N_s_m = 0.387
friction = 0.25

[time]
step_s = 1e-4
penetration_s = 0.1
sample_interval_s = 0.001
frame_interval_s = 0.01
"""

BAR = """
[bar]
width_m = 0.006
centre_x_m = 0.01
speed_m_s = 0.2
tip_m = {tip_m!r}
"""


@dataclass(frozen=True)
class Disc:
    """A particle as it starts [m, m/s, rad/s]."""

    x: float
    y: float
    radius: float = 0.0025
    velocity_x: float = 0.0
    velocity_y: float = 0.0
    spin: float = 0.0


def few_particles(
    discs: list[Disc], folder: Path, *overrides: str, bar_tip_m: float | None = None
) -> Case:
    """A case of these `discs`, with the bar's bottom face at `bar_tip_m` if that is given; its file goes to `folder`."""
    text = CASE if bar_tip_m is None else CASE + BAR.format(tip_m=float(bar_tip_m))
    for disc in discs:
        lines = [f"{name} = {float(value)!r}" for name, value in zip(NAMES, astuple(disc))]
        text += "\n[[particle]]\n" + "\n".join(lines) + "\n"
    path = folder / "few_particles.toml"
    path.write_text(text)
    return load_case(path, overrides)


def heap(count: int, width_m: float, spacing_m: float = 0.0052, seed: int = 1) -> list[Disc]:
    """Discs of both sizes of the paper on a jittered lattice, with random velocities and spins.

    A row has as many as fit at `spacing_m`, which is also the distance of rows; below 5.1 mm some overlap at the start.
    """
    rng = random.Random(seed)
    columns = int(width_m // spacing_m)
    discs = []
    for k in range(count):
        row, column = divmod(k, columns)
        disc = Disc(
            x=(column + 0.5) * width_m / columns + rng.uniform(-4e-5, 4e-5),
            y=(row + 0.5) * spacing_m + rng.uniform(-4e-5, 4e-5),
            radius=rng.choice([0.002, 0.0025]),
            velocity_x=rng.uniform(-0.2, 0.2),
            velocity_y=rng.uniform(-0.2, 0.2),
            spin=rng.uniform(-20, 20),
        )
        discs.append(disc)
    return discs


def top_of(discs: list[Disc]) -> float:
    """Height of the highest point [m]."""
    return max(disc.y + disc.radius for disc in discs)
