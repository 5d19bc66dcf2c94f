"""Damaged or hostile files in place of a run, of a user's engine's output and of its description: refused in words, in little
time and memory. The damage is always the same; `tests/nightly` has more of it.
"""

import hashlib
import json
import os
import shutil

import h5py
import hypothesis.strategies as some
import numpy as np
import pytest
from damage import damaged_bytes, damaged_json, damaged_table, dumped, survives
from hypothesis import given
from test_own_engine import DESCRIPTION

from crossdem.adapters.contract import Columns, read_contract
from crossdem.adapters.dataset import Dataset, DatasetError
from crossdem.adapters.engine import EngineFailure
from crossdem.adapters.engine_file import EngineFileError, read_engine
from crossdem.adapters.packing import Packing, PackingError
from crossdem.adapters.run import RunRequest, run_all

FILES = ("manifest.json", "motion.h5", "resistance.csv", "inputs/case.json", "inputs/packing.csv")
NUMBERS = ("particles/soil/id", "particles/soil/position/value", "particles/soil/radius")
HASHES = {"inputs/case.json": "case_hash", "inputs/packing.csv": "packing_hash"}


@pytest.fixture(scope="module")
def run(case, packing, tmp_path_factory):
    """The folder of a real run."""
    [result] = run_all([RunRequest(case, packing, "native")], tmp_path_factory.mktemp("real"), 1)
    return result.dataset_folder


@pytest.fixture(scope="module")
def folder(run, tmp_path_factory):
    """A copy of it, to be damaged and restored."""
    return shutil.copytree(run, tmp_path_factory.mktemp("damaged") / "run")


def read_damaged(run, folder, name, content):
    """Reads `folder` with `content` in place of the file `name`, which its manifest names by the right hash."""
    (folder / name).write_bytes(content)
    if name in HASHES:
        manifest = json.loads((run / "manifest.json").read_bytes())
        manifest[HASHES[name]] = hashlib.sha256(content).hexdigest()
        (folder / "manifest.json").write_bytes(dumped(manifest))
    try:
        survives(lambda: Dataset.read(folder), DatasetError)
    finally:
        for changed in {name, "manifest.json"}:
            shutil.copyfile(run / changed, folder / changed)


def test_the_real_run_is_read(folder):
    survives(lambda: Dataset.read(folder))


@given(data=some.data())
@pytest.mark.parametrize("name", FILES)
def test_a_file_of_a_run_with_other_bytes(name, run, folder, data):
    read_damaged(run, folder, name, data.draw(damaged_bytes((run / name).read_bytes())))


@given(data=some.data())
@pytest.mark.parametrize("name", ["manifest.json", "inputs/case.json"])
def test_an_object_of_a_run_with_other_values(name, run, folder, data):
    values = json.loads((run / name).read_bytes())
    read_damaged(run, folder, name, dumped(data.draw(damaged_json(values))))


@given(data=some.data())
def test_a_table_of_a_run_with_other_fields(run, folder, data):
    text = (run / "resistance.csv").read_text()
    read_damaged(run, folder, "resistance.csv", data.draw(damaged_table(text)).encode())


@pytest.mark.parametrize("name", NUMBERS)
@pytest.mark.parametrize("kind", ["chunked", "compressed", "text", "group", "links to itself"])
def test_a_motion_file_that_claims_what_it_has_not(name, kind, run, folder):
    """Of which nothing but the claim is in the file."""
    place = folder / "motion.h5"
    with h5py.File(place, "r+") as file:
        shape = tuple(10**6 * size for size in file[name].shape)
        del file[name]
        if kind == "text":
            file.create_dataset(name, (4,), dtype=h5py.string_dtype())
        elif kind == "group":
            file.create_group(name)
        elif kind == "links to itself":
            file[name] = h5py.SoftLink(f"/{name}")
        else:
            packed = {"compression": "gzip"} if kind == "compressed" else {}
            file.create_dataset(name, shape, dtype=np.float64, chunks=(100,) * len(shape), **packed)
    with pytest.raises(DatasetError):
        Dataset.read(folder)
    read_damaged(run, folder, "motion.h5", place.read_bytes())


@pytest.mark.parametrize("name", NUMBERS)
@pytest.mark.parametrize("kind", ["soft link", "external link", "external numbers", "virtual"])
def test_a_motion_file_whose_numbers_are_those_of_another_place(name, kind, run, folder, tmp_path):
    shutil.copyfile(run / "motion.h5", tmp_path / "other.h5")
    place = folder / "motion.h5"
    with h5py.File(place, "r+") as file:
        numbers = file[name][()]
        del file[name]
        if kind == "soft link":
            file["elsewhere"] = numbers
            file[name] = h5py.SoftLink("/elsewhere")
        elif kind == "external link":
            file[name] = h5py.ExternalLink(str(tmp_path / "other.h5"), name)
        elif kind == "external numbers":
            (tmp_path / "numbers").write_bytes(numbers.tobytes())
            stored = [(str(tmp_path / "numbers"), 0, numbers.nbytes)]
            file.create_dataset(name, numbers.shape, numbers.dtype, external=stored)
        else:
            layout = h5py.VirtualLayout(numbers.shape, numbers.dtype)
            layout[...] = h5py.VirtualSource(tmp_path / "other.h5", name, numbers.shape)
            file.create_virtual_dataset(name, layout)
        np.testing.assert_array_equal(file[name][()], numbers)  # as the library reads it
    try:
        with pytest.raises(DatasetError, match="of its own|of another file"):
            Dataset.read(folder)
    finally:
        shutil.copyfile(run / "motion.h5", place)


