"""How the particles moved, and its file: H5MD 1.1 (https://nongnu.org/h5md), which readers of the field know."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from secrets import token_hex

import h5py
import numpy as np


# Each dataset of a motion file with its definition; its unit is the attribute `unit`. F frames, N particles.
DATASETS = {
    "particles/soil/box/edges": "(2,) inner width and height of the container",
    "particles/soil/radius": "(N,) radii of the discs",
    "particles/soil/id": "(N,) numbers of the particles, as in packing.csv",
    "particles/soil/position/value": "(F, N, 2) centres: x from the left wall, y upwards from the floor",
    "particles/soil/position/step": "(F,) number of the time step, 0 when the bar starts; every other step is this dataset",
    "particles/soil/position/time": "(F,) time, 0 when the bar starts; every other time is this dataset",
    "particles/soil/velocity/value": "(F, N, 2) velocities: x > 0 to the right, y > 0 upwards",
    "particles/soil/angular_velocity/value": "(F, N) angular velocities, counter-clockwise > 0",
    "particles/soil/angle/value": "(F, N) angles, counter-clockwise > 0, 0 at the packing; absent where an engine keeps none",
    "observables/bar/tip/value": "(F,) height of the bar's bottom face above the floor",
}


class MotionFileError(Exception):
    """A motion file that cannot be read, or that is not in the layout written here."""


@dataclass(frozen=True)
class Motion:
    """F frames of N particles, in the order of their ids; t = 0 is the end of the rest, when the bar starts."""

    time_s: np.ndarray  # (F,)
    position_m: np.ndarray  # (F, N, 2) centres
    velocity_m_s: np.ndarray  # (F, N, 2)
    angular_velocity_rad_s: np.ndarray  # (F, N), counter-clockwise > 0
    angle_rad: np.ndarray | None  # (F, N), counter-clockwise > 0, 0 at the packing; None: the engine keeps no angle
    bar_tip_m: np.ndarray | None  # (F,) height of the bar's bottom face; None: there is no bar


def write_motion(
    path: Path,
    motion: Motion,
    radius_m: np.ndarray,
    engine: str,
    version: str,
    *,
    box_m: tuple[float, float],
    time_step_s: float,
) -> None:
    """Write `motion` of particles with radii (N,) in a container of `box_m` (width, height); doubles, uncompressed.

    Raises OSError. It is made in memory, where it takes twice its size: on a full disk the library would have more to
    say than that.
    """
    unused = (
        f"{path.name}-{token_hex(8)}"  # a file of this name in the current folder would be read
    )
    with h5py.File(unused, "w", driver="core", backing_store=False) as file:
        write_header(file, engine, version)
        soil = file.create_group("particles/soil")
        box = soil.create_group("box")
        box.attrs["dimension"] = 2
        box.attrs["boundary"] = ["none", "none"]
        _write(box, "edges", np.asarray(box_m, dtype=float), "m")
        _write(soil, "radius", np.asarray(radius_m, dtype=float), "m")
        soil["id"] = np.arange(len(radius_m))

        position = soil.create_group("position")
        _write(position, "value", motion.position_m, "m")
        position["step"] = np.rint(motion.time_s / time_step_s).astype(np.int64)
        _write(position, "time", motion.time_s, "s")
        _write_element(soil, "velocity", motion.velocity_m_s, "m s-1", position)
        _write_element(soil, "angular_velocity", motion.angular_velocity_rad_s, "rad s-1", position)
        if motion.angle_rad is not None:
            _write_element(soil, "angle", motion.angle_rad, "rad", position)
        if motion.bar_tip_m is not None:
            bar = file.create_group("observables/bar")
            _write_element(bar, "tip", motion.bar_tip_m, "m", position)
        file.flush()
        path.write_bytes(file.id.get_file_image())


def write_header(file: h5py.File, engine: str, version: str) -> None:
    """Who made an H5MD file, and of which version of the format it is."""
    header = file.create_group("h5md")
    header.attrs["version"] = np.array([1, 1])
    header.create_group("author").attrs["name"] = "crossdem"
    creator = header.create_group("creator")
    creator.attrs["name"] = engine
    creator.attrs["version"] = version


def read_motion(path: Path) -> tuple[Motion, np.ndarray]:
    """The motion in `path` and the radii (N,) of its particles. Raises MotionFileError."""
    try:
        most_bytes = path.stat().st_size
        with h5py.File(path, "r") as file:

            def values(group: h5py.Group, name: str) -> np.ndarray:
                return _read(_own(group, name), most_bytes)

            soil = file["particles/soil"]
            ids = values(soil, "id")
            if not np.array_equal(ids, np.arange(len(ids))):
                raise MotionFileError(f"{path}: the particles are not in the order of their ids")
            motion = Motion(
                time_s=values(soil, "position/time"),
                position_m=values(soil, "position/value"),
                velocity_m_s=values(soil, "velocity/value"),
                angular_velocity_rad_s=values(soil, "angular_velocity/value"),
                angle_rad=values(soil, "angle/value") if "angle" in soil else None,
                bar_tip_m=values(file, "observables/bar/tip/value")
                if "observables/bar" in file
                else None,
            )
            return motion, values(soil, "radius")
    except (OSError, AttributeError, KeyError, TypeError, ValueError, RuntimeError) as error:
        raise MotionFileError(f"{path}: not a motion file of crossdem ({error})") from error


def _own(group: h5py.Group, path: str) -> h5py.Dataset:
    """What lies at `path` below `group` in the file itself: a link may lead into any other file of the machine."""
    for name in path.split("/"):
        if not isinstance(group.get(name, getlink=True), h5py.HardLink):
            raise ValueError(f"{group.name} holds no {name} of its own")
        group = group[name]
    return group


def _read(dataset: h5py.Dataset, most_bytes: int) -> np.ndarray:
    """All numbers of `dataset`. They lie in the file as they are: what claims more bytes than it has, claims too much."""
    if dataset.dtype.kind not in "iuf":
        raise TypeError(f"{dataset.name} does not hold numbers")
    if dataset.external or dataset.is_virtual:
        raise ValueError(f"the numbers of {dataset.name} are those of another file")
    if dataset.nbytes > most_bytes:
        raise ValueError(f"{dataset.name} is larger than its file")
    return dataset[()]


def _write(group: h5py.Group, name: str, values: np.ndarray, unit: str) -> None:
    group[name] = np.asarray(values, dtype=float)
    group[name].attrs["unit"] = unit


def _write_element(
    parent: h5py.Group, name: str, values: np.ndarray, unit: str, clock: h5py.Group
) -> None:
    """An H5MD element that shares (hard link) the step and time of `clock`."""
    element = parent.create_group(name)
    _write(element, "value", values, unit)
    element["step"] = clock["step"]
    element["time"] = clock["time"]
