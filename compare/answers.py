"""The answers that a case can name: what is measured on a run, and what is known of it beforehand.

What is known is a closed form in the limit of a vanishing time step, or an invariant, which holds at every time step.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from crossdem.adapters.dataset import Dataset
from crossdem.adapters.names import unknown_name

from . import exact, measures
from .engine_laws import EngineLaw
from .quantities import numbered_tables
from .start import Start


@dataclass(frozen=True)
class Answer:
    """One number of a run, and what it must be."""

    title: str  # as people say it
    unit: str  # "" for a plain number
    measured: Callable[[Dataset], float]
    exact: Callable[[Start, EngineLaw], float]
    most: int = 1000  # particles in a case that can ask for it
    bar: bool = False  # whether it needs one
    every_step: bool = False  # an invariant: it holds at any time step, not only in the limit
    own_step: bool = False  # asked at the engine's own time step alone

    @property
    def name(self) -> str:
        """As in the case's [[answer]] tables."""
        return self.measured.__name__

    @property
    def definition(self) -> str:
        return " ".join((self.measured.__doc__ or "").split())


ANSWERS = {
    answer.name: answer
    for answer in (
        Answer("fall", "m", measures.fall_m, exact.fall),
        Answer("speed of fall", "m/s", measures.fall_speed_m_s, exact.fall_speed),
        Answer("floor / weight", "", measures.floor_force_over_weight, exact.one, every_step=True),
        Answer(
            "floor / weight at rest",
            "",
            measures.floor_force_over_weight_at_rest,
            exact.one,
            every_step=True,
        ),
        Answer("top of the column", "m", measures.column_top_m, exact.column_top, every_step=True),
        Answer(
            "rebound / impact speed",
            "",
            measures.rebound_over_impact_speed,
            exact.rebound_speed,
            most=1,
        ),
        Answer("restitution", "", measures.restitution, exact.restitution, most=2),
        Answer(
            "restitution at its step",
            "",
            measures.restitution_at_step,
            exact.restitution,
            most=2,
            own_step=True,
        ),
        Answer(
            "sideways speed kept", "", measures.sideways_speed_ratio, exact.sideways_speed, most=2
        ),
        Answer("rolling / slip", "", measures.rolling_over_slip, exact.rolling, most=2),
        Answer("change of momentum", "", measures.momentum_change, exact.nothing, every_step=True),
        Answer("gain of energy", "", measures.energy_gain, exact.nothing, every_step=True),
        Answer(
            "speed when rolling / slip",
            "",
            measures.rolling_speed_over_slip,
            exact.rolling_speed,
            most=1,
        ),
        Answer(
            "slowing of rolling / g",
            "",
            measures.rolling_slowing_over_g,
            exact.rolling_slowing,
            most=1,
            every_step=True,
        ),
        Answer(
            "parting / pulling speed",
            "",
            measures.parting_over_pulling_speed,
            exact.parting_speed,
            most=2,
        ),
        Answer("sink / bar speed", "", measures.sink_over_bar_speed, exact.sink, most=1, bar=True),
        Answer(
            "rolling / bar speed",
            "",
            measures.rolling_over_bar_speed,
            exact.pinched_rolling,
            most=1,
            bar=True,
        ),
        Answer(
            "side force on the bar",
            "N",
            measures.bar_side_force_N,
            exact.side_force,
            most=1,
            bar=True,
        ),
        Answer(
            "bar load / weight", "", measures.bar_load_over_weight, exact.bar_load, most=1, bar=True
        ),
        Answer(
            "push / corner speed", "", measures.push_over_corner_speed, exact.push, most=1, bar=True
        ),
        Answer(
            "sideways / corner speed",
            "",
            measures.sideways_over_corner_speed,
            exact.nothing,
            most=1,
            bar=True,
        ),
        Answer("restitution in corner", "", measures.corner_restitution, exact.restitution, most=1),
        Answer(
            "asymmetry in corner",
            "",
            measures.corner_asymmetry,
            exact.nothing,
            most=1,
            every_step=True,
        ),
        Answer("pull / push on floor", "", measures.pull_over_push, exact.pull, most=1),
        Answer(
            "floor force when parted",
            "N",
            measures.floor_force_when_parted_N,
            exact.nothing,
            every_step=True,
        ),
    )
}


def answer_faults(case: dict) -> list[str]:
    """A fault line for each answer and expected difference of `case`, resolved or as read, that cannot be had of it."""
    lines = []
    for key in ("answer", "difference"):
        for number, entry in numbered_tables(case, key):
            name = entry.get("quantity")
            if isinstance(name, str) and (fault := _fault(case, name)):
                lines.append(f"{key}[{number}].quantity: {fault}")
    return lines


def _fault(case: dict, name: str) -> str | None:
    answer, particles = ANSWERS.get(name), case.get("particle")
    if answer is None:
        return unknown_name("answer", name, ANSWERS)
    if not isinstance(particles, list) or not 1 <= len(particles) <= answer.most:
        return f"{name} is known of 1 to {answer.most} given [[particle]] tables only"
    if answer.bar and "bar" not in case:
        return f"{name} is asked of a case with a bar"
    return None
