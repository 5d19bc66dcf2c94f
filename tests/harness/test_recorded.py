"""The recorded ensemble: it gives back what was put in, and says what was changed since."""

import os
import shutil
import signal
import subprocess
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from recorded_runs import packing_hash, packing_text, record, recorded_datasets
from synthetic import case, dataset

from crossdem.adapters.packing import make_twin
from crossdem.adapters.workspace import WorkspaceError
from crossdem.compare.fingerprint import content_sha256
from crossdem.compare.record_command import plans_of
from crossdem.compare.recorded import Record, RecordError, find_record
from crossdem.compare.reproduced import difference, same_program, strangeness

FILES = (
    *("SHA256SUMS", "case.json", "endpoints.csv", "fields.csv.gz", "manifest.json"),
    *("packings.csv.gz", "packings.json", "profiles.csv.gz", "runs.json"),
)


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """A record, and the folder of records it was written into."""
    folder = tmp_path_factory.mktemp("records")
    found = record()
    found.write(home(folder))
    return found, folder


@pytest.fixture
def written(made, tmp_path):
    """The same, in a folder of the test's own."""
    shutil.copytree(made[1], tmp_path, dirs_exist_ok=True)
    return made[0], tmp_path


def home(folder):
    return folder / "bar_penetration" / "default"


def test_endpoints_and_curves_come_back_to_the_last_digit_and_fields_as_rounded(written):
    made, folder = written
    read = Record.read(home(folder)).ensemble
    pd.testing.assert_frame_equal(read.endpoints, made.ensemble.endpoints, check_exact=True)
    pd.testing.assert_frame_equal(read.profiles, made.ensemble.profiles, check_exact=True)
    pd.testing.assert_frame_equal(read.fields, made.ensemble.fields, rtol=0, atol=0.51e-8)
    assert read.manifests.keys() == made.ensemble.manifests.keys()


def test_writing_what_was_read_gives_the_same_bytes(written, tmp_path):
    _, folder = written
    Record.read(home(folder)).write(tmp_path / "again")
    assert sorted(path.name for path in (tmp_path / "again").iterdir()) == sorted(FILES)
    for name in FILES:
        assert (tmp_path / "again" / name).read_bytes() == (home(folder) / name).read_bytes(), name


def test_sha256sum_reads_the_checksums(written):
    subprocess.run(
        ["sha256sum", "--check", "--quiet", "SHA256SUMS"], cwd=home(written[1]), check=True
    )


def test_a_packing_comes_back_byte_for_byte_and_its_twins_with_it(written):
    made, folder = written
    read = Record.read(home(folder))
    packing = read.restore(2, folder / "packings" / "seed2")
    assert (packing.folder / "packing.csv").read_bytes() == packing_text(2).encode()
    assert packing.hash == packing_hash(2)
    assert packing.bar_tip_m == made.about_packings[2]["bar_tip_m"]
    assert make_twin(packing, 1, folder / "packings" / "twin").hash != packing.hash


def test_a_packing_that_is_there_is_kept_and_another_one_refused(written):
    read = Record.read(home(written[1]))
    folder = written[1] / "packings" / "seed1"
    assert read.restore(1, folder).hash == read.restore(1, folder).hash
    with pytest.raises(WorkspaceError, match="another packing"):
        read.restore(2, folder)


