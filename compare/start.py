"""How the few particles of a case with given [[particle]]s start, and the impact that follows."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from .impact import Impact


@dataclass(frozen=True)
class Start:
    """The particles of a resolved case as they start, in its order."""

    case: dict
    radius: np.ndarray  # (N,) [m]
    position: np.ndarray  # (N, 2) [m]
    velocity: np.ndarray  # (N, 2) [m/s]
    spin: np.ndarray  # (N,) [rad/s], counter-clockwise

    @classmethod
    def of(cls, case: dict) -> Start:
        rows = case["particle"]
        column = {key: np.array([row[key] for row in rows]) for key in (rows[0] if rows else ())}
        return cls(
            case,
            column["radius_m"],
            np.column_stack([column["x_m"], column["y_m"]]),
            np.column_stack([column["velocity_x_m_s"], column["velocity_y_m_s"]]),
            column["angular_velocity_rad_s"],
        )

    @property
    def mass(self) -> np.ndarray:
        """(N,) [kg]: rho pi r^2 h."""
        density = self.case["particles"]["density_kg_m3"]
        return density * math.pi * self.radius**2 * self.case["container"]["thickness_m"]

    @property
    def gravity(self) -> float:
        return self.case["gravity_m_s2"]

    @property
    def weight(self) -> float:
        """Of all particles [N]."""
        return float(self.mass.sum() * self.gravity)

    def contact(self) -> dict:
        """The parameters of the one contact there is: of two particles, or of one with a wall."""
        return self.case["contact"]["particle_particle" if self._is_pair else "particle_wall"]

    @property
    def reduced_mass(self) -> float:
        """Of two particles; the mass of one before a wall [kg]."""
        return float(1 / np.sum(1 / self.mass))

    @property
    def normal(self) -> np.ndarray:
        """(2,) from the first particle to what it hits: the second one, else the floor."""
        if not self._is_pair:
            return np.array([0.0, -1.0])
        between = self.position[1] - self.position[0]
        return between / np.linalg.norm(between)

    def approach(self, velocity: np.ndarray) -> float:
        """The speed [m/s] along the normal at which they come together, of (N, 2) velocities."""
        return float(self._relative(velocity) @ self.normal)

    def sideways(self, velocity: np.ndarray) -> float:
        """The speed [m/s] across the normal of one centre past the other, as in Eq (2)."""
        x, y = self.normal
        return float(self._relative(velocity) @ np.array([-y, x]))

    def rolling(self, spin: np.ndarray) -> float:
        """The share of the slip [m/s] that comes from rotation, as in Eq (2): the sum of r w."""
        return float(self.radius @ spin)

    def slip(self) -> float:
        """[m/s] of the surfaces at first touch."""
        return self.sideways(self.velocity) + self.rolling(self.spin)

    def impact(self) -> Impact:
        contact = self.contact()
        return Impact(
            mass=self.reduced_mass,
            normal_stiffness=contact["normal_stiffness_N_m"],
            normal_damping=contact["normal_damping_N_s_m"],
            shear_stiffness=contact["shear_stiffness_N_m"],
            shear_damping=contact["shear_damping_N_s_m"],
            friction=contact["friction"],
            normal_speed=self.approach(self.velocity),
            slip_speed=self.slip(),
            pressed=0.0 if self._is_pair else self.gravity,
        )

    @property
    def _is_pair(self) -> bool:
        return len(self.radius) == 2

    def _relative(self, velocity: np.ndarray) -> np.ndarray:
        return velocity[0] - velocity[1] if self._is_pair else velocity[0]
