"""The door for users' codes: docs/own_engine.md. Behind it stands the native solver, so that every bit must come through."""

import json
import os
import shutil
from pathlib import Path

import numpy as np
import pytest
from command_line import crossdem
from small_case import small_case, small_file

from crossdem.adapters import engines
from crossdem.adapters.case import load_case
from crossdem.adapters.dataset import Dataset
from crossdem.adapters.engine import EngineNotFound
from crossdem.adapters.engine_file import EngineFileError, read_engine
from crossdem.adapters.engine_file_faults import LADDER
from crossdem.adapters.run import run_all
from crossdem.adapters.run_folder import RunRequest, run_key
from crossdem.adapters.solver import find_solver
from crossdem.adapters.workflow.ensemble import run_ensemble

HERE = Path(__file__).parent
DESCRIPTION = """\
name = "door"
version = ["/usr/bin/python3", "door_engine.py", "--version"]
run = ["/usr/bin/python3", "{inputs}/door_engine.py", "--case", "{case}", "--packing", "{packing}", "--out", "{out}"]
files = ["door_engine.py"]
"""
CLASS = """\
from crossdem.adapters.external import External

class Door(External):
    name = "door"
    program = "/usr/bin/python3"
    files = ("door_engine.py",)
    def version(self):
        return "door 1.0"
    def command(self, case, run_dir):
        contract = ["--case", "inputs/case.json", "--packing", "inputs/packing.csv", "--out", "output"]
        return [self.program, "inputs/door_engine.py", *contract]
"""


@pytest.fixture
def describe(tmp_path, monkeypatch):
    """A function that writes a description, after the usual one more lines, and attaches its engine for this test."""
    monkeypatch.setattr(engines, "ENGINES", dict(engines.ENGINES))
    monkeypatch.setenv("CROSSDEM_SOLVER", str(find_solver()))
    shutil.copy(HERE / "door_engine.py", tmp_path)

    def written(more="", text=DESCRIPTION, name="door.toml"):
        (tmp_path / name).write_text(text + more, encoding="utf-8")
        return tmp_path / name

    return written


def run(case, packing, out, names=("native", "door")):
    return run_all([RunRequest(case, packing, name) for name in names], out, 2)


@pytest.fixture(params=["toml", "class"])
def attached(request, describe):
    if request.param == "toml":
        return engines.attach(str(describe()))
    return engines.attach(f"{describe(text=CLASS, name='door.py')}:Door")


def assert_same_bits(results):
    native, own = (Dataset.read(result.dataset_folder) for result in results)
    for name, values in vars(native.motion).items():
        assert np.array_equal(values, getattr(own.motion, name)), name
    assert own.resistance.equals(native.resistance)
    return own


def test_what_a_code_writes_comes_through_to_the_last_bit(attached, case, packing, tmp_path):
    own = assert_same_bits(run(case, packing, tmp_path / "out"))
    assert (own.engine, own.manifest["engine_version"]) == ("door", "door 1.0")
    assert all(gate["passed"] for gate in own.manifest["gates"])
    folder = tmp_path / "out/runs"
    [inputs] = folder.glob("door-*/inputs")
    assert (inputs / "door_engine.py").read_bytes() == (HERE / "door_engine.py").read_bytes()


@pytest.mark.parametrize(
    "fault, more",
    [
        (
            "other units",
            '[motion.columns]\nx_m = { unit = "mm" }\n[resistance.columns]\nforce_y_N = { column = "fy", unit = "mN" }\n',
        ),
        ("files of frames", '[motion]\nfiles = "frame_*.csv"\nseparator = " "\n'),
    ],
)
def test_other_names_units_and_files_are_read_as_described(
    fault, more, describe, case, packing, tmp_path, monkeypatch
):
    monkeypatch.setenv("FAULT", fault)
    engines.attach(str(describe(more)))
    native, own = run(case, packing, tmp_path / "out")
    native, own = Dataset.read(native.dataset_folder), Dataset.read(own.dataset_folder)
    assert np.abs(own.motion.position_m - native.motion.position_m).max() < 1e-16
    assert np.array_equal(own.motion.velocity_m_s, native.motion.velocity_m_s)
    forces = own.resistance["force_y_N"], native.resistance["force_y_N"]
    assert np.allclose(*forces, rtol=1e-15, atol=0)


