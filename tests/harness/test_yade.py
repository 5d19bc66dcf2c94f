"""The input that YADE gets, and how its output is read."""

import numpy as np
import pytest
from small_case import small_case

from crossdem.adapters.engine import EngineFailure
from crossdem.adapters.run_folder import prepare
from crossdem.adapters.yade import Yade, YadeAveraged

ENGINE = Yade()
COLUMNS = "step,force_x_N,force_y_N,tip_force_y_N,shaft_force_y_N,floor_force_y_N,contacts,kinetic_energy_J"


def test_it_reads_the_case_and_the_packing_as_they_are(case, packing, tmp_path):
    prepare(case, packing, ENGINE, tmp_path / "run")
    inputs = tmp_path / "run" / "inputs"
    assert (inputs / "case.json").read_bytes() == case.canonical
    assert (inputs / "packing.csv").read_bytes() == (packing.folder / "packing.csv").read_bytes()
    for script in (ENGINE.script, ENGINE.memory_script):
        assert (inputs / script.name).read_bytes() == script.read_bytes()


def test_the_launcher_which_opens_ports_is_not_used(case, tmp_path):
    assert ENGINE.command(case, tmp_path) == ["/usr/bin/python3", "inputs/yade_case.py", "yade"]
    assert ENGINE.environment()["OMP_NUM_THREADS"] == "1"


def test_the_papers_averaged_displacement_is_an_engine_of_the_same_script(case, tmp_path):
    averaged = YadeAveraged()
    assert averaged.command(case, tmp_path)[1:] == ["inputs/yade_case.py", "yade-averaged"]
    assert averaged.schedule(case).step_s == 1e-4 and ENGINE.schedule(case).step_s == 5e-5
    assert averaged.digest() == ENGINE.digest() != ""
    said = averaged.limitations(case)
    assert "memory force" in said[0] and not any("half a time step" in line for line in said)


def test_an_undamped_wall_beside_damped_particles_is_beyond_it():
    [reason] = ENGINE.unsupported(small_case("contact.particle_wall.shear_damping_N_s_m=0.0"))
    assert "shear_damping_N_s_m = 0" in reason
    assert ENGINE.unsupported(small_case()) == []


def test_options_beyond_the_paper_are_not_comparable():
    joints, pairs, walls = ENGINE.unsupported(
        small_case(
            "contact.particle_particle.tensile_strength_N=0.1",
            "contact.particle_particle.rolling_friction=0.1",
            "contact.particle_wall.rolling_friction=0.1",
        )
    )
    assert joints.startswith("contact.particle_particle.tensile_strength_N: ")
    assert pairs.startswith("contact.particle_particle.rolling_friction: ")
    assert walls.startswith("contact.particle_wall.rolling_friction: ")


def test_it_says_that_it_clips_attraction_unless_the_case_does(case):
    assert any("clips attraction" in line for line in ENGINE.limitations(case))
    clipped = small_case('scheme.attraction="clipped"')
    assert not any("clips attraction" in line for line in ENGINE.limitations(clipped))


@pytest.fixture
def output(case, packing, tmp_path):
    """A run's folder with whole output: particles that never move."""
    prepare(case, packing, ENGINE, tmp_path / "run")
    schedule = ENGINE.schedule(case)
    steps = range(-schedule.rest, schedule.penetration + 1, schedule.sample)
    rows = [f"{step},0.0,0.25,0.2,0.05,-2.2,70,1e-10" for step in steps]
    folder = tmp_path / "run" / "output"
    (folder / "samples.csv").write_text("\n".join([COLUMNS, *rows, ""]))
    discs = np.zeros((40, 6))
    discs[:, :2] = packing.particles[["x_m", "y_m"]]
    frames = [
        [step, packing.bar_tip_m - 0.01 * step * schedule.step_s, *discs.ravel()]
        for step in range(0, schedule.penetration + 1, schedule.frame)
    ]
    np.array(frames).tofile(folder / "frames.f64")
    return tmp_path / "run"


def manifest(case, packing):
    keys = "case_name case_hash packing_hash engine engine_version compiler started_utc run_key"
    counts = {"particles": 40, "frames": 6, "samples": 11, "limitations": [], "gates": []}
    return (
        dict.fromkeys(keys.split(), "")
        | counts
        | {"schema_version": 1, "seed": 1, "twin": 0, "time_step_s": 5e-5}
        | {"command": [], "wall_s": 1.0, "cpu_s": 1.0}
    )


def read(case, packing, folder):
    return ENGINE.read_output(case, packing, folder, manifest(case, packing))


def test_whole_output_becomes_a_dataset_without_the_rest(case, packing, output):
    run = read(case, packing, output)
    assert list(run.resistance["time_s"]) == pytest.approx(np.arange(11) * 0.01)
    assert run.motion.position_m.shape == (6, 40, 2)
    assert len((output / "output" / "samples.csv").read_text().splitlines()) == ENGINE.lines_in_all(
        case
    )


@pytest.mark.parametrize(
    "name, cut, message", [("frames.f64", 8, "5 of 6 frames"), ("samples.csv", 20, "samples")]
)
def test_torn_output_is_a_failure(case, packing, output, name, cut, message):
    path = output / "output" / name
    path.write_bytes(path.read_bytes()[:-cut])
    with pytest.raises(EngineFailure, match=message):
        read(case, packing, output)


@pytest.mark.parametrize("name", ["frames.f64", "samples.csv"])
def test_absent_output_is_a_failure(case, packing, output, name):
    (output / "output" / name).unlink()
    with pytest.raises(EngineFailure, match=f"no readable {name}"):
        read(case, packing, output)
