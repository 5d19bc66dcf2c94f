"""What makes a run's data unfit to be a Dataset: every fault found, in words."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pandas as pd

from .motion_file import Motion

SCHEMA_VERSION = 1

# Each column of resistance.csv with its definition; the last part of a name is its unit.
RESISTANCE = {
    "time_s": "0 at the end of the rest, when the bar starts",
    "depth_m": "travel of the bar since then; 0 without a bar, as are the four forces that follow",
    "force_x_N": "horizontal force of the particles on the bar, at that step; > 0 is to the right",
    "force_y_N": "vertical force of the particles on the bar, at that step; > 0 is upwards, the penetration resistance",
    "tip_force_y_N": "share of force_y_N on the bottom face and its corners",
    "shaft_force_y_N": "share of force_y_N on the bar's sides",
    "floor_force_y_N": "vertical force of the particles on the floor, at that step; < 0 is downwards",
    "contacts": "pairs of particles that overlap, without walls and bar",
    "kinetic_energy_J": "kinetic energy of all particles, rotation (I = m r^2 / 2) included",
}
RESISTANCE_COLUMNS = tuple(RESISTANCE)

MANIFEST_KEYS = {  # and what each holds
    "schema_version": int,
    "case_name": str,
    "case_hash": str,
    "packing_hash": str,
    "seed": int,
    "twin": int,
    "engine": str,
    "engine_version": str,
    "compiler": str | None,
    "time_step_s": float | int,
    "command": list,
    "started_utc": str,
    "wall_s": float | int,
    "cpu_s": float | int,
    "particles": int,
    "frames": int,
    "samples": int,
    "limitations": list,
    "gates": object,  # a list of objects with GATE_KEYS
    "run_key": str,
}

# Of the case, by table, what data are compared with. The solver has read it before; a file may have been spoilt since.
CASE_NUMBERS = {
    "particles": ("count",),
    "time": ("penetration_s", "sample_interval_s", "frame_interval_s"),
    "container": ("width_m", "height_m"),
}
BAR_NUMBERS = ("speed_m_s", "centre_x_m", "width_m", "length_m")
MOST = (
    1e15  # of such a number, in its unit: far above any use, far below what cannot be computed with
)

GATE_KEYS = {"name", "value", "limit", "passed", "message"}

TIME_TOLERANCE_S = 1e-9  # far below any time step, far above round-off
LENGTH_TOLERANCE_M = 1e-9
FORCE_TOLERANCE_N = 1e-9  # for the sum of tip and shaft
FORCE_ROUNDING = (
    1e-12  # the same, as a share of the largest force: contacts are summed in another order
)


def sample_times_s(case: dict) -> np.ndarray:
    """The times [s] of the rows of resistance that `case` asks for."""
    return _times_s(case, "sample_interval_s")


def frame_times_s(case: dict) -> np.ndarray:
    """The times [s] of the frames of motion that `case` asks for."""
    return _times_s(case, "frame_interval_s")


def bar_speed_m_s(case: dict) -> float:
    """[m/s] downwards; 0 without a bar."""
    return case["bar"]["speed_m_s"] if "bar" in case else 0.0


def faults(
    case: dict, manifest: dict, radius_m: np.ndarray, motion: Motion, resistance: pd.DataFrame
) -> list[str]:
    """Why these are not one whole, sane run of `case`; a later kind of fault only once the earlier are clean."""
    for find in (_case_faults, _manifest_faults, _shape_faults, _finite_faults, _value_faults):
        found = list(find(case, manifest, np.asarray(radius_m), motion, resistance))
        if found:
            return found
    return []


def _times_s(case: dict, interval_key: str) -> np.ndarray:
    return np.arange(_count_of_times(case, interval_key)) * case["time"][interval_key]


def _count_of_times(case: dict, interval_key: str) -> int:
    return round(case["time"]["penetration_s"] / case["time"][interval_key]) + 1


def _case_faults(case, manifest, radius_m, motion, resistance) -> Iterator[str]:
    wanted = CASE_NUMBERS | ({"bar": BAR_NUMBERS} if "bar" in case else {})
    for name, keys in wanted.items():
        table = case.get(name)
        for key in keys:
            value = table.get(key) if isinstance(table, dict) else None
            if type(value) not in (int, float) or not 0 < value < MOST:
                yield f"the case's {name}.{key} is not a positive number"


def _manifest_faults(case, manifest, radius_m, motion, resistance) -> Iterator[str]:
    missing = [key for key in MANIFEST_KEYS if key not in manifest]
    if missing:
        yield f"the manifest lacks {', '.join(missing)}"
    elif manifest["schema_version"] != SCHEMA_VERSION:
        yield f"the manifest is of schema version {manifest['schema_version']!r}; this crossdem reads {SCHEMA_VERSION}"
    elif wrong := [key for key, kind in MANIFEST_KEYS.items() if not _is(manifest[key], kind)]:
        yield f"the manifest's {', '.join(wrong)} are not of the kind that they must be"
    elif not isinstance(manifest["gates"], list) or not all(
        isinstance(gate, dict) and gate.keys() >= GATE_KEYS for gate in manifest["gates"]
    ):
        yield f"the manifest's gates are not a list of objects with {', '.join(sorted(GATE_KEYS))}"


def _is(value, kind) -> bool:
    return isinstance(value, kind) and not isinstance(value, bool)


def _shape_faults(case, manifest, radius_m, motion, resistance) -> Iterator[str]:
    if tuple(resistance.columns) != RESISTANCE_COLUMNS:
        found = ", ".join(map(str, resistance.columns))
        yield f"the resistance has the columns {found}; expected {', '.join(RESISTANCE_COLUMNS)}"
    else:
        text = [name for name in RESISTANCE_COLUMNS if resistance[name].dtype.kind not in "iuf"]
        if text:
            yield f"the resistance has columns that are not numbers: {', '.join(text)}"

    particles = case["particles"]["count"]
    frames = _count_of_times(case, "frame_interval_s")
    samples = _count_of_times(case, "sample_interval_s")
    if len(resistance) != samples:
        yield f"{len(resistance)} of {samples} samples"
    if len(motion.time_s) != frames:
        yield f"{len(motion.time_s)} of {frames} frames"
    if radius_m.shape != (particles,):
        yield f"{len(radius_m)} of {particles} particles"
    shapes = {
        "time_s": (frames,),
        "position_m": (frames, particles, 2),
        "velocity_m_s": (frames, particles, 2),
        "angular_velocity_rad_s": (frames, particles),
        "angle_rad": (frames, particles),
        "bar_tip_m": (frames,),
    }
    if ("bar" in case) != (motion.bar_tip_m is not None):
        yield "the case has a bar, the motion none" if "bar" in case else "the motion has a bar, the case none"
    for name, shape in shapes.items():
        values = getattr(motion, name)
        if values is not None and np.shape(values) != shape:
            yield f"the motion's {name} has the shape {np.shape(values)}; expected {shape}"
    counted = {"particles": particles, "frames": frames, "samples": samples}
    for key, expected in counted.items():
        if manifest[key] != expected:
            yield f"the manifest says {manifest[key]!r} {key}; the case {expected}"


def _finite_faults(case, manifest, radius_m, motion, resistance) -> Iterator[str]:
    for name in RESISTANCE_COLUMNS:
        if not np.isfinite(resistance[name]).all():
            yield f"the resistance's {name} is not finite everywhere"
    for name, values in vars(motion).items():
        if values is not None and not np.isfinite(values).all():
            yield f"the motion's {name} is not finite everywhere"
    if not (np.isfinite(radius_m).all() and (radius_m > 0).all()):
        yield "a radius is not a positive number"


def _value_faults(case, manifest, radius_m, motion, resistance) -> Iterator[str]:
    speed_m_s = bar_speed_m_s(case)
    if not np.allclose(resistance["time_s"], sample_times_s(case), rtol=0, atol=TIME_TOLERANCE_S):
        yield "the samples are not at the times that the case asks for"
    if not np.allclose(motion.time_s, frame_times_s(case), rtol=0, atol=TIME_TOLERANCE_S):
        yield "the frames are not at the times that the case asks for"
    if not np.allclose(
        resistance["depth_m"], speed_m_s * resistance["time_s"], rtol=0, atol=LENGTH_TOLERANCE_M
    ):
        yield "depth_m is not the bar's speed times time_s"
    tip_m = motion.bar_tip_m
    if tip_m is not None and not np.allclose(
        tip_m, tip_m[0] - speed_m_s * motion.time_s, rtol=0, atol=LENGTH_TOLERANCE_M
    ):
        yield "bar_tip_m does not move with the bar's speed"

    parts_N = resistance["tip_force_y_N"] + resistance["shaft_force_y_N"]
    gap_N = float(np.max(np.abs(parts_N - resistance["force_y_N"])))
    largest_N = float(np.max(np.abs(resistance["force_y_N"])))
    if gap_N > FORCE_TOLERANCE_N + FORCE_ROUNDING * largest_N:
        yield f"tip and shaft do not sum up to force_y_N (by up to {gap_N:.3g} N)"
    contacts = resistance["contacts"]
    if (contacts < 0).any() or (contacts != np.rint(contacts)).any():
        yield "contacts is not a count"
    if (resistance["kinetic_energy_J"] < 0).any():
        yield "a kinetic energy is negative"
    for what, where in lost_particles(case, motion).items():
        if where.any():
            lost = np.flatnonzero(where.any(axis=0))
            first_s = motion.time_s[np.flatnonzero(where.any(axis=1))[0]]
            first_ids = ", ".join(map(str, lost[:5]))
            yield f"lost {len(lost)} particles, found {what} from {first_s:.6g} s on (first ids {first_ids})"


def lost_particles(case: dict, motion: Motion) -> dict[str, np.ndarray]:
    """(F, N) which particles are where they must not be, by where that is.

    One with its centre beyond a face of wall or bar has gone through: no contact brings it back.
    """
    x_m, y_m = motion.position_m[..., 0], motion.position_m[..., 1]
    outside = (x_m < 0) | (x_m > case["container"]["width_m"]) | (y_m < 0)
    found = {"outside the container": outside}
    if "bar" in case:
        bar, tip_m = case["bar"], motion.bar_tip_m[:, np.newaxis]
        found["inside the bar"] = (
            (np.abs(x_m - bar["centre_x_m"]) < bar["width_m"] / 2)
            & (y_m > tip_m)
            & (y_m < tip_m + bar["length_m"])
        )
    return found
