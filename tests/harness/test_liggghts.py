"""The input that LIGGGHTS gets: numbers of the case, and no word of it."""

import re
from dataclasses import replace

import pandas as pd
import pytest
from few_particles import Disc, few_particles
from small_case import small_case

from crossdem.adapters import liggghts_input
from crossdem.adapters.case import Case
from crossdem.adapters.liggghts import Liggghts, LiggghtsAveraged
from crossdem.adapters.packing import make_packing
from crossdem.adapters.run_folder import prepare
from crossdem.adapters.schedule import Schedule

ENGINE = Liggghts()
NUMBER_LINE = re.compile(r"variable [a-z_]+ string (-?\d+(\.\d+)?(e[+-]\d+)?|on|off)")


def inputs(case, packing, folder):
    prepare(case, packing, ENGINE, folder)
    return folder / "inputs"


def numbers(case, packing, folder):
    lines = (inputs(case, packing, folder) / "numbers.in").read_text().splitlines()
    return dict(line.split()[1::2] for line in lines)


def test_no_text_of_the_case_reaches_the_deck(packing, tmp_path):
    hostile = small_case('title="x\\nshell touch pwned\\n"', 'name="print_me"')
    folder = inputs(hostile, packing, tmp_path / "run")
    for path in folder.iterdir():
        if not path.name.startswith(("case", "packing")):
            assert "pwned" not in path.read_text() and "print_me" not in path.read_text()
    for line in (folder / "numbers.in").read_text().splitlines():
        assert NUMBER_LINE.fullmatch(line), line
    assert (folder / ENGINE.script.name).read_bytes() == ENGINE.script.read_bytes()


@pytest.mark.parametrize("value", [float("nan"), float("inf"), "1; shell ls"])
def test_what_is_not_a_finite_number_is_refused(case, packing, tmp_path, value):
    spoilt = Case.from_resolved(case.resolved | {"gravity_m_s2": value})
    with pytest.raises((ValueError, TypeError)):
        inputs(spoilt, packing, tmp_path / "run")


def test_pairs_and_walls_have_their_own_law(packing, tmp_path):
    case = small_case(
        "contact.particle_particle.friction=0.5",
        "contact.particle_wall.friction=0.1",
        "contact.particle_wall.normal_stiffness_N_m=1500.0",
        "contact.particle_wall.shear_damping_N_s_m=0.2",
    )
    found = {
        name: float(text)
        for name, text in numbers(case, packing, tmp_path / "run").items()
        if text != "off"
    }
    assert (found["friction_particle"], found["friction_wall"]) == (0.5, 0.1)
    assert (found["kn_particle"], found["kn_wall"]) == (1000.0, 1500.0)
    assert (found["gammat_particle"], found["gammat_wall"]) == (0.387, 0.2)
    assert found["kt_wall"] == 250.0


def test_attraction_is_allowed_or_clipped_as_the_case_reads_the_paper(packing, tmp_path):
    assert numbers(small_case(), packing, tmp_path / "1")["limit_force"] == "off"
    clipped = small_case('scheme.attraction="clipped"')
    assert numbers(clipped, packing, tmp_path / "2")["limit_force"] == "on"


def test_only_a_case_that_resists_rolling_has_another_deck(packing, tmp_path):
    plain, rolling = (
        inputs(small_case(*changes), packing, tmp_path / name)
        for name, changes in (
            ("plain", ()),
            ("rolling", ("contact.particle_particle.rolling_friction=0.3",)),
        )
    )
    more = {path.name for path in rolling.iterdir()} - {path.name for path in plain.iterdir()}
    assert more == {"liggghts_rolling.in"}
    for name in ("liggghts_case.in", "liggghts_bars_1.in"):
        before, after = (folder.joinpath(name).read_text() for folder in (plain, rolling))
        assert "epsd2" not in before
        models = after.count("hooke/stiffness tangential history rolling_friction epsd2 ")
        assert models == before.count("hooke/stiffness tangential history ") > 0
    added = set((rolling / "numbers.in").read_text().splitlines())
    added -= set((plain / "numbers.in").read_text().splitlines())
    assert added == {
        "variable rolling_particle string 0.29999999999999999",
        "variable rolling_wall string 0",
    }


def test_a_joint_that_carries_tension_is_not_comparable():
    case = small_case("contact.particle_particle.tensile_strength_N=0.1")
    [reason] = ENGINE.unsupported(case)
    assert reason.startswith("contact.particle_particle.tensile_strength_N: ")
    resists_rolling = small_case("contact.particle_wall.rolling_friction=0.1")
    assert ENGINE.unsupported(resists_rolling) == []
    assert any("resists rolling" in line for line in ENGINE.limitations(resists_rolling))