@pytest.mark.parametrize("name", [*FILES, "inputs/packing.json"])
def test_a_pipe_in_the_place_of_a_file_is_not_waited_for(name, run, folder):
    (folder / name).unlink()
    os.mkfifo(folder / name)
    try:
        survives(lambda: Dataset.read(folder), DatasetError)
        survives(lambda: Packing.read(folder / "inputs"), PackingError)
    finally:
        (folder / name).unlink()
        shutil.copyfile(run / name, folder / name)


@pytest.fixture(scope="module")
def output(run, tmp_path_factory):
    """The files of the contract, of the same run."""
    whole = Dataset.read(run)
    folder = tmp_path_factory.mktemp("contract")
    whole.resistance.to_csv(folder / "resistance.csv", index=False)
    motion, particles = whole.motion, len(whole.radius_m)
    title = "time_s,id,x_m,y_m,velocity_x_m_s,velocity_y_m_s,angular_velocity_rad_s"
    table = np.column_stack(
        [
            np.repeat(motion.time_s, particles),
            np.tile(np.arange(particles), len(motion.time_s)),
            motion.position_m.reshape(-1, 2),
            motion.velocity_m_s.reshape(-1, 2),
            motion.angular_velocity_rad_s.reshape(-1),
        ]
    )
    np.savetxt(folder / "motion.csv", table, "%.17g", ",", header=title, comments="")
    said = {key: whole.manifest[key] for key in ("frames", "particles", "engine")}
    said |= {"completed": True, "version": whole.manifest["engine_version"]}
    (folder / "run.json").write_bytes(dumped(said))
    return folder


def read_output(case, packing, run, output):
    manifest = json.loads((run / "manifest.json").read_bytes())
    return read_contract("door", {"motion": Columns()}, case, packing, output, manifest)


def test_the_output_of_a_users_engine_is_read(case, packing, run, output):
    survives(lambda: read_output(case, packing, run, output))


@given(data=some.data())
@pytest.mark.parametrize("name", ["run.json", "motion.csv", "resistance.csv"])
def test_damaged_output_of_a_users_engine(name, case, packing, run, output, data):
    whole = (output / name).read_bytes()
    if name.endswith(".csv"):
        spoilt = damaged_bytes(whole) | damaged_table(whole.decode()).map(str.encode)
    else:
        spoilt = damaged_bytes(whole) | damaged_json(json.loads(whole)).map(dumped)
    try:
        (output / name).write_bytes(data.draw(spoilt))
        survives(lambda: read_output(case, packing, run, output), EngineFailure, DatasetError)
    finally:
        (output / name).write_bytes(whole)


def as_toml(value) -> str:
    """`value` inline; of what TOML lacks, a text."""
    if isinstance(value, bool) or value is None:
        return str(bool(value)).lower()
    if isinstance(value, dict):
        return "{" + ", ".join(f"{json.dumps(k)} = {as_toml(v)}" for k, v in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(as_toml, value)) + "]"
    return json.dumps(value) if isinstance(value, str) else repr(value)


WHOLE = {
    "name": "door",
    "version": ["door", "--version"],
    "run": ["./door", "{case}", "{packing}", "{out}"],
    "files": ["door"],
    "substeps": 2,
    "progress": "resistance.csv",
    "cost_s": 1e-6,
    "scheme": {"slip_cap": "total"},
    "twin_limit_m": 1e-6,
    "difference": [
        {
            "case": "pinch",
            "quantity": "bar_side_force_N",
            "reason": "c",
            "value": 1.0,
            "tolerance": 0.1,
        }
    ],
    "motion": {
        "files": "f*.csv",
        "separator": " ",
        "columns": {"x_m": {"column": "x", "unit": "mm"}},
    },
    "resistance": {"columns": {"force_y_N": "fy"}},
}


def write_description(path, values):
    (path.parent / "door").touch()
    path.write_text(
        "".join(f"{json.dumps(key)} = {as_toml(value)}\n" for key, value in values.items()),
        encoding="utf-8",
        errors="replace",
    )


def test_the_whole_description_is_read(tmp_path):
    write_description(tmp_path / "door.toml", WHOLE)
    survives(lambda: read_engine(tmp_path / "door.toml"))


@given(data=some.data())
def test_a_description_of_an_engine_with_other_values(data, case, tmp_path_factory):
    path = tmp_path_factory.getbasetemp() / "door.toml"
    values = data.draw(damaged_json(WHOLE).filter(lambda value: isinstance(value, dict)))
    write_description(path, values)

    def read_and_use():
        engine = read_engine(path)
        assert all("\0" not in word for word in engine.command(case, path.parent))
        engine.expected_s(case)

    survives(read_and_use, EngineFileError)


@given(data=some.data())
def test_a_description_of_an_engine_with_other_bytes(data, tmp_path_factory):
    path = tmp_path_factory.getbasetemp() / "door.toml"
    path.write_bytes(data.draw(damaged_bytes(DESCRIPTION.encode())))
    survives(lambda: read_engine(path), EngineFileError)
