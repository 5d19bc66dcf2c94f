"""Bad input: each kind ends with exit code 2, a message that names the place, and nothing written."""

import os
import re

import pytest
from command_line import REFERENCE, crossdem

from crossdem.adapters.solver import find_solver


@pytest.fixture
def refused(tmp_path):
    """A function that has `crossdem check` refuse a case, and returns what it says."""

    def check(case_file, *options):
        out = tmp_path / "out"
        ended = crossdem("check", case_file, "--out", out, *options, cwd=tmp_path)
        assert ended.returncode == 2, ended.stderr
        assert ended.stdout == ""
        assert "Traceback" not in ended.stderr
        assert not out.exists()
        return ended.stderr

    return check


@pytest.fixture
def write(tmp_path):
    """A function that writes the reference case with one piece of its text replaced."""

    def replaced(old="", new="", count=1):
        text = REFERENCE.read_text()
        assert old in text
        case_file = tmp_path / "case.toml"
        case_file.write_text(text.replace(old, new, count))
        return case_file

    return replaced


def test_every_fault_is_told_in_one_go_with_file_and_key_path(refused, write):
    case_file = write()
    text = case_file.read_text()
    text = text.replace("speed_m_s = 0.01", "speed_m_s = -0.01").replace("count = 944", "count = 0")
    text = text.replace("[marks]", "[marks]\nextra = 1")
    case_file.write_text(text.replace("friction = 0.75", 'friction = "rough"'))
    said = refused(case_file).splitlines()
    keys = {line.removeprefix(f"{case_file}: ").split(":")[0] for line in said}
    assert keys >= {
        "bar.speed_m_s",
        "particles.count",
        "contact.particle_particle.friction",
        "marks.extra",
    }


def test_an_unknown_key(refused, write):
    assert "case.toml: bar.sped_m_s: " in refused(write("speed_m_s", "sped_m_s"))


def test_a_bed_without_a_bar_has_nothing_to_compare(refused, write):
    case_file = write()
    text = re.sub(r"\[bar\]\n(?:.+\n)+", "", case_file.read_text())
    case_file.write_text(text)
    assert "case.toml: bar: there is no bar, whose resistance is compared" in refused(case_file)


def test_a_missing_key(refused, write):
    said = refused(write("density_kg_m3 = 1530.0", ""))
    assert "case.toml: particles.density_kg_m3: " in said


@pytest.mark.parametrize("value", ['"fast"', "true", "[1.0]", "{}"])
def test_a_wrong_type(refused, value):
    assert "bar.speed_m_s: " in refused(REFERENCE, "--set", f"bar.speed_m_s={value}")


@pytest.mark.parametrize("value", ["-0.01", "nan", "inf", "-inf", "1e400"])
def test_a_negative_or_non_finite_number(refused, value):
    assert "bar.speed_m_s: " in refused(REFERENCE, "--set", f"bar.speed_m_s={value}")


def test_what_only_the_harness_knows_is_told_in_the_same_go(refused):
    overrides = [
        "check[0].quantity=mean_resistence_N",
        "engines.yaed.step_s=5e-5",
        "bar.width_m=-1",
    ]
    said = refused(REFERENCE, *(word for text in overrides for word in ("--set", text)))
    for fault in (
        "check[0].quantity: unknown quantity 'mean_resistence_N'; did you mean 'mean_resistance_N'?",
        "engines.yaed: no such engine; known: liggghts, yade",
        "bar.width_m: must be above 0",
    ):
        assert f"bar_penetration.toml: {fault}" in said


def test_a_time_step_for_the_native_solver_beside_its_own(refused):
    said = refused(REFERENCE, "--set", "engines.native.step_s=5e-5")
    assert "engines.native: its time step is time.step_s" in said


@pytest.mark.parametrize("check", ["5", "[5]", '[{quantity = 5, kind = "ratio", margin = "x"}]'])
def test_checks_that_are_no_checks(refused, check):
    assert "bar_penetration.toml: check" in refused(REFERENCE, "--set", f"check={check}")


def test_a_bar_wider_than_the_box(refused):
    said = refused(REFERENCE, "--set", "bar.width_m=0.2")
    assert "bar.width_m: " in said and "0.15" in said


def test_no_particles(refused):
    assert "particles.count: " in refused(REFERENCE, "--set", "particles.count=0")