@pytest.mark.parametrize(
    "fault, said",
    [
        ("crashes", "ended with status 5 with the bar at a depth of"),
        ("crashes", "no convergence in step 12"),
        ("writes nothing", "no readable run.json"),
        ("writes nothing", "there is no motion.csv"),
        ("no run.json", "no readable run.json"),
        ("pipes", "is neither a file nor a folder"),
        ("torn run.json", "no readable run.json"),
        ("not completed", "run.json: completed is false, expected true"),
        ("another engine", 'run.json: engine is "another", expected "door"'),
        ("another version", 'run.json: version is "door 0.9", expected "door 1.0"'),
        ("a frame less", "5 of 6 frames"),
        (
            "a particle less",
            "not every frame holds every particle once (the frame at 0.1 s has 39 of 40)",
        ),
        ("a particle twice", "not every frame holds every particle once"),
        ("ids from 1", "its ids are not those of the packing, 0 to 39"),
        ("text", "resistance.csv: 1 values of force_y_N are not finite numbers"),
        ("not finite", "motion.csv: 1 values of x_m are not finite numbers"),
        ("a column less", "resistance.csv lacks the columns floor_force_y_N; it has time_s"),
        ("shifted times", "the samples are not at the times that the case asks for"),
        ("lost particle", "lost 1 particles, found outside the container"),
    ],
)
def test_output_that_breaks_the_contract_is_a_failed_run(
    fault, said, describe, case, packing, tmp_path, monkeypatch
):
    monkeypatch.setenv("FAULT", fault)
    engines.attach(str(describe()))
    [result] = run(case, packing, tmp_path / "out", ["door"])
    if fault == "crashes" and said.startswith("ended"):
        said = "door ended with status 5"
    assert result.status == "failed" and said in result.failure
    assert not list((tmp_path / "out/runs").iterdir())


def test_a_case_that_a_code_declines_is_not_offered(describe, case, packing, tmp_path, monkeypatch):
    """Not in this process, and not in a task of the workflow, where it is not tried again."""
    monkeypatch.setenv("FAULT", "declines")
    engines.attach(str(describe()))
    [result] = run(case, packing, tmp_path / "out", ["door"])
    assert (result.status, result.failure) == ("unsupported", "door: it knows no such bar")
    assert not list((tmp_path / "out/runs").iterdir()) and not (tmp_path / "out/failed").exists()
    request = RunRequest(case, packing, "door")
    [result] = run_ensemble([(request, tmp_path / "out")], tmp_path / "workflow", 1)
    assert (result.status, result.failure) == ("unsupported", "door: it knows no such bar")


def test_tasks_of_the_workflow_know_a_users_engine(attached, case, packing, tmp_path):
    requests = [(RunRequest(case, packing, name), tmp_path / "out") for name in ("native", "door")]
    assert_same_bits(run_ensemble(requests, tmp_path / "workflow", 2))


def test_a_run_is_made_anew_when_code_or_description_change(describe, case, packing, tmp_path):
    keys = set()
    for more in ("", "cost_s = 1e-6\n"):
        engines.attach(str(describe(more)))
        keys.add(run_key(case, packing, engines.get_engine("door")))
    with open(tmp_path / "door_engine.py", "a", encoding="utf-8") as code:
        code.write("# changed\n")
    keys.add(run_key(case, packing, engines.get_engine("door")))
    assert len(keys) == 3
    (tmp_path / "door_engine.py").unlink()
    with pytest.raises(EngineNotFound, match="door_engine.py"):
        run_key(case, packing, engines.get_engine("door"))


@pytest.mark.parametrize(
    "more, fault",
    [
        ('colour = "red"', "colour: no such key"),
        ("substeps = 0", "substeps: how many time steps"),
        ("substeps = true", "substeps: how many time steps"),
        ("cost_s = -1.0", "cost_s: seconds of CPU time"),
        ("cost_s = nan", "cost_s: seconds of CPU time"),
        ('progress = "../x"', "progress: a file in {out}"),
        ("twin_limit_m = inf", "twin_limit_m: how far"),
        ("motion = 3", "motion: a table"),
        ('[motion]\ncolour = "red"', "motion.colour: no such key"),
        ('[motion]\nfiles = "/etc/*"', "motion.files: the pattern of a file in {out}"),
        ('[motion]\nseparator = "xx"', "motion.separator: one of"),
        ('[motion.columns]\nz_m = "z"', "motion.columns.z_m: no such column; there are time_s"),
        (
            '[motion.columns]\nx_m = { unit = "furlong" }',
            'motion.columns.x_m: no such unit "furlong"; its units: m, cm, mm, um',
        ),
        ('[motion.columns]\nid = { unit = "m" }', 'no such unit "m"; its units: none'),
        ("[motion.columns]\nx_m = { unit = 3 }", "motion.columns.x_m: the name of a column"),
        ("[motion.columns]\nx_m = 3", "motion.columns.x_m: the name of a column"),
        ("difference = 3", "difference: tables with the keys case, quantity"),
        ('[[difference]]\ncase = "pinch"', "difference[0].quantity: is missing: the answer"),
        ('[scheme]\nslip_cap = "totl"', "scheme.slip_cap: must be one of spring, total"),
        ('[scheme]\nslip_kap = "total"', "scheme.slip_kap: unknown key; known here: attraction"),
        ('[scheme]\nname = "yade"\nslip_cap = "total"', "scheme.name: the scheme"),
        ("[scheme]\nslip_cap = 3", "scheme: readings of the native scheme"),
    ],
)
def test_a_fault_of_a_description_names_file_and_key(more, fault, describe):
    with pytest.raises(EngineFileError) as told:
        read_engine(describe(more))
    assert str(told.value).startswith(f"{describe(more)}: ") and fault in str(told.value)


