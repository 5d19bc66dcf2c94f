"""What a dataset refuses, and how it is written: whole or not at all."""

import json
import os
from dataclasses import replace

import numpy as np
import pytest
import synthetic

from crossdem.adapters import dataset as dataset_module
from crossdem.adapters.dataset import Dataset, DatasetError, read_motion, write_motion


@pytest.fixture(scope="module")
def whole():
    return synthetic.dataset(synthetic.case())


def spoil(run, **parts):
    return Dataset(**(vars(run) | parts))


def with_cell(table, column, value):
    table = table.copy()
    table.loc[5, column] = value
    return table


def test_a_whole_run_is_accepted(whole):
    assert (whole.engine, whole.seed) == ("native", 1)


@pytest.mark.parametrize(
    "spoilt, message",
    [
        (lambda table: table.drop(columns="contacts"), "columns"),
        (lambda table: table[table.columns[::-1]], "columns"),
        (lambda table: table.assign(more=1.0), "columns"),
        (lambda table: table.astype({"force_y_N": str}), "not numbers: force_y_N"),
        (lambda table: table.iloc[:-1], "900 of 901 samples"),
        (lambda table: with_cell(table, "force_x_N", np.nan), "force_x_N is not finite"),
        (
            lambda table: with_cell(table, "kinetic_energy_J", np.inf),
            "kinetic_energy_J is not finite",
        ),
        (lambda table: with_cell(table, "kinetic_energy_J", -1e-9), "kinetic energy is negative"),
        (lambda table: with_cell(table, "time_s", 0.0501), "samples are not at the times"),
        (lambda table: with_cell(table, "depth_m", 0.01), "depth_m"),
        (lambda table: with_cell(table, "tip_force_y_N", 9.0), "tip and shaft do not sum up"),
        (lambda table: with_cell(table, "contacts", 1.5), "contacts is not a count"),
    ],
)
def test_a_faulty_resistance_is_refused(whole, spoilt, message):
    with pytest.raises(DatasetError, match=message):
        spoil(whole, resistance=spoilt(whole.resistance))


def moved(motion, name, index, value):
    values = getattr(motion, name).copy()
    values[index] = value
    return replace(motion, **{name: values})


@pytest.mark.parametrize(
    "spoilt, message",
    [
        (lambda m: replace(m, time_s=m.time_s[:-1]), "90 of 91 frames"),
        (lambda m: replace(m, velocity_m_s=m.velocity_m_s[:-1]), "velocity_m_s has the shape"),
        (lambda m: replace(m, angle_rad=np.zeros(3)), "angle_rad has the shape"),
        (lambda m: moved(m, "time_s", 4, 0.41), "frames are not at the times"),
        (lambda m: moved(m, "position_m", (3, 7, 1), np.nan), "position_m is not finite"),
        (
            lambda m: moved(m, "angular_velocity_rad_s", (3, 7), np.inf),
            "angular_velocity_rad_s is not",
        ),
        (lambda m: moved(m, "bar_tip_m", 9, 0.2), "bar_tip_m does not move"),
        (lambda m: moved(m, "position_m", (50, 7, 0), -1e-4), "lost 1 particles, found outside"),
        (lambda m: moved(m, "position_m", (50, 7, 0), 0.1501), "from 5 s on .*first ids 7"),
        (lambda m: moved(m, "position_m", (50, 7, 1), -1e-4), "outside the container"),
        (lambda m: moved(m, "position_m", (90, 7), (0.075, 0.1)), "inside the bar"),
    ],
)
def test_a_faulty_motion_is_refused(whole, spoilt, message):
    with pytest.raises(DatasetError, match=message):
        spoil(whole, motion=spoilt(whole.motion))


def test_a_particle_above_the_container_is_not_lost(whole):
    spoil(whole, motion=moved(whole.motion, "position_m", (50, 7), (0.01, 0.2)))


def test_radii_of_too_few_particles_or_none_are_refused(whole):
    with pytest.raises(DatasetError, match="943 of 944 particles"):
        spoil(whole, radius_m=whole.radius_m[:-1])
    with pytest.raises(DatasetError, match="radius"):
        spoil(whole, radius_m=0 * whole.radius_m)


@pytest.fixture
def without_bar(whole):
    """Parts of the same run, had there been no bar."""
    case = {key: value for key, value in whole.case.items() if key != "bar"}
    none = ("depth_m", "force_x_N", "force_y_N", "tip_force_y_N", "shaft_force_y_N")
    table = whole.resistance.assign(**dict.fromkeys(none, 0.0))
    return {"case": case, "resistance": table, "motion": replace(whole.motion, bar_tip_m=None)}


def test_a_run_without_a_bar_is_accepted_and_reads_back(whole, without_bar, tmp_path):
    run = spoil(whole, **without_bar)
    write_motion(
        tmp_path / "motion.h5",
        run.motion,
        run.radius_m,
        "native",
        "1",
        box_m=(1, 1),
        time_step_s=1e-4,
    )
    motion, _ = read_motion(tmp_path / "motion.h5")
    assert motion.bar_tip_m is None
    assert np.array_equal(motion.position_m, run.motion.position_m)


def test_a_bar_must_be_in_the_case_and_in_the_motion_or_in_neither(whole, without_bar):
    with pytest.raises(DatasetError, match="the case has a bar, the motion none"):
        spoil(whole, motion=without_bar["motion"])
    with pytest.raises(DatasetError, match="the motion has a bar, the case none"):
        spoil(whole, **(without_bar | {"motion": whole.motion}))