def test_a_time_step_above_eq_32(refused):
    said = refused(REFERENCE, "--set", "time.step_s=1e-3", "--set", "time.frame_interval_s=0.1")
    assert "time.step_s: " in said and "32" in said


def test_a_bed_that_does_not_fit(refused):
    said = refused(REFERENCE, "--set", "particles.count=2000")
    assert "particles.count: " in said and "does not fit" in said


def test_a_check_of_no_known_quantity(refused, write):
    case_file = write()
    check = (
        'quantity = "colour"\nmargin = 0.1\nseed_scatter = 0.1\nkind = "relative"\nreason = "none"'
    )
    case_file.write_text(f"{case_file.read_text()}\n[[check]]\n{check}\n")
    said = refused(case_file)
    assert re.search(r"case\.toml: check\[\d+\]\.quantity: unknown quantity 'colour'", said)


def test_text_that_is_not_toml_is_told_with_line_and_column(refused, write):
    said = refused(write("schema_version = 1", "schema_version = "))
    assert re.search(r"case\.toml:\d+:18: not valid TOML: Invalid value", said)


@pytest.mark.parametrize(
    "text, said",
    [
        ('{"name": }', ":1:10: not valid JSON: Expecting value"),
        ("[1]", ": holds no object of JSON"),
        ("[" * 100_000, ": nested too deeply"),
    ],
)
def test_a_case_of_json_that_is_none_is_told_with_line_and_column(text, said, refused, tmp_path):
    (tmp_path / "case.json").write_text(text)
    assert f"case.json{said}" in refused(tmp_path / "case.json")


def test_a_pipe_in_the_place_of_a_file_of_the_output_folder_is_not_waited_for(tmp_path):
    out = tmp_path / "out"
    out.mkdir()
    os.mkfifo(out / "crossdem.json")
    ended = crossdem("check", REFERENCE, "--out", out, timeout=60)
    assert ended.returncode == 2 and "was not made by crossdem" in ended.stderr


def test_text_that_ends_too_early_is_told_with_line_and_column(refused, tmp_path):
    case_file = tmp_path / "case.toml"
    case_file.write_text('name = "x"\nlist = [1,')
    assert "case.toml:2:11: " in refused(case_file)


def test_a_file_that_is_not_there(refused, tmp_path):
    assert "none.toml: cannot be read: No such file" in refused(tmp_path / "none.toml")


def test_a_file_that_cannot_be_read(refused):
    """This one not even by root."""
    assert "/proc/self/mem: cannot be read: Input/output error" in refused("/proc/self/mem")


def test_a_folder_without_a_case(refused, tmp_path):
    assert "holds no case (*.toml)" in refused(tmp_path)


def test_a_device_in_place_of_a_file(refused):
    assert "/dev/zero: is not an ordinary file" in refused("/dev/zero")


def test_a_100_MB_file_is_refused_unread(refused, tmp_path):
    case_file = tmp_path / "case.toml"
    with open(case_file, "wb") as file:
        file.truncate(100_000_000)
    assert "100.0 MB is too large" in refused(case_file)


def test_invalid_utf_8_is_told_with_line_and_column(refused, tmp_path):
    case_file = tmp_path / "case.toml"
    case_file.write_bytes(b'name = "x"\ntitle = "\xe9t\xff"\n')
    assert "case.toml:2:10: byte 0xe9 is not UTF-8" in refused(case_file)


@pytest.mark.parametrize(
    "text",
    ["x = " + "[" * 10_000, "x = " + "9" * 10_000, "a." * 9_000 + "a=1"],
    ids=["nested", "digits", "dotted"],
)
def test_hostile_text_is_refused_in_a_sentence(refused, tmp_path, text):
    case_file = tmp_path / "case.toml"
    case_file.write_text(text)
    assert "case.toml" in refused(case_file)


def test_an_override_without_a_value(refused):
    assert "--set bar.width_m: has no '='" in refused(REFERENCE, "--set", "bar.width_m")


def test_an_override_of_no_known_key(refused):
    assert "bar.colour: " in refused(REFERENCE, "--set", "bar.colour=red")


def test_an_unknown_engine_names_the_known_ones(refused):
    assert "native, liggghts, yade" in refused(REFERENCE, "--engines", "native,abaqus")


def test_no_seeds(refused):
    assert "--seeds" in refused(REFERENCE, "--seeds", "0")