@pytest.mark.parametrize(
    "changed, fault",
    [
        ({}, None),
        ({"value": -0.02}, None),
        ({"case": "spin_strt"}, "case: unknown case 'spin_strt'; did you mean 'spin_start'?"),
        ({"case": 3}, "case: the name of a case"),
        ({"quantity": "bar_side_force"}, "quantity: unknown answer of pinch 'bar_side_force'; did"),
        (
            {"quantity": "restitution"},
            "quantity: unknown answer of pinch 'restitution'; known: sink",
        ),
        ({"quantity": "sink_over_bar_speed"}, "quantity: difference[0] has the same; leave one"),
        ({"value": 0}, "value: by how much it is above"),
        ({"value": True}, "value: by how much it is above"),
        ({"tolerance": -0.01}, "tolerance: how far from `value`"),
        ({"tolerance": 0.02}, "tolerance: one that includes 0 says nothing"),
        ({"value": -0.02, "tolerance": 0.03}, "tolerance: one that includes 0 says nothing"),
        ({"colour": "red"}, "colour: no such key"),
    ],
)
def test_a_fault_of_a_difference_names_entry_and_key(changed, fault, describe):
    first = {"case": "pinch", "quantity": "sink_over_bar_speed", "value": 0.02, "tolerance": 0.01}
    first |= {"reason": "r"}
    more = ""
    for entry in (first, first | {"quantity": "bar_side_force_N"} | changed):
        lines = (f"{key} = {json.dumps(value)}\n" for key, value in entry.items())
        more += "[[difference]]\n" + "".join(lines)
    path = describe(more)
    if fault is None:
        assert len(read_engine(path).difference) == 2
        return
    with pytest.raises(EngineFileError) as told:
        read_engine(path)
    [line] = str(told.value).splitlines()
    assert line.startswith(f"{path}: difference[1].{fault}")


def test_the_cases_of_the_ladder_have_the_names_of_their_files():
    """By which a [[difference]] is checked."""
    assert all(load_case(path).name == path.stem for path in LADDER.glob("*.toml"))


def test_a_scheme_is_not_checked_where_there_is_no_solver(describe, monkeypatch):
    monkeypatch.setenv("CROSSDEM_SOLVER", "/nowhere")
    assert read_engine(describe('[scheme]\nslip_cap = "totl"')).scheme == {"slip_cap": "totl"}


@pytest.mark.parametrize(
    "files, fault",
    [
        (["case.json"], 'files[0]: "case.json" is the name of crossdem\'s own input'),
        (["a.in", "sub/packing.csv"], 'files[1]: "sub/packing.csv" is the name of crossdem\'s own'),
        (["a.in", "sub/a.in"], 'files[1]: "sub/a.in" has the name of files[0]'),
        (["../a.in"], 'files[0]: "../a.in" does not lie below the folder'),
        (["/a.in"], 'files[0]: "/a.in" does not lie below the folder'),
        (["a.in", "missing"], 'files[1]: "missing" is no file beside this description'),
        (["sub"], 'files[0]: "sub" is no file beside this description'),
        (["pipe"], 'files[0]: "pipe" is no file beside this description'),
        (["x" * 300], "is no file beside this description"),
    ],
)
def test_a_file_that_cannot_be_copied_into_a_run_is_named(files, fault, describe, tmp_path):
    (tmp_path / "sub").mkdir()
    for name in ("a.in", "sub/a.in", "sub/packing.csv"):
        (tmp_path / name).touch()
    os.mkfifo(tmp_path / "pipe")
    usual = 'files = ["door_engine.py"]'
    assert usual in DESCRIPTION
    with pytest.raises(EngineFileError) as told:
        read_engine(describe(text=DESCRIPTION.replace(usual, f"files = {json.dumps(files)}")))
    [line] = str(told.value).splitlines()
    assert fault in line


