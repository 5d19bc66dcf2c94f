"""The whole ladder with the real engines; and that wrong numbers in an adapter make it exit 1 with the rung's name."""

import json
import os
import re
import shutil

import pytest
from command_line import ROOT

from crossdem import ExitCode
from crossdem.adapters.engine import EngineNotFound
from crossdem.adapters.engines import DEFAULT_ENGINES, ENGINES, get_engine
from crossdem.compare.ladder_command import check_ladder
from crossdem.compare.rungs import CLOSED_FORM, NO_SUCH_LAW, TWIN

MICRO = ROOT / "reference_cases" / "micro"
JOBS = len(os.sched_getaffinity(0))


def check(folder, engines, out, overrides=()):
    ended = check_ladder(folder, engines, out, list(overrides), JOBS)
    return ended, json.loads((out / "ladder.json").read_text())


def needs(*engines):
    for engine in engines:
        try:
            get_engine(engine).version()
        except EngineNotFound as error:
            if os.environ.get("CI"):
                raise
            pytest.skip(str(error))


@pytest.fixture(scope="module")
def ladder(tmp_path_factory):
    needs(*DEFAULT_ENGINES)
    return check(MICRO, list(DEFAULT_ENGINES), tmp_path_factory.mktemp("ladder") / "out")


# What engines say themselves that they do not offer.
NOT_OFFERED = {
    ("joint_pulled_apart", "liggghts"),
    ("joint_pulled_apart", "yade"),
    ("rolling_resistance", "yade"),
}


def test_every_rung_of_every_case_holds_in_every_engine(ladder):
    ended, found = ladder
    others = [rung for rung in found["rungs"] if rung["outcome"] != "agrees"]
    assert {(rung["case"], rung["engine"]) for rung in others} == NOT_OFFERED
    assert {rung["outcome"] for rung in others} == {NO_SUCH_LAW} and ended == ExitCode.AGREES
    assert len(found["cases"]) >= 16
    for case in found["cases"]:
        for engine in DEFAULT_ENGINES:
            kinds = {
                rung["kind"]
                for rung in found["rungs"]
                if (rung["case"], rung["engine"]) == (case["name"], engine)
            }
            assert kinds == {TWIN, CLOSED_FORM}, f"{case['name']}, {engine}"


def test_liggghts_and_yade_are_their_twins_to_the_last_bit(ladder):
    _, found = ladder
    twins = [
        rung
        for rung in found["rungs"]
        if rung["kind"] == TWIN and rung["engine"] != "native" and rung["outcome"] != NO_SUCH_LAW
    ]
    assert len(twins) == 2 * len(found["cases"]) - len(NOT_OFFERED)
    assert {rung["limit_m"] for rung in twins} == {0} == {rung["difference_m"] for rung in twins}


def test_the_papers_scheme_gains_energy_without_damping_in_proportion_to_the_time_step(ladder):
    _, found = ladder
    gains = {
        rung["case"]: rung
        for rung in found["rungs"]
        if rung["engine"] == "native" and rung["case"].startswith("undamped")
        if rung["kind"] == CLOSED_FORM
    }
    assert gains["undamped_at_paper_step"]["values"][0] == pytest.approx(1.31, abs=0.01)
    assert gains["undamped_impact"]["order"] == pytest.approx(1, abs=0.05)
    assert abs(gains["undamped_impact"]["error"]) < 1e-4


# Seeded faults: what an adapter's input could say wrongly.


def liggghts_number(name, factor):
    def spoil(inputs):
        path = inputs / "numbers.in"
        pattern = rf"(variable {name} string )(\S+)"
        text, count = re.subn(
            pattern, lambda found: f"{found[1]}{factor * float(found[2])!r}", path.read_text()
        )
        assert count == 1
        path.write_text(text)

    return spoil


def liggghts_particles(pattern, replaced):
    def spoil(inputs):
        path = inputs / "particles.data"
        text, count = re.subn(pattern, replaced, path.read_text(), flags=re.MULTILINE)
        assert count >= 1
        path.write_text(text)

    return spoil


def yade_script(old, new):
    def spoil(inputs):
        path = inputs / "yade_case.py"
        text = path.read_text()
        assert old in text
        path.write_text(text.replace(old, new))

    return spoil