def test_an_output_folder_that_is_not_ours_is_left_as_it_is(tmp_path):
    (tmp_path / "thesis.txt").write_text("years of work")
    ended = crossdem("check", REFERENCE, "--out", tmp_path)
    assert ended.returncode == 2
    assert "was not made by crossdem" in ended.stderr
    assert [path.name for path in tmp_path.iterdir()] == ["thesis.txt"]


def test_an_output_folder_that_is_a_file_is_left_as_it_is(tmp_path):
    place = tmp_path / "out"
    place.write_text("a file")
    ended = crossdem("check", REFERENCE, "--out", place)
    assert ended.returncode == 2
    assert "is not a folder" in ended.stderr
    assert place.read_text() == "a file"


@pytest.mark.parametrize("place", ["/proc/none/out", "file/out", "new/" + "x" * 300])
def test_an_output_folder_that_cannot_be_written(tmp_path, place):
    (tmp_path / "file").write_text("")
    ended = crossdem("check", REFERENCE, "--out", place, cwd=tmp_path)
    assert ended.returncode == 2
    assert "cannot be written" in ended.stderr
    assert [path.name for path in tmp_path.iterdir()] == ["file"]


@pytest.mark.parametrize("place", ["/proc/none/records", "file/records", "new/" + "x" * 300])
def test_a_folder_of_records_that_cannot_be_written_is_told_before_anything_runs(tmp_path, place):
    (tmp_path / "file").write_text("")
    ended = crossdem("record", REFERENCE, "--engines", "native", "--record", place, cwd=tmp_path)
    assert ended.returncode == 2
    assert "cannot be written" in ended.stderr and "--record" in ended.stderr
    assert [path.name for path in tmp_path.iterdir()] == ["file"]


def test_a_variant_that_would_be_recorded_elsewhere(tmp_path):
    ended = crossdem("record", REFERENCE, "--variant", 'title="../mine"', cwd=tmp_path)
    assert ended.returncode == 2
    assert "--variant title=" in ended.stderr and "leave out the /" in ended.stderr
    assert not any(tmp_path.iterdir())


@pytest.mark.parametrize(
    "option",
    [("--replay",), ("--profile", "slurm"), ("--mpi-ranks", "2")],
    ids=lambda words: words[0],
)
@pytest.mark.parametrize("of", ["a folder", "one case"])
def test_an_option_for_beds_on_the_ladder(refused, option, of):
    ladder = REFERENCE.parent / "micro"
    said = refused(ladder if of == "a folder" else ladder / "free_fall.toml", *option)
    assert f"{option[0]}: not for cases of particles placed by hand" in said


@pytest.mark.parametrize("exists", [False, True])
def test_a_fault_that_shows_only_while_settling_leaves_nothing(tmp_path, exists):
    solver = tmp_path / "solver"
    refuse = f'[ "$1" = pack ] && {{ echo "case: packing: a fault" >&2; exit 2; }}'
    solver.write_text(f'#!/bin/sh\n{refuse}\nexec {find_solver()} "$@"\n')
    solver.chmod(0o755)
    out = tmp_path / "new" / "out"
    if exists:
        out.mkdir(parents=True)
    ended = crossdem("check", REFERENCE, "--out", out, CROSSDEM_SOLVER=str(solver))
    assert ended.returncode == 2
    assert ended.stderr == "case: packing: a fault\n"
    assert not any(out.iterdir()) if exists else not out.parent.exists()


def test_a_fault_of_one_bed_takes_the_other_beds_along(tmp_path):
    solver = tmp_path / "solver"
    refuse = '[ "$3" = --seed=2 ] && { sleep 3; echo "case: packing: a fault" >&2; exit 2; }'
    solver.write_text(f'#!/bin/sh\n{refuse}\nexec {find_solver()} "$@"\n')
    solver.chmod(0o755)
    out = tmp_path / "out"
    ended = crossdem("check", REFERENCE, "--out", out, CROSSDEM_SOLVER=str(solver))
    assert ended.returncode == 2 and "a fault" in ended.stderr
    assert not out.exists()


def test_a_folder_that_is_no_dataset(tmp_path):
    ended = crossdem("compare", tmp_path, cwd=tmp_path)
    assert ended.returncode == 2
    assert str(tmp_path) in ended.stderr
    assert not any(tmp_path.iterdir())
