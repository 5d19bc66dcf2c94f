"""`crossdem export`: the motion of a run for other programs: PVD and VTP for ParaView, H5MD in three dimensions.

VTP: https://docs.vtk.org/en/latest/vtk_file_formats/vtkxml_file_format.html, XML with appended raw data.
"""

from __future__ import annotations

from pathlib import Path
from xml.sax.saxutils import quoteattr

import h5py
import numpy as np

from crossdem.adapters.dataset import Dataset
from crossdem.adapters.files import write_whole
from crossdem.adapters.motion_file import write_header

from . import motion

VTK_TYPES = {"f": "Float64", "i": "Int64"}  # by the kind of NumPy's types


def write_vtk(dataset: Dataset, folder: Path) -> Path:
    """motion.pvd in `folder`, which time-stamps a particles-NNNN.vtp and, where there is a bar, a bar-NNNN.vtp per frame.

    Particles are points with id, radius_m, layer, velocity_m_s, angular_velocity_rad_s, displacement_m and, where the engine
    keeps it, angle_rad: in ParaView a Glyph (2D: circle, 3D: sphere) scaled by radius_m. Returns the path of motion.pvd, which
    is written last.
    """
    folder.mkdir(parents=True, exist_ok=True)
    entries = []
    for frame, time_s in enumerate(dataset.motion.time_s):
        parts = [("particles", _particles(dataset, frame))]
        if dataset.motion.bar_tip_m is not None:
            parts.append(("bar", _bar(dataset, frame)))
        for part, (name, content) in enumerate(parts):
            file_name = f"{name}-{frame:04d}.vtp"
            write_whole(folder / file_name, content)
            entries.append(
                f'<DataSet timestep="{float(time_s)!r}" part="{part}" name="{name}" file="{file_name}"/>'
            )
    lines = "\n".join(entries)
    text = f'<?xml version="1.0"?>\n<VTKFile type="Collection" version="1.0">\n<Collection>\n{lines}\n</Collection>\n</VTKFile>\n'
    write_whole(folder / "motion.pvd", text.encode())
    return folder / "motion.pvd"


def write_h5md(dataset: Dataset, path: Path) -> Path:
    """The motion as H5MD 1.1 in three dimensions, z = 0, as readers expect it, in SI; its units are not named, as MDAnalysis
    refuses those that no molecule is measured in.

    A run's own motion.h5 is H5MD, too, in the two dimensions of the case and with units.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    partial = path.with_name(f".{path.name}.partial")
    case, run = dataset.case, dataset.motion
    with h5py.File(partial, "w") as file:
        write_header(file, dataset.engine, dataset.manifest["engine_version"])
        soil = file.create_group("particles/soil")
        box = soil.create_group("box")
        box.attrs["dimension"] = 3
        box.attrs["boundary"] = ["none"] * 3
        container = case["container"]
        edges_m = [container["width_m"], container["height_m"], container["thickness_m"]]
        every_frame = np.tile(np.diag(edges_m), (len(run.time_s), 1, 1))
        soil["radius"] = dataset.radius_m
        soil["id"] = np.arange(len(dataset.radius_m))
        step = np.rint(run.time_s / dataset.manifest["time_step_s"]).astype(np.int64)
        for parent, name, values in (
            (box, "edges", every_frame),
            (soil, "position", _spatial(run.position_m)),
            (soil, "velocity", _spatial(run.velocity_m_s)),
        ):
            element = parent.create_group(name)
            element["value"] = values
            element["step"] = step
            element["time"] = run.time_s
    partial.replace(path)
    return path


def _particles(dataset: Dataset, frame: int) -> bytes:
    run, count = dataset.motion, len(dataset.radius_m)
    data = {
        "id": np.arange(count),
        "radius_m": dataset.radius_m,
        "layer": motion.layers(dataset),
        "velocity_m_s": _spatial(run.velocity_m_s[frame]),
        "angular_velocity_rad_s": run.angular_velocity_rad_s[frame],
        "displacement_m": _spatial(motion.displacement_m(dataset, frame)),
    }
    if run.angle_rad is not None:
        data["angle_rad"] = run.angle_rad[frame]
    cells = {"connectivity": np.arange(count), "offsets": np.arange(1, count + 1)}
    return _vtp(_spatial(run.position_m[frame]), "Verts", cells, data)


def _bar(dataset: Dataset, frame: int) -> bytes:
    bar, tip_m = dataset.case["bar"], dataset.motion.bar_tip_m[frame]
    left_m, right_m = (bar["centre_x_m"] + side * bar["width_m"] / 2 for side in (-1, 1))
    top_m = tip_m + bar["length_m"]
    corners_m = np.array([[left_m, tip_m], [right_m, tip_m], [right_m, top_m], [left_m, top_m]])
    cells = {"connectivity": np.arange(4), "offsets": np.array([4])}
    return _vtp(_spatial(corners_m), "Polys", cells, {})


def _vtp(points_m: np.ndarray, kind: str, cells: dict, data: dict) -> bytes:
    """A PolyData of (N, 3) points, one kind of cells and point data, which may be vectors."""
    blocks: list[bytes] = []

    def array(name: str, values: np.ndarray) -> str:
        values = np.ascontiguousarray(values, dtype="<i8" if values.dtype.kind == "i" else "<f8")
        offset = sum(map(len, blocks))
        blocks.append(np.array(values.nbytes, dtype="<u8").tobytes() + values.tobytes())
        width = f' NumberOfComponents="{values.shape[1]}"' if values.ndim > 1 else ""
        kind = VTK_TYPES[values.dtype.kind]
        return f'<DataArray type="{kind}" Name={quoteattr(name)}{width} format="appended" offset="{offset}"/>'

    number = len(cells["offsets"])
    body = "\n".join(
        [
            "<PointData>",
            *(array(name, values) for name, values in data.items()),
            "</PointData>\n<Points>",
            array("Points", points_m),
            f"</Points>\n<{kind}>",
            *(array(name, values) for name, values in cells.items()),
            f"</{kind}>",
        ]
    )
    head = (
        '<?xml version="1.0"?>\n<VTKFile type="PolyData" version="1.0" byte_order="LittleEndian" header_type="UInt64">\n'
        f'<PolyData>\n<Piece NumberOfPoints="{len(points_m)}" NumberOf{kind}="{number}">\n{body}\n</Piece>\n</PolyData>\n'
        '<AppendedData encoding="raw">\n_'
    )
    return head.encode() + b"".join(blocks) + b"\n</AppendedData>\n</VTKFile>\n"


def _spatial(values: np.ndarray) -> np.ndarray:
    """(..., 2) as (..., 3), z = 0."""
    return np.concatenate([values, np.zeros((*values.shape[:-1], 1))], axis=-1)