def test_without_a_bar_nothing_goes_down_and_no_particle_is_in_it(whole, without_bar):
    with pytest.raises(DatasetError, match="depth_m"):
        spoil(whole, **(without_bar | {"resistance": whole.resistance}))
    spoil(
        whole,
        **(
            without_bar
            | {"motion": moved(without_bar["motion"], "position_m", (90, 7), (0.075, 0.1))}
        ),
    )


@pytest.mark.parametrize("key", ["run_key", "gates", "engine_version", "limitations"])
def test_a_manifest_without_a_key_is_refused(whole, key):
    manifest = {name: value for name, value in whole.manifest.items() if name != key}
    with pytest.raises(DatasetError, match=f"the manifest lacks {key}"):
        spoil(whole, manifest=manifest)


def test_a_manifest_of_another_schema_or_another_count_is_refused(whole):
    with pytest.raises(DatasetError, match="schema version 2"):
        spoil(whole, manifest=whole.manifest | {"schema_version": 2})
    with pytest.raises(DatasetError, match="says 90 frames; the case 91"):
        spoil(whole, manifest=whole.manifest | {"frames": 90})


@pytest.mark.parametrize("gates", [{}, ["passed"], [{"name": "contacts_share", "passed": True}]])
def test_a_manifest_whose_gates_are_no_gates_is_refused(whole, gates):
    with pytest.raises(DatasetError, match="gates are not a list of objects with limit, message"):
        spoil(whole, manifest=whole.manifest | {"gates": gates})


def test_every_fault_of_a_kind_is_told_at_once(whole):
    table = with_cell(with_cell(whole.resistance, "force_x_N", np.nan), "depth_m", np.nan)
    with pytest.raises(DatasetError, match="depth_m is not finite.*; .*force_x_N is not finite"):
        spoil(whole, resistance=table)


@pytest.fixture
def stored(whole, tmp_path):
    """A dataset with the inputs that its manifest names, and their folder."""
    run_case = synthetic.case()
    work = tmp_path / "work"
    (work / "inputs").mkdir(parents=True)
    (work / "inputs" / "case.json").write_bytes(run_case.canonical)
    (work / "inputs" / "packing.csv").write_bytes(b"packing 1")
    (work / "engine.log").write_text("said little\n")
    return whole, work


def test_a_dataset_reads_back_as_it_was_written(stored, tmp_path):
    whole, work = stored
    turned = replace(whole.motion, angle_rad=np.linspace(0, 1, 91 * 944).reshape(91, 944))
    whole = spoil(whole, motion=turned)
    whole.write(tmp_path / "run", extra_files_from=work)
    again = Dataset.read(tmp_path / "run")
    assert again.manifest == whole.manifest
    assert again.case == whole.case
    assert again.resistance.equals(whole.resistance)
    for name, values in vars(whole.motion).items():
        assert np.array_equal(getattr(again.motion, name), values)
    assert (tmp_path / "run" / "engine.log").read_text() == "said little\n"


def test_angles_may_be_absent(stored, tmp_path):
    whole, work = stored
    whole.write(tmp_path / "run", extra_files_from=work)
    assert Dataset.read(tmp_path / "run").motion.angle_rad is None


@pytest.mark.parametrize(
    "name",
    ["manifest.json", "motion.h5", "resistance.csv", "inputs/case.json", "inputs/packing.csv"],
)
def test_a_folder_with_a_file_missing_or_torn_is_refused(stored, tmp_path, name):
    whole, work = stored
    whole.write(tmp_path / "run", extra_files_from=work)
    path = tmp_path / "run" / name
    content = path.read_bytes()
    path.write_bytes(content[: len(content) // 2])
    with pytest.raises(DatasetError, match="run"):
        Dataset.read(tmp_path / "run")
    path.unlink()
    with pytest.raises(DatasetError, match="run"):
        Dataset.read(tmp_path / "run")


def test_a_changed_input_is_noticed(stored, tmp_path):
    whole, work = stored
    whole.write(tmp_path / "run", extra_files_from=work)
    path = tmp_path / "run" / "inputs" / "case.json"
    changed = json.loads(path.read_bytes()) | {"title": "another"}
    path.write_text(json.dumps(changed))
    with pytest.raises(DatasetError, match="inputs/case.json is not what"):
        Dataset.read(tmp_path / "run")


def test_a_kill_while_writing_leaves_nothing_that_looks_complete(stored, tmp_path, monkeypatch):
    whole, work = stored
    folder = tmp_path / "runs" / "run"
    for survived in range(9):
        child = os.fork()
        if child == 0:
            die_in_sync(monkeypatch, survived)
            whole.write(folder, extra_files_from=work)
            os._exit(0)
        _, status = os.waitpid(child, 0)
        if os.waitstatus_to_exitcode(status) == 0 or folder.exists():
            break
        assert [path.name for path in folder.parent.iterdir()] == [".run.partial"]
    assert survived >= 6  # every file and the folder were synced before the rename
    whole.write(tmp_path / "runs" / "other", extra_files_from=work)
    assert Dataset.read(folder).manifest == whole.manifest


def die_in_sync(monkeypatch, survived):
    """End this process without any clean-up at the call of fsync that follows so many others."""
    real, calls = os.fsync, []

    def sync(descriptor):
        if len(calls) == survived:
            os._exit(9)
        calls.append(descriptor)
        real(descriptor)

    monkeypatch.setattr(dataset_module.os, "fsync", sync)


def test_an_existing_run_is_not_overwritten(stored, tmp_path):
    whole, work = stored
    whole.write(tmp_path / "run", extra_files_from=work)
    with pytest.raises(OSError):
        whole.write(tmp_path / "run", extra_files_from=work)
    assert Dataset.read(tmp_path / "run").manifest == whole.manifest
