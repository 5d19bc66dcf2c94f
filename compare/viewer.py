"""The frames of a run of each engine, packed for the viewer in the report (assets/viewer.js)."""

from __future__ import annotations

import base64
import gzip

import numpy as np

from crossdem.adapters.dataset import Dataset

from . import motion
from .colours import LAYERS, engine_styles

LARGEST = np.iinfo(np.int16).max
# Of all runs together: a value takes 1.3 to 2 bytes of the page, so that the frames take 5 MB of it at most.
MOST_VALUES = 2_600_000
CHANNELS = 5  # at most, of a particle in a frame


def viewer_data(runs: dict[str, Dataset]) -> dict | None:
    """What viewer.js draws of these `runs`, by engine: lengths in m, times in s, speeds in m/s, angles in rad.

    Of long runs of large beds every second, third... frame is left out, and the last one kept. None: nothing to move,
    as there are no runs, or even two frames are too much for a page.
    """
    sizes = [CHANNELS * len(run.radius_m) for run in runs.values()]  # values of a frame
    if not runs or 2 * sum(sizes) > MOST_VALUES:
        return None
    styles = engine_styles(list(runs))
    most_frames = MOST_VALUES // sum(sizes)
    case = next(iter(runs.values())).case
    return {
        "width_m": case["container"]["width_m"],
        "height_m": case["container"]["height_m"],
        "bar": {key: case["bar"][key] for key in ("centre_x_m", "width_m", "length_m")},
        "normal_stiffness_N_m": case["contact"]["particle_particle"]["normal_stiffness_N_m"],
        "layer_colours": LAYERS,
        "runs": [
            {"engine": engine, "colour": styles[engine].colour} | _packed_run(run, most_frames)
            for engine, run in runs.items()
        ],
    }


def pack(values: np.ndarray) -> dict:
    """`values` (F, N) as whole steps, in 16 bits: each is off by half a `step` at most, a 65534th of the largest one.

    For the bed of the reference case that is 2.3 micrometres. Each frame but the first holds the differences to the one
    before, modulo 2^16; little endian, gzip, base64.
    """
    step = float(np.abs(values).max()) / LARGEST or 1.0
    steps = np.rint(values / step).astype("<i2")
    with np.errstate(over="ignore"):  # the sums that undo it run over, too
        differences = np.diff(steps, axis=0, prepend=np.zeros_like(steps[:1]))
    squeezed = gzip.compress(differences.astype("<i2").tobytes(), mtime=0)
    return {"step": step, "gzip": base64.b64encode(squeezed).decode()}


def shown_frames(frames: int, most: int) -> list[int]:
    """At most `most` (2 or more) of the frames, evenly spaced, with the first and the last one."""
    return np.unique(np.linspace(0, frames - 1, min(frames, most)).round().astype(int)).tolist()


def _packed_run(run: Dataset, most_frames: int) -> dict:
    frames = shown_frames(len(run.motion.time_s), most_frames)
    return {
        "seed": run.seed,
        "packing": run.manifest["packing_hash"],
        "time_s": run.motion.time_s[frames].tolist(),
        "bar_tip_m": run.motion.bar_tip_m[frames].tolist(),
        "radius_m": run.radius_m.tolist(),
        "layer": (motion.layers(run) % len(LAYERS)).tolist(),
        "channels": {name: pack(values) for name, values in _channels(run, frames).items()},
    }


def _channels(run: Dataset, frames: list[int]) -> dict[str, np.ndarray]:
    """What is packed of these frames, (F, N) each; an engine that keeps no angle has none."""
    moved = run.motion
    channels = {
        "x": moved.position_m[frames, :, 0],
        "y": moved.position_m[frames, :, 1],
        "speed": np.linalg.norm(moved.velocity_m_s[frames], axis=-1),
        "spin": moved.angular_velocity_rad_s[frames],
    }
    return channels | ({} if moved.angle_rad is None else {"angle": moved.angle_rad[frames]})
