"""The paper's averaged displacement (Eqs 19-24) inside YADE, as a memory force. Used by yade_case.py.

With w the displacement of a step over dt, w_t = (w_(t-1) + v_t) / 2 and v_t = v_(t-1) + a dt give
    2 m (w_t - w_(t-1)) = F dt + m (w_(t-1) - w_(t-2)):
what YADE's own integrator does for bodies of mass 2 m with the force m (w_(t-1) - w_(t-2)) / dt added, and the same
for rotation. Gravity pulls at the doubled mass, so that it is halved.
"""

import numpy as np


class AveragedDisplacement:
    """Bodies, by their states, that move so. Their `vel` and `angVel` are w; before the first step w = v."""

    gravity_share = 0.5

    def __init__(self, forces, states, step_s):
        self._forces = forces  # YADE's; the bodies are its first, in their order
        self._states = states
        self._step_s = step_s
        self._masses_kg = [state.mass for state in states]
        self._inertias_kg_m2 = [state.inertia[2] for state in states]
        for state in states:
            state.mass, state.inertia = 2 * state.mass, 2 * state.inertia
        self._before = [self._of(state) for state in states]

    def add_force(self):
        """To be called in every step, after the law and before the integrator."""
        dt = self._step_s
        now = [self._of(state) for state in self._states]
        rows = zip(now, self._before, self._masses_kg, self._inertias_kg_m2)
        for number, ((x, y, spin), (old_x, old_y, old_spin), mass, inertia) in enumerate(rows):
            self._forces.addF(number, (mass * (x - old_x) / dt, mass * (y - old_y) / dt, 0))
            self._forces.addT(number, (0, 0, inertia * (spin - old_spin) / dt))
        self._before = now

    def velocities(self):
        """(N, 3): v = 2 w_t - w_(t-1), of Eqs 16-18; x, y and rotation."""
        now = np.array([self._of(state) for state in self._states])
        return 2 * now - np.array(self._before)

    @staticmethod
    def _of(state):
        velocity = state.vel
        return velocity[0], velocity[1], state.angVel[2]