FAULTS = {
    # tan(0.75) = 0.9316
    "liggghts, tan(mu) for mu": (
        "liggghts",
        "oblique_sliding",
        liggghts_number("friction_wall", 1.2421),
    ),
    "liggghts, halved wall damping": (
        "liggghts",
        "drop_on_floor_low_damping",
        liggghts_number("gamman_wall", 0.5),
    ),
    "liggghts, halved shear stiffness": (
        "liggghts",
        "grazing_stick_slip",
        liggghts_number("kt_wall", 0.5),
    ),
    "liggghts, spin sign": (
        "liggghts",
        "spin_start",
        liggghts_particles(r"^(1 \S+ \S+ 0 0 0 )(4)$", r"\1-\2"),
    ),
    # 4/3 r rho where h rho belongs
    "liggghts, sphere mass": (
        "liggghts",
        "drop_on_floor",
        liggghts_particles(r"^(1 1 \S+ )\S+", r"\g<1>5.1"),
    ),
    "liggghts, gravity off by a thousandth": (
        "liggghts",
        "free_fall",
        liggghts_number("gravity", 0.999),
    ),
    "yade, tan(mu) for mu": (
        "yade",
        "oblique_sliding",
        yade_script(
            'math.atan(case["contact"]["particle_wall"]["friction"])',
            'case["contact"]["particle_wall"]["friction"]',
        ),
    ),
    "yade, halved wall damping": (
        "yade",
        "low_damping_separation",
        yade_script(
            "ViscElMat(density=density, **of_wall)",
            "ViscElMat(density=density, **of_wall | {'cn': of_wall['cn'] / 3})",  # in series: half of it
        ),
    ),
    "yade, sphere inertia": (
        "yade",
        "slide_to_roll",
        yade_script("(0.5 * body.state.mass", "(0.4 * body.state.mass"),
    ),
    "yade, spin sign": (
        "yade",
        "unequal_oblique_pair",
        yade_script(
            '(0, 0, disc["angular_velocity_rad_s"])', '(0, 0, -disc["angular_velocity_rad_s"])'
        ),
    ),
}


@pytest.mark.parametrize("engine, name, spoil", FAULTS.values(), ids=FAULTS)
def test_a_wrong_number_in_an_adapter_exits_1_and_names_case_engine_and_rung(
    engine, name, spoil, tmp_path, monkeypatch, capsys
):
    needs(engine)
    write_input = type(ENGINES[engine]).write_input

    def write_wrong_input(self, case, packing, run_dir):
        write_input(self, case, packing, run_dir)
        spoil(run_dir / "inputs")

    monkeypatch.setattr(type(ENGINES[engine]), "write_input", write_wrong_input)
    folder = tmp_path / "folder"
    folder.mkdir()
    shutil.copyfile(MICRO / f"{name}.toml", folder / f"{name}.toml")
    ended, found = check(folder, [engine], tmp_path / "out")
    assert ended == ExitCode.DIFFERS
    sentence = found["verdict"]["sentence"]
    assert sentence.startswith(f"{name}, {engine}, twin, native in the scheme {engine}: ")
    assert " ".join(sentence.split()) in " ".join(capsys.readouterr().out.split())
    wrong = {rung["kind"] for rung in found["rungs"] if rung["outcome"] == "differs"}
    assert wrong == {TWIN, CLOSED_FORM}, "the closed form alone must show it, too"


@pytest.mark.parametrize("engine", ["liggghts-averaged", "yade-averaged"])
def test_with_the_papers_integrator_an_established_code_climbs_it_too_and_gains_the_same_energy(
    engine, tmp_path
):
    needs(engine)
    folder = tmp_path / "folder"
    folder.mkdir()
    for name in ("head_on_pair_low_damping", "slide_to_roll", "undamped_at_paper_step"):
        shutil.copyfile(MICRO / f"{name}.toml", folder / f"{name}.toml")
    ended, found = check(folder, [engine], tmp_path / "out")
    assert [rung for rung in found["rungs"] if rung["outcome"] != "agrees"] == []
    assert ended == ExitCode.AGREES and len(found["rungs"]) == 7
    [gain] = [rung for rung in found["rungs"] if rung["answer"] == "restitution_at_step"]
    assert gain["values"][0] == pytest.approx(1.31, abs=0.01)
