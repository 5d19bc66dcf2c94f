"""What speed is measured on: cases made from one case with a bed and a bar, the paper's unless told otherwise."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from crossdem.adapters.case import Case, varied_table
from crossdem.adapters.engines import DEFAULT_ENGINES, get_engine

PENETRATION_STEPS = 90_000  # of `bar`: as many as the paper's own penetration has
# Of a static bed: a third of a second at 10 ns, a quarter of a minute at 500.
PARTICLE_STEPS = 30_000_000
# Of any: enough that the first step, in which the contacts are found, is a small part; and so many that a few discs end.
FEWEST_STEPS, MOST_STEPS = 300, 300_000
QUICK = 100  # times fewer steps
LAMMPS = "lammps"  # a user's engine, to which the case gives no time step


@dataclass(frozen=True)
class Workload:
    """What engines run, and from where."""

    name: str
    case: Case  # with one sample and one frame, at the end of the rest and at the end
    bed: Case  # that its packing is made from: the same for all that start from the same bed


def bar(case: Case, quick: bool) -> Workload:
    """The bar pushed down, at the largest time step at which every engine's bed rests: the smallest of the case's."""
    step_s = min(get_engine(engine).step_s(case) for engine in DEFAULT_ENGINES)
    time = case.resolved["time"]
    steps = min(PENETRATION_STEPS, round(time["penetration_s"] / step_s)) // (QUICK if quick else 1)
    rest_s = round(time["rest_s"] / step_s / (QUICK if quick else 1)) * step_s
    return Workload("bar", _at_step(case, step_s, rest_s, steps), case)


def time_to_solution(case: Case, quick: bool) -> Workload:
    """The whole case, each engine at its own time step. Never shortened: a part of it is no solution."""
    interval_s = case.resolved["time"]["penetration_s"]
    time = case.resolved["time"] | _one_output(interval_s)
    return Workload("time-to-solution", varied_table(case, time=time), case)


def static(
    particles: int, particle_steps: int = PARTICLE_STEPS
) -> Callable[[Case, bool], Workload]:
    """A bed at rest, as deep as that of the case and as much wider as it has more particles, at the time step of `bar`."""

    def workload(case: Case, quick: bool) -> Workload:
        bed = _wide_bed(case, particles)
        step_s = min(get_engine(engine).step_s(case) for engine in DEFAULT_ENGINES)
        steps = min(particle_steps // particles, MOST_STEPS) // (QUICK if quick else 1)
        steps = max(FEWEST_STEPS, steps)
        return Workload(static_name(particles), _at_step(bed, step_s, 0.0, steps), bed)

    return workload


def static_name(particles: int) -> str:
    """ "static-100k"."""
    for size, letter in ((1_000_000, "M"), (1000, "k")):
        if particles % size == 0:
            return f"static-{particles // size}{letter}"
    return f"static-{particles}"


WORKLOADS: dict[str, Callable[[Case, bool], Workload]] = {
    "bar": bar,
    "static-10k": static(10_000),
    "static-100k": static(100_000),
    "time-to-solution": time_to_solution,
}
QUICK_WORKLOADS = ("bar", "static-10k")  # whose beds take seconds, and which can be shortened


def _wide_bed(case: Case, particles: int) -> Case:
    """The case without its bar. Width, not height, makes room: a deeper bed would press its lowest discs into one another."""
    values = case.resolved
    share = particles / values["particles"]["count"]
    packing = values["packing"]
    return varied_table(
        case,
        bar=None,
        particles=values["particles"] | {"count": particles},
        container=values["container"]
        | {"width_m": values["container"]["width_m"] * max(1.0, share)},
        # as quiet as the case's bed is, particle by particle
        packing=packing | {"kinetic_energy_J": packing["kinetic_energy_J"] * max(1.0, share)},
    )


def _at_step(case: Case, step_s: float, rest_s: float, steps: int) -> Case:
    time = {"step_s": step_s, "rest_s": rest_s, "penetration_s": steps * step_s}
    return varied_table(
        case,
        time=case.resolved["time"] | time | _one_output(steps * step_s),
        engines={engine: {"step_s": step_s} for engine in (*case.resolved["engines"], LAMMPS)},
    )


def _one_output(interval_s: float) -> dict[str, float]:
    """The fewest samples and frames that a case can ask for: no engine can be told to write none."""
    return {"sample_interval_s": interval_s, "frame_interval_s": interval_s}