@pytest.mark.parametrize("name", [name for name in FILES if name != "SHA256SUMS"])
def test_one_changed_byte_of_any_file_is_told(written, name):
    path = home(written[1]) / name
    content = bytearray(path.read_bytes())
    content[len(content) // 2] ^= 1
    path.write_bytes(content)
    with pytest.raises(RecordError, match=f"{name} was changed"):
        find_record(case(), written[1])


def test_a_missing_and_an_added_file_are_told_together(written):
    (home(written[1]) / "profiles.csv.gz").unlink()
    (home(written[1]) / "notes.txt").write_text("mine")
    with pytest.raises(RecordError, match="profiles.csv.gz is missing; notes.txt was added"):
        Record.read(home(written[1]))


def test_a_case_is_found_by_what_runs_depend_on_and_not_by_its_checks(written):
    stricter = case([])
    assert stricter.hash != case().hash
    assert find_record(stricter, written[1]).seeds == (1, 2)


def test_only_the_record_of_the_case_need_be_whole(written):
    _, folder = written
    other, cut = (folder / "bar_penetration" / name for name in ("other", ".default.partial"))
    for place in (other, cut):
        shutil.copytree(home(folder), place)
        (place / "runs.json").write_text("torn")
    (other / "case.json").write_bytes(case(gravity_m_s2=1.6).canonical + b"\n")
    assert find_record(case(), folder).seeds == (1, 2)
    shutil.rmtree(home(folder))
    with pytest.raises(RecordError, match="other: not as it was recorded"):
        find_record(case(), folder)
    shutil.rmtree(other)
    with pytest.raises(RecordError, match="no record of bar_penetration"):
        find_record(case(), folder)


@pytest.mark.parametrize("spoilt", ["manifest.json", "packings.json"])
def test_a_file_that_says_something_else_is_told(written, spoilt):
    folder = home(written[1])
    (folder / spoilt).write_text("[]\n")
    sums = subprocess.run(["sha256sum", *FILES[1:]], cwd=folder, capture_output=True, check=True)
    (folder / "SHA256SUMS").write_bytes(sums.stdout)
    with pytest.raises(RecordError, match="crossdem record. makes it anew"):
        Record.read(folder)


def test_a_record_without_files_is_told(written):
    folder = home(written[1])
    for path in folder.iterdir():
        path.unlink()
    (folder / "SHA256SUMS").write_text("")
    with pytest.raises(RecordError, match="lacks 'manifest.json'"):
        Record.read(folder)
    with pytest.raises(RecordError, match="records of default"):
        find_record(case(), written[1])


def test_a_record_of_another_layout_is_told(written):
    made, folder = written
    replace(made, about=made.about | {"schema_version": 2}).write(home(folder))
    with pytest.raises(RecordError, match="its layout is 2, and this crossdem reads 1"):
        find_record(case(), folder)


def test_a_kill_while_a_record_is_replaced_loses_none(written, monkeypatch):
    made, folder = written
    monkeypatch.setattr(Path, "rename", lambda path, to: os.kill(os.getpid(), signal.SIGKILL))
    process = os.fork()
    if process == 0:
        made.write(home(folder))
    assert os.WIFSIGNALED(os.waitpid(process, 0)[1])
    assert find_record(case(), folder).seeds == (1, 2)
    monkeypatch.undo()
    made.write(home(folder))
    assert [path.name for path in home(folder).parent.iterdir()] == ["default"]


def test_a_case_without_a_record_is_told_what_there_is_and_what_to_do(written):
    with pytest.raises(RecordError, match="records of default.*crossdem record"):
        find_record(case(gravity_m_s2=1.6), written[1])
    shutil.rmtree(home(written[1]))
    with pytest.raises(RecordError, match="no record of bar_penetration"):
        find_record(case(), written[1])


@pytest.mark.parametrize("name", ["position_m", "velocity_m_s", "bar_tip_m", "time_s", "force_y_N"])
def test_the_last_bit_of_any_number_of_a_run_is_told(name):
    run, changed = dataset(case(), noise=0.1), dataset(case(), noise=0.1)
    assert content_sha256(run) == content_sha256(changed)
    values = (
        changed.resistance[name].to_numpy()
        if name == "force_y_N"
        else getattr(changed.motion, name)
    )
    values.flat[-1] = np.nextafter(values.flat[-1], 2)
    if name == "force_y_N":
        changed.resistance[name] = values
    assert content_sha256(run) != content_sha256(changed)


def test_a_native_run_must_come_out_again_to_the_last_bit(written):
    made, _ = written
    (again,) = (
        one
        for one in recorded_datasets(case())
        if (one.engine, one.seed, one.twin) == ("native", 2, 1)
    )
    assert difference(made, ("native", 2, 1), again) is None
    again.resistance.loc[300, "force_y_N"] += 1e-15
    assert "bits" in difference(made, ("native", 2, 1), again)


def test_an_engine_of_another_version_may_differ_as_its_twins_do_and_no_more(written):
    made, _ = written
    run = "liggghts", 2, 1
    for again in recorded_datasets(case(), engines=("liggghts",)):
        if (again.engine, again.seed, again.twin) == run:
            break
    again.manifest["engine_version"] = "LIGGGHTS 9"
    forces = ["force_y_N", "tip_force_y_N", "shaft_force_y_N"]
    again.resistance[forces] *= 1.001
    assert difference(made, run, again) is None
    again.resistance[forces] *= 5
    assert "mean_resistance_N" in difference(made, run, again)


def test_the_machine_that_counts_is_that_of_the_run(written):
    made, _ = written
    run = "liggghts", 2, 1
    [again] = [
        one
        for one in recorded_datasets(case(), engines=("liggghts",))
        if (one.engine, one.seed, one.twin) == run
    ]
    assert same_program(made, run, again)
    elsewhere = made.ensemble.manifests[run] | {"machine": {"machine": "another"}}
    manifests = made.ensemble.manifests | {run: elsewhere}
    on_cluster = replace(made, ensemble=replace(made.ensemble, manifests=manifests))
    assert not same_program(on_cluster, run, again)


def test_one_recorded_twin_alone_tells_nothing_of_scatter():
    endpoints = record(twins=0).ensemble.endpoints
    p = strangeness(endpoints, ("native", 1, 0), 2 * endpoints.loc[("native", 1, 0)])
    assert (p == 1).all()


def test_one_command_line_plans_the_case_and_its_variants():
    plans = plans_of(
        ["contact.particle_wall.friction=0", "a=1, b=2"],
        ["native", "yade"],
        32,
        2,
        12,
        7,
        ["native"],
        16,
    )
    assert [plan.name for plan in plans] == [
        "default",
        "contact.particle_wall.friction=0",
        "a=1,b=2",
    ]
    assert (plans[0].seeds, plans[0].twins, plans[0].twin_seeds) == (32, 2, 12)
    assert plans[0].native_twins == 7
    assert (plans[1].seeds, plans[1].engines, plans[1].native_twins) == (16, ("native",), 0)
