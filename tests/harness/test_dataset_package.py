"""Packages of reference runs: whole, described to the last file, told apart by every byte, and fit to be compared with."""

import csv
import json
import os
import shlex
import shutil
import subprocess
import tarfile
from fnmatch import fnmatchcase
from pathlib import Path
from urllib.parse import unquote

import h5py
import pytest
import yaml
from small_case import small_file
from test_own_engine import DESCRIPTION

from crossdem import ExitCode
from crossdem.adapters import engines
from crossdem.adapters.case import load_case
from crossdem.adapters.motion_file import DATASETS
from crossdem.adapters.solver import find_solver, solver_sha256
from crossdem.compare.cli import main
from crossdem.compare.dataset_documents import TIMED
from crossdem.compare.dataset_record import read_package
from crossdem.compare.dataset_sums import SUMS, files_in, sha256_of, write_sums
from crossdem.compare.replay import replayed

NATIVE = ("--engines", "native", "--seeds", "1", "--native-seeds", "2", "--jobs", "2")


def build(case_file, package, work, *options):
    return main(
        ["dataset", "build", str(case_file), "-o", str(package), "--out", str(work), *options]
    )


@pytest.fixture(scope="module")
def case_file(tmp_path_factory):
    return small_file(tmp_path_factory.mktemp("case"))


@pytest.fixture(scope="module")
def package(case_file, tmp_path_factory):
    folder = tmp_path_factory.mktemp("built")
    assert build(case_file, folder / "package", folder / "work", *NATIVE, "--archive") == 0
    return folder / "package"


@pytest.fixture
def copy(package, tmp_path):
    return Path(shutil.copytree(package, tmp_path / "copy"))


def verify(folder, capsys, *options):
    capsys.readouterr()
    code = main(["dataset", "verify", str(folder), *options])
    return code, capsys.readouterr().out.splitlines()


def descriptor(folder):
    return json.loads((folder / "datapackage.json").read_text(encoding="utf-8"))


def test_sha256sum_reads_the_sums_and_verify_finds_no_fault(package, capsys):
    done = subprocess.run(["sha256sum", "-c", "--strict", SUMS], cwd=package, capture_output=True)
    assert done.returncode == 0
    identity = sha256_of(package / SUMS)
    code, lines = verify(package, capsys, "--identity", identity)
    assert code == ExitCode.AGREES and identity in lines[0]