def test_every_fault_of_a_description_is_told_at_once(describe, tmp_path):
    text = 'name = "Bad Name"\nversion = "x"\nrun = ["x", "{nothing}"]\nfiles = ["none", "case.json"]\n'
    text += '[scheme]\nslip_cap = "totl"\nslip_kap = "total"\n'
    with pytest.raises(EngineFileError) as told:
        read_engine(describe(text=text))
    assert len(str(told.value).splitlines()) == 7
    with pytest.raises(EngineFileError, match="run: is missing"):
        read_engine(describe(text='name = "x"\nversion = ["x"]\n'))
    with pytest.raises(EngineFileError, match="not valid TOML"):
        read_engine(describe(text="name = "))
    with pytest.raises(EngineFileError, match="cannot be read"):
        read_engine(tmp_path / "nowhere.toml")


@pytest.mark.parametrize(
    "text, said",
    [
        ("", "holds no class Door derived from"),
        ("class Door: pass\n", "holds no class Door derived from"),
        ("1/0\n", "ZeroDivisionError"),
        (CLASS.replace('"door"', '"native"', 1), "is the name of one of crossdem's own engines"),
        (CLASS.replace('"door"', '"Do or"', 1), "no `name` of small letters"),
        (CLASS.replace("def version", "def said"), "abstract method"),
        (CLASS.replace('("door_engine.py",)', '("none",)'), 'files.0.: "none" is no file beside'),
        (
            CLASS.replace("    files", "    substeps = 0\n    files"),
            "substeps: how many time steps",
        ),
        (
            CLASS.replace("    files", "    scheme = {'slip_cap': 'totl'}\n    files"),
            "scheme.slip_cap",
        ),
        (
            CLASS.replace("    files", "    difference = 3\n    files"),
            "difference: tables with the",
        ),
        (
            CLASS.replace("    files", "    difference = [{}]\n    files"),
            "difference.0..reason: is",
        ),
    ],
)
def test_a_class_that_cannot_be_used_is_refused_in_words(text, said, describe):
    with pytest.raises(EngineFileError, match=said):
        engines.attach(f"{describe(text=text, name='door.py')}:Door")


def test_names_are_taken_once(describe):
    with pytest.raises(EngineFileError, match="liggghts is the name of one of crossdem's own"):
        engines.attach(str(describe(text=DESCRIPTION.replace('"door"', '"liggghts"', 1))))
    engines.attach(str(describe()))
    engines.attach(str(describe()))
    with pytest.raises(EngineFileError, match="has the name door too"):
        engines.attach(str(describe(name="other.toml")))


@pytest.mark.parametrize("version, said", [("", "''"), ("\x1b[31mred", "does not say its version")])
def test_a_code_that_does_not_say_its_version_is_missing(version, said, describe, monkeypatch):
    monkeypatch.setenv("SAID_VERSION", version)
    with pytest.raises(EngineNotFound, match="door does not say its version"):
        read_engine(describe()).version()


def test_a_program_that_is_not_there_is_missing(describe):
    engine = read_engine(describe(text=DESCRIPTION.replace("/usr/bin/python3", "./nothing")))
    with pytest.raises(EngineNotFound, match="its program ./nothing cannot be run"):
        engine.version()


def test_check_compares_a_users_code_like_any_other(describe, tmp_path):
    """Its results are the native solver's, so that no difference is left; the small bed itself lacks two quantities."""
    case = small_file(tmp_path)
    ended = crossdem(
        *("check", case, "--engines", "native", "--engine", describe(), "--seeds", "1"),
        cwd=tmp_path,
    )
    assert ended.returncode == 4, ended.stdout + ended.stderr
    found = json.loads((tmp_path / "results/bar_penetration/report.json").read_text())
    compared = [check for check in found["checks"] if check["outcome"] != "not comparable"]
    assert {tuple(check["pair"]) for check in found["checks"]} == {("door", "native")}
    assert len(compared) == 9 and all(check["difference"] == 0.0 for check in compared)
    bad = crossdem("check", case, "--engine", describe("substeps = 0"), cwd=tmp_path)
    assert bad.returncode == 2 and "substeps" in bad.stderr and "Traceback" not in bad.stderr


def test_substeps_divide_the_time_step_of_the_case(describe):
    engine = read_engine(describe("substeps = 4\n"))
    case = small_case()
    assert engine.step_s(case) == case.resolved["time"]["step_s"] / 4
    assert engine.schedule(case).penetration == 4 * 1000
    assert "door" not in case.resolved["engines"]
