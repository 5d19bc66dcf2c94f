"""What the deck liggghts_case.in reads: numbers, discs and bar; never a word of the case."""

from __future__ import annotations

import math

from .packing import Packing
from .schedule import Schedule

PAIRS = ("particle_particle", "particle_wall")
MOST_IN_ONE_BIN = 5000  # discs: finding neighbours among all of them takes their number squared


def number(value: float | int | str) -> str:
    """The only text that may reach a deck: a finite number with all its digits, or one of the words on and off."""
    if value in ("on", "off"):
        return value
    if not math.isfinite(value):
        raise ValueError(f"{value!r} is not a finite number")
    return str(value) if isinstance(value, int) else format(float(value), ".17g")


def numbering(schedule: Schedule) -> tuple[int, int]:
    """The numbers of the first step and of the one at which the rest ends and the bar starts.

    The latter is a multiple of both intervals, as LIGGGHTS writes samples and frames at multiples.
    """
    common = math.lcm(schedule.sample, schedule.frame)
    start_step = -(-schedule.rest // common) * common
    return start_step - schedule.rest, start_step


def numbers(case: dict, schedule: Schedule, packing: Packing, averaged: bool) -> str:
    """The numbers of the case as variables of the deck; SI units, names as the deck uses them."""
    first_step, start_step = numbering(schedule)
    found: dict[str, float | int | str] = {
        "step_s": schedule.step_s,
        "steps": schedule.steps,
        "sample_steps": schedule.sample,
        "frame_steps": schedule.frame,
        "first_step": first_step,
        "start_step": start_step,
        "gravity": case["gravity_m_s2"],
        "width_m": case["container"]["width_m"],
        "skin_m": 0.5 * float(packing.particles["radius_m"].min()),
        "bin_m": _bin_m(case, packing),
        "bars": int("bar" in case),
        "averaged": int(averaged),
        "limit_force": "on" if case["scheme"]["attraction"] == "clipped" else "off",
    }
    if "bar" in case:
        found |= {"speed": case["bar"]["speed_m_s"], "bar_tip_m": packing.bar_tip_m}
    for suffix, pair in zip(("particle", "wall"), PAIRS):
        contact = case["contact"][pair]
        found[f"kn_{suffix}"] = contact["normal_stiffness_N_m"]
        found[f"kt_{suffix}"] = contact["shear_stiffness_N_m"]
        found[f"gamman_{suffix}"] = contact["normal_damping_N_s_m"]
        found[f"gammat_{suffix}"] = contact["shear_damping_N_s_m"]
        found[f"friction_{suffix}"] = contact["friction"]
    rolling = [case["contact"][pair].get("rolling_friction", 0.0) for pair in PAIRS]
    if any(rolling):
        found |= {"rolling_particle": rolling[0], "rolling_wall": rolling[1]}
    return "".join(f"variable {name} string {number(value)}\n" for name, value in found.items())


def resisting_rolling(deck: str) -> str:
    """`deck` with springs against rolling in every contact, LIGGGHTS' "rolling_friction epsd2"."""
    deck = deck.replace("tangential history", "tangential history rolling_friction epsd2")
    return deck.replace("\npair_style", "\ninclude         inputs/liggghts_rolling.in\npair_style")


def particles(case: dict, packing: Packing, half_depth_m: float) -> str:
    """The discs as LIGGGHTS data, in a domain that holds container, bed and bar with room above; in z half as deep."""
    width_m, top_m = case["container"]["width_m"], _top_m(case, packing)
    margin_m = 0.1 * width_m
    density = number(case["particles"]["density_kg_m3"] * case["container"]["thickness_m"])
    head = [
        "discs of the packing",
        "",
        f"{len(packing.particles)} atoms",
        "2 atom types",
        f"{number(-margin_m)} {number(width_m + margin_m)} xlo xhi",
        f"{number(-margin_m)} {number(top_m)} ylo yhi",
        f"{number(-half_depth_m)} {number(half_depth_m)} zlo zhi",
        "",
        "Atoms",
        "",
    ]
    atoms, velocities = [], []
    for row in packing.particles.itertuples():
        place = f"{number(row.x_m)} {number(row.y_m)} 0"
        atoms.append(f"{row.id + 1} 1 {number(2 * row.radius_m)} {density} {place}")
        velocity = f"{number(row.velocity_x_m_s)} {number(row.velocity_y_m_s)} 0"
        velocities.append(f"{row.id + 1} {velocity} 0 0 {number(row.angular_velocity_rad_s)}")
    return "\n".join([*head, *atoms, "", "Velocities", "", *velocities, ""])


def _top_m(case: dict, packing: Packing) -> float:
    """Upper end of the domain: a container's height above all that is there at the start, and above where it flies."""
    discs, time = packing.particles, case["time"]
    rising_m_s = discs["velocity_y_m_s"].clip(lower=0)
    rise_m = rising_m_s * (time["rest_s"] + time["penetration_s"])
    if case["gravity_m_s2"] > 0:
        rise_m = rise_m.clip(upper=rising_m_s**2 / (2 * case["gravity_m_s2"]))
    highest_m = float((discs["y_m"] + rise_m + discs["radius_m"]).max())
    if "bar" in case:
        highest_m = max(highest_m, packing.bar_tip_m + case["bar"]["length_m"])
    return highest_m + case["container"]["height_m"]


def _bin_m(case: dict, packing: Packing) -> float:
    """Bins for few discs hold them all, which makes the order of every sum known; 0 stands for LIGGGHTS' own choice."""
    if len(packing.particles) > MOST_IN_ONE_BIN:
        return 0.0
    return 2 * max(case["container"]["width_m"], _top_m(case, packing))


def half_depth_m(packing: Packing) -> float:
    """Half the domain in z: a domain shallower than 0.05 m aborts once there is a mesh."""
    return max(0.5, 100 * float(packing.particles["radius_m"].max()))


def bar(case: dict, packing: Packing) -> str:
    """The bar's faces as STL. An edge belongs to its later triangle: the bottom comes last and owns the corners."""
    shape = case["bar"]
    left_m = shape["centre_x_m"] - shape["width_m"] / 2
    right_m = shape["centre_x_m"] + shape["width_m"] / 2
    bottom_m, top_m = packing.bar_tip_m, packing.bar_tip_m + shape["length_m"]
    half_m = 1.6 * float(packing.particles["radius_m"].max())  # in z: edges out of the discs' reach
    faces = (
        ((-1, 0), (left_m, bottom_m), (left_m, top_m)),
        ((1, 0), (right_m, top_m), (right_m, bottom_m)),
        ((0, -1), (right_m, bottom_m), (left_m, bottom_m)),
    )
    lines = ["solid bar"]
    for normal, start, end in faces:
        corners = [(*start, -half_m), (*end, -half_m), (*end, half_m), (*start, half_m)]
        for triangle in (corners[:3], [corners[0], *corners[2:]]):
            lines += [f"facet normal {normal[0]} {normal[1]} 0", "outer loop"]
            lines += ["vertex " + " ".join(map(number, corner)) for corner in triangle]
            lines += ["endloop", "endfacet"]
    return "\n".join([*lines, "endsolid bar", ""])