def test_one_flipped_bit_is_found_in_every_file(copy, capsys):
    for name in files_in(copy):
        path = copy / name
        sound = path.read_bytes()
        for place in (0, len(sound) // 2, len(sound) - 1) if sound else ():
            changed = bytearray(sound)
            changed[place] ^= 1
            path.write_bytes(changed)
            code, lines = verify(copy, capsys)
            assert code == ExitCode.DIFFERS and any(name in line for line in lines), (name, place)
        path.write_bytes(sound)
    assert verify(copy, capsys)[0] == ExitCode.AGREES


def test_each_missing_file_is_named(copy, capsys):
    for name in files_in(copy):
        (copy / name).rename(copy.parent / "aside")
        code, lines = verify(copy, capsys)
        assert code == ExitCode.DIFFERS and f"{name} is missing" in lines
        (copy.parent / "aside").rename(copy / name)


def test_an_added_file_folder_or_link_is_found(copy, capsys):
    (copy / "runs" / "more.csv").touch()
    (copy / "empty").mkdir()
    (copy / "link").symlink_to("README.md")
    code, lines = verify(copy, capsys)
    assert code == ExitCode.DIFFERS
    assert {"runs/more.csv was added", "empty/ was added", "link was added"} <= set(lines)


def test_a_pipe_in_the_place_of_a_file_is_found_and_not_waited_for(copy, capsys):
    for name, told in (("case.json", "case.json is no file"), (SUMS, f"{SUMS} is missing")):
        (copy / name).unlink()
        os.mkfifo(copy / name)
        code, lines = verify(copy, capsys)
        assert code == ExitCode.DIFFERS and told in lines


def test_sums_written_anew_do_not_hide_a_change(copy, package, capsys):
    with open(copy / "case.json", "ab") as file:
        file.write(b" ")
    write_sums(copy)
    code, lines = verify(copy, capsys)
    assert code == ExitCode.DIFFERS and "case.json is not what datapackage.json lists" in lines
    identity = sha256_of(package / SUMS)
    assert any(identity in line for line in verify(copy, capsys, "--identity", identity)[1])


def test_a_folder_without_a_package_ends_with_2(tmp_path, package, capsys):
    assert main(["dataset", "verify", str(tmp_path)]) == ExitCode.BAD_INPUT
    archive = package.with_name("package.tar.gz")
    assert main(["dataset", "verify", str(archive)]) == ExitCode.BAD_INPUT
    assert "unpack it" in capsys.readouterr().err


def test_the_same_runs_make_the_same_package_and_archive(package, case_file):
    again = package.parent / "again" / "package"
    assert build(case_file, again, package.parent / "work", *NATIVE, "--archive") == 0
    assert sha256_of(again / SUMS) == sha256_of(package / SUMS)
    archives = [folder.with_name("package.tar.gz").read_bytes() for folder in (package, again)]
    assert archives[0] == archives[1]
    with tarfile.open(package.with_name("package.tar.gz")) as archive:
        assert archive.getnames() == [f"package/{name}" for name in files_in(package)]
        assert {(entry.mtime, entry.uid, entry.uname) for entry in archive} == {(0, 0, "")}
    assert archives[0][4:8] == bytes(4)  # the time in gzip's header, whole seconds


def test_other_runs_of_the_same_versions_differ_in_nothing_but_times(package, case_file, tmp_path):
    again = tmp_path / "package"
    assert build(case_file, again, tmp_path / "work", *NATIVE) == 0
    assert files_in(again) == files_in(package)
    vary = [n for n in files_in(again) if (again / n).read_bytes() != (package / n).read_bytes()]
    assert [name for name in vary if not any(fnmatchcase(name, key) for key in TIMED)] == []


def test_titles_and_descriptions_say_what_was_changed_in_the_case(case_file, tmp_path):
    change = "contact.particle_wall.friction=0.1"
    package = tmp_path / "package"
    assert build(case_file, package, tmp_path / "work", *NATIVE, "--set", change) == 0
    citation = yaml.safe_load((package / "CITATION.cff").read_text(encoding="utf-8"))
    crate = (package / "ro-crate-metadata.json").read_text(encoding="utf-8")
    for told in (descriptor(package), {"description": citation["abstract"]} | citation):
        assert f"changed: {change}" in told["title"] and f"changed: {change}" in told["description"]
    assert f"changed: {change}" in crate


def test_who_is_to_be_cited_is_named_everywhere(case_file, tmp_path):
    package = tmp_path / "package"
    authors = ["A. Author", 'B. "Both" Author']
    named = [word for name in authors for word in ("--author", name)]
    assert build(case_file, package, tmp_path / "work", *NATIVE, *named) == 0
    citation = yaml.safe_load((package / "CITATION.cff").read_text(encoding="utf-8"))
    assert [entry["name"] for entry in citation["authors"]] == authors
    assert [entry["title"] for entry in descriptor(package)["contributors"]] == authors
    graph = json.loads((package / "ro-crate-metadata.json").read_bytes())["@graph"]
    entities = {entity["@id"]: entity for entity in graph}
    assert [entities[author["@id"]]["name"] for author in entities["./"]["author"]] == authors
    command = json.loads((package / "provenance.json").read_bytes())["command"]
    assert command.split("crossdem ")[1] and "--author 'A. Author'" in command


def test_a_failed_engine_leaves_no_package(case_file, tmp_path, fake, capsys):
    fake.fault("crash")
    options = ("--engines", "native,liggghts", "--seeds", "1")
    code = build(case_file, tmp_path / "package", tmp_path / "work", *options)
    assert code == ExitCode.ENGINE_FAILED
    assert "not built, as runs are missing" in capsys.readouterr().err
    assert not list(tmp_path.glob("*package*"))


def test_a_place_that_is_taken_is_refused_before_there_are_runs(package, case_file, tmp_path):
    sums = sha256_of(package / SUMS)
    assert build(case_file, package, tmp_path / "work", *NATIVE) == ExitCode.BAD_INPUT
    assert sha256_of(package / SUMS) == sums and not (tmp_path / "work").exists()


def test_the_data_package_lists_every_file_with_its_size_and_hash(package):
    resources = {entry["path"]: entry for entry in descriptor(package)["resources"]}
    assert sorted(resources) == [
        name for name in files_in(package) if name not in ("datapackage.json", SUMS)
    ]
    for name, entry in resources.items():
        assert entry["bytes"] == (package / name).stat().st_size
        assert entry["hash"] == f"sha256:{sha256_of(package / name)}"
    assert len({entry["name"] for entry in resources.values()}) == len(resources)


def test_schemas_name_the_columns_that_tables_have(package):
    tables = [entry for entry in descriptor(package)["resources"] if "schema" in entry]
    assert {Path(entry["path"]).name for entry in tables} > {
        "resistance.csv",
        "ledger.csv",
        "endpoints.csv",
    }
    for entry in tables:
        with open(package / entry["path"], newline="", encoding="utf-8") as file:
            header = next(csv.reader(file))
        assert header == [field["name"] for field in entry["schema"]["fields"]], entry["path"]


def test_columns_have_the_unit_that_their_name_ends_in(package):
    with open(package / "columns.csv", newline="", encoding="utf-8") as file:
        units = {row["name"]: row["unit"] for row in csv.DictReader(file)}
    assert units["floor_y_Ns"] == units["residual_x_Ns"] == "N s"
    assert units["bar_work_J"] == "J" and units["contacts"] == "1"


def test_every_dataset_of_a_motion_file_is_defined_with_its_unit(package):
    with open(package / "columns.csv", newline="", encoding="utf-8") as file:
        rows = {row["name"]: row for row in csv.DictReader(file) if row["files"].endswith(".h5")}
    objects = set()
    with h5py.File(next(package.glob("runs/*/motion.h5"))) as file:
        defined = {h5py.h5o.get_info(file[name].id).addr for name in rows}
        file.visititems(
            lambda _, item: objects.add(h5py.h5o.get_info(item.id).addr)
            if isinstance(item, h5py.Dataset)
            else None
        )
        assert all(row["unit"] == file[n].attrs.get("unit", "1") for n, row in rows.items())
    assert defined == objects and rows.keys() <= DATASETS.keys()


def test_every_key_of_a_manifest_is_defined(package):
    with open(package / "columns.csv", newline="", encoding="utf-8") as file:
        defined = {
            row["name"] for row in csv.DictReader(file) if row["files"] == "runs/*/manifest.json"
        }
    for path in package.glob("runs/*/manifest.json"):
        assert json.loads(path.read_bytes()).keys() <= defined


def test_no_file_names_a_folder_of_this_machine(package, case_file):
    """But for the place of its packages in Debian."""
    here = {
        str(package.parent),
        str(case_file.parent),
        str(Path.home()),
        str(Path(__file__).resolve().parents[2]),
    }
    for name in files_in(package):
        content = (package / name).read_bytes()
        assert not [place for place in here if place.encode() in content], name


def test_the_command_of_a_package_with_a_users_code_makes_it_again(
    case_file, tmp_path, monkeypatch
):
    ours = dict(engines.ENGINES)
    monkeypatch.setattr(engines, "ENGINES", dict(ours))
    monkeypatch.setenv("CROSSDEM_SOLVER", str(find_solver()))
    shutil.copy(Path(__file__).with_name("door_engine.py"), tmp_path)
    (tmp_path / "door.toml").write_text(DESCRIPTION)
    own = ["--engines", "native", "--engine", str(tmp_path / "door.toml"), "--seeds", "1"]
    assert build(case_file, tmp_path / "package", tmp_path / "work", *own) == 0
    told = json.loads((tmp_path / "package" / "provenance.json").read_bytes())
    words = shlex.split(told["command"])
    assert "--engines native --engine engines/door/door.toml --seeds 1 " in told["command"]
    assert told["crossdem_solver_sha256"] == solver_sha256() and "numpy" in told["libraries"]
    monkeypatch.chdir(tmp_path / "package")
    monkeypatch.setattr(engines, "ENGINES", ours)
    again = ["--out", str(tmp_path / "again"), "--output", str(tmp_path / "other")]
    assert main([*words[1 : words.index("--output")], *again]) == 0
    for name in ("case.json", "tables/endpoints.csv", "engines/door/door_engine.py"):
        assert (tmp_path / "other" / name).read_bytes() == Path(name).read_bytes()


def test_the_crate_defines_all_that_it_names(package):
    graph = json.loads((package / "ro-crate-metadata.json").read_text(encoding="utf-8"))["@graph"]
    entities = {entity["@id"]: entity for entity in graph}
    assert len(entities) == len(graph)
    named = set()

    def walk(value):
        if isinstance(value, dict):
            named.update([value["@id"]] if set(value) == {"@id"} else [])
        for entry in value.values() if isinstance(value, dict) else value:
            if isinstance(entry, (dict, list)):
                walk(entry)

    walk(graph)
    assert named <= entities.keys()
    files = {unquote(entity["@id"]) for entity in graph if entity["@type"] == "File"}
    assert files | {"ro-crate-metadata.json"} == set(files_in(package))
    actions = [entity for entity in graph if entity["@type"] == "CreateAction"]
    assert len(actions) == 2
    for action in actions:
        assert entities[action["instrument"]["@id"]]["@type"] == "SoftwareApplication"
        assert action["startTime"] <= action["endTime"] and action["object"] and action["result"]


def test_the_citation_has_the_keys_that_the_format_needs(package):
    citation = yaml.safe_load((package / "CITATION.cff").read_text(encoding="utf-8"))
    assert {"cff-version", "message", "title", "authors"} <= citation.keys()
    assert citation["type"] == "dataset" and citation["license"] == "CC-BY-4.0"


def test_packings_are_read_back_to_the_last_bit(package, case_file, tmp_path):
    record = read_package(package, load_case(case_file))
    assert record.seeds == (1, 2)
    for seed in record.seeds:
        record.restore(seed, tmp_path / str(seed))
        there = package / "packings" / f"seed{seed}" / "packing.csv"
        assert (tmp_path / str(seed) / "packing.csv").read_bytes() == there.read_bytes()


def test_of_the_runs_asked_for_twin_0_of_each_packing_is_there_to_draw(case_file, tmp_path):
    ensemble = ("--engines", "native", "--seeds", "2", "--twins", "1", "--jobs", "2")
    assert build(case_file, tmp_path / "package", tmp_path / "work", *ensemble) == 0
    record = read_package(tmp_path / "package", load_case(case_file))
    for seeds in (1, 2):
        asked = replayed(record, ["liggghts"], seeds, 1)
        assert len(asked.ensemble.manifests) == 2 * seeds
        drawn = [(run.engine, run.seed, run.twin) for run in asked.datasets]
        assert drawn == [("native", seed, 0) for seed in range(1, seeds + 1)]


def against(case_file, package, out, *options):
    return main(["check", str(case_file), "--against", str(package), "--out", str(out), *options])


def test_runs_made_here_are_compared_with_those_of_engines_that_are_gone(
    case_file, tmp_path, fake, monkeypatch
):
    both = ("--engines", "native,liggghts", "--seeds", "2", "--jobs", "2")
    built = tmp_path / "package"
    assert build(case_file, built, tmp_path / "work", *both) == ExitCode.AGREES
    monkeypatch.setenv("PATH", "/usr/bin:/bin")
    code = against(case_file, built, tmp_path / "out", "--engines", "native")
    assert "crossdem check case.json --against ." in (built / "README.md").read_text()
    assert against(built / "case.json", built, tmp_path / "same", "--engines", "native") == code
    here = json.loads((tmp_path / "out" / "report.json").read_text(encoding="utf-8"))
    there = json.loads((built / "comparison" / "report.json").read_text(encoding="utf-8"))
    assert code == here["verdict"]["exit_code"]
    assert {(run["engine"], run["recorded"]) for run in here["runs"]} == {
        ("native", False),
        ("liggghts", True),
    }
    for run in there["runs"]:
        [twin] = [
            one
            for one in here["runs"]
            if (one["engine"], one["seed"]) == (run["engine"], run["seed"])
        ]
        assert twin["values"] == run["values"] and twin["packing_hash"] == run["packing_hash"]
    assert here["checks"] == there["checks"]
    page = (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    assert page.count('<svg class="bed"') == 8  # four times of each code, run here or not


def test_a_damaged_package_or_one_of_another_case_is_not_compared_with(
    copy, case_file, tmp_path, capsys
):
    other = ("--set", "contact.particle_wall.friction=0.1")
    assert against(case_file, copy, tmp_path / "out", *other) == ExitCode.BAD_INPUT
    assert "another case" in capsys.readouterr().err
    (copy / "README.md").unlink()
    assert against(case_file, copy, tmp_path / "out") == ExitCode.BAD_INPUT
    assert "README.md is missing" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("order", [1, -1])
def test_against_and_replay_exclude_each_other(order, case_file, package, capsys):
    options = [["--replay"], ["--against", str(package)]][::order]
    assert main(["check", str(case_file), *sum(options, [])]) == ExitCode.BAD_INPUT
    assert "give one" in capsys.readouterr().err