def test_discs_are_handed_over_to_the_last_digit(case, packing, tmp_path):
    lines = (inputs(case, packing, tmp_path / "run") / "particles.data").read_text().splitlines()
    rows = [
        line.split() for line in lines[lines.index("Atoms") + 2 : lines.index("Velocities") - 1]
    ]
    table = packing.particles
    assert [float(row[4]) for row in rows] == list(table["x_m"])
    assert [float(row[5]) for row in rows] == list(table["y_m"])
    assert [float(row[2]) for row in rows] == list(2 * table["radius_m"])
    assert {float(row[3]) for row in rows} == {
        1530.0 * 0.01
    }  # per area: times pi r^2 it is the disc's mass


def test_the_bar_ends_with_its_bottom_face_which_then_owns_the_corners(case, packing, tmp_path):
    text = (inputs(case, packing, tmp_path / "run") / "bar.stl").read_text()
    normals = [line.split()[2:] for line in text.splitlines() if line.startswith("facet")]
    assert normals == [["-1", "0", "0"]] * 2 + [["1", "0", "0"]] * 2 + [["0", "-1", "0"]] * 2


def test_discs_start_with_their_velocity_and_spin(tmp_path):
    disc = Disc(0.01, 0.03, velocity_x=0.1, velocity_y=-1 / 3, spin=7.0)
    case = few_particles([disc], tmp_path)
    folder = inputs(case, make_packing(case, 1, tmp_path / "packing"), tmp_path / "run")
    last = (folder / "particles.data").read_text().splitlines()[-1].split()
    assert [float(text) for text in last] == [1, 0.1, -1 / 3, 0, 0, 0, 7.0]


@pytest.mark.parametrize("bars", [0, 1])
def test_the_deck_includes_what_the_case_has(tmp_path, bars):
    case = few_particles([Disc(0.01, 0.03)], tmp_path, bar_tip_m=0.04 if bars else None)
    packing = make_packing(case, 1, tmp_path / "packing")
    folder = inputs(case, packing, tmp_path / "run")
    assert numbers(case, packing, tmp_path / "again")["bars"] == str(bars)
    assert (folder / f"liggghts_bars_{bars}.in").exists() and (folder / "bar.stl").exists() == bars
    assert not (folder / f"liggghts_bars_{1 - bars}.in").exists()


def test_its_own_integrator_and_the_papers_are_two_engines_of_one_deck(case, packing, tmp_path):
    averaged = LiggghtsAveraged()
    prepare(case, packing, averaged, tmp_path / "averaged")
    folder = tmp_path / "averaged" / "inputs"
    assert "variable averaged string 1\n" in (folder / "numbers.in").read_text()
    assert (folder / "liggghts_averaged_1.in").exists()
    assert numbers(case, packing, tmp_path / "run")["averaged"] == "0"
    assert averaged.schedule(case).step_s == 1e-4 and ENGINE.schedule(case).step_s == 5e-5
    assert averaged.digest() == ENGINE.digest()  # of all files, whatever is included
    assert "set after every step" in averaged.limitations(case)[0]


def test_few_discs_lie_in_one_bin_and_many_in_bins_of_liggghts_own(case, packing, tmp_path):
    assert float(numbers(case, packing, tmp_path / "few")["bin_m"]) > 2 * 0.06
    many = replace(packing, particles=pd.concat([packing.particles] * 126, ignore_index=True))
    text = liggghts_input.numbers(case.resolved, ENGINE.schedule(case), many, False)
    assert "variable bin_m string 0\n" in text


@pytest.mark.parametrize("rest_s", [0.3, 0.305, 0.00005])
def test_the_bar_starts_at_a_step_of_samples_and_frames_whatever_the_rest(
    packing, tmp_path, rest_s
):
    averaged = [f"engines.{code}-averaged.step_s=5e-5" for code in ("liggghts", "yade")]
    case = small_case(f"time.rest_s={rest_s}", "time.step_s=5e-5", *averaged)
    found = {
        name: int(text)
        for name, text in numbers(case, packing, tmp_path / "run").items()
        if "step" in name and name != "step_s"
    }
    schedule = Schedule.of(case.resolved, 5e-5)
    assert found["start_step"] - found["first_step"] == round(rest_s / 5e-5)
    assert found["first_step"] + found["steps"] - found["start_step"] == schedule.penetration
    assert found["first_step"] >= 0
    assert found["start_step"] % schedule.sample == found["start_step"] % schedule.frame == 0


def test_a_bar_without_corners_is_beyond_it():
    assert "faces_only" in ENGINE.unsupported(small_case('scheme.bar_corner="faces_only"'))[0]
    assert ENGINE.unsupported(small_case()) == []


def test_it_says_what_it_cannot_express(case):
    said = " ".join(ENGINE.limitations(case))
    assert "Eq (9)" in said and "Eqs (19)-(24)" in said and "Eq (5)" in said
    assert "Eq (5)" not in " ".join(
        ENGINE.limitations(small_case('scheme.normal_spring="overlap"'))
    )


def test_the_last_error_of_its_log_is_its_complaint():
    log = "Reading\nERROR on proc 0: Cannot open file (read_data.cpp:12)\n"
    assert ENGINE.complaint(log) == "Cannot open file"
    assert ENGINE.complaint("all is well\n") is None
