"""That the native schemes do what LIGGGHTS and YADE do: the same trajectories, in whole runs of the real engines.

A limit of 0 asks for the same bits. Where it is above, the sums of forces are in another order: YADE keeps many
particles' contacts in the order in which its collider finds them, and which particle of a pair it takes for the first
follows from that.
"""

import numpy as np
import pytest
from few_particles import Disc, few_particles, heap, top_of
from small_case import REFERENCE_CASE

from crossdem.adapters.case import load_case
from crossdem.adapters.dataset import Dataset
from crossdem.adapters.engines import get_engine
from crossdem.adapters.packing import make_packing
from crossdem.adapters.run import RunRequest, run_all
from crossdem.compare.twin_schemes import TWIN_SCHEMES, native_twin, native_twin_or_why

WIDTH_M = 0.02
CLOSE = ("time.frame_interval_s=0.001",)
FREE = (*CLOSE, "gravity_m_s2=0.0", "container.width_m=0.04")


def one_dropped(folder):
    disc = Disc(0.008, 0.012, velocity_x=0.3, spin=-40.0)
    return few_particles([disc], folder, *CLOSE, "time.penetration_s=0.3")


def head_on(folder):
    pair = [Disc(0.015, 0.03, velocity_x=0.2), Disc(0.022, 0.03, 0.002, velocity_x=-0.3)]
    return few_particles(pair, folder, *FREE)


def oblique(folder):
    pair = [
        Disc(0.015, 0.030, velocity_x=0.2, velocity_y=0.05, spin=15.0),
        Disc(0.0205, 0.0315, 0.002, velocity_x=-0.2, spin=-40.0),
    ]
    return few_particles(pair, folder, *FREE)


def wall_to_wall(folder):
    """Into a side wall and the floor, sliding and sticking; hardly damped, so that it bounces."""
    damping = [
        f"contact.particle_wall.{key}_damping_N_s_m={value}"
        for key, value in (("normal", 0.1), ("shear", 0.05))
    ]
    disc = Disc(0.016, 0.006, velocity_x=0.4, velocity_y=-0.3, spin=60.0)
    return few_particles([disc], folder, *CLOSE, *damping, "time.penetration_s=0.3")


def stiff_walls(folder):
    """Walls more than twice as stiff as particles, and damping of walls alone: YADE has them in series."""
    changes = (
        "contact.particle_wall.normal_stiffness_N_m=3000.0",
        "contact.particle_particle.normal_damping_N_s_m=0.0",
        "contact.particle_particle.shear_damping_N_s_m=0.0",
    )
    disc = Disc(0.008, 0.006, velocity_x=0.1, spin=10.0)
    return few_particles([disc], folder, *CLOSE, *changes, "time.penetration_s=0.1")


def under_the_bar(folder):
    """Pressed by the bar's corner from the first evaluation on."""
    disc = Disc(0.0135, 0.004)
    return few_particles([disc], folder, *CLOSE, "time.penetration_s=0.02", bar_tip_m=0.006)


def thrown_up(folder):
    """Far beyond the container, which has no lid, and spinning by many turns between two frames."""
    disc = Disc(0.01, 0.03, velocity_y=2.0, spin=4000.0)
    return few_particles([disc], folder, *FREE)


def five_in_a_box(folder):
    return few_particles(heap(5, WIDTH_M, seed=2), folder, *CLOSE, "time.penetration_s=0.5")


def bar_and_24(folder):
    discs = heap(24, WIDTH_M, seed=3)
    way = ("time.penetration_s=0.1", "bar.centre_x_m=0.009")
    return few_particles(discs, folder, *CLOSE, *way, bar_tip_m=top_of(discs))


ROLLING = (
    "contact.particle_particle.rolling_friction=0.2",
    "contact.particle_wall.rolling_friction=0.1",
)


def five_that_resist_rolling(folder):
    discs = heap(5, WIDTH_M, seed=2)
    return few_particles(discs, folder, *CLOSE, *ROLLING, "time.penetration_s=0.5")


def bar_and_24_that_resist_rolling(folder):
    discs = heap(24, WIDTH_M, seed=3)
    way = ("time.penetration_s=0.1", "bar.centre_x_m=0.009")
    return few_particles(discs, folder, *CLOSE, *ROLLING, *way, bar_tip_m=top_of(discs))


def rocking_across_the_bars_face(folder):
    """Between floor and bar, from one triangle of the bar's bottom face to the other, its rolling spring wound up."""
    smooth = ("contact.particle_wall.friction=0.0", "bar.speed_m_s=0.001")
    disc = Disc(0.0085, 0.0025, velocity_x=0.03, spin=1.0)
    return few_particles([disc], folder, *CLOSE, *ROLLING, *smooth, bar_tip_m=0.00498)


def whole_bed(folder):
    changes = ("time.rest_s=0.0", "time.penetration_s=0.1", "time.frame_interval_s=0.01")
    return load_case(REFERENCE_CASE, changes)


# The largest difference of a position [m] in any frame, by case and engine; 0: the same bits.
LIMITS_M = {
    one_dropped: {},
    head_on: {},
    oblique: {},
    wall_to_wall: {},
    stiff_walls: {},
    under_the_bar: {},
    thrown_up: {},
    five_in_a_box: {},
    bar_and_24: {},
    five_that_resist_rolling: {},
    bar_and_24_that_resist_rolling: {},
    rocking_across_the_bars_face: {},
    whole_bed: {"yade": 1e-12, "yade-averaged": 1e-12},
}
RESIST_ROLLING = (
    five_that_resist_rolling,
    bar_and_24_that_resist_rolling,
    rocking_across_the_bars_face,
)


@pytest.fixture(params=list(TWIN_SCHEMES))
def engine_name(request, required):
    return required(request.param).name


def twins(case, engine_name, folder):
    """The engine's run, and that of its native twin."""
    packing = make_packing(case, 1, folder / "packing")
    requests = [
        RunRequest(case, packing, engine_name),
        RunRequest(native_twin(case, engine_name), packing, "native"),
    ]
    results = run_all(requests, folder / "out", 1)
    assert [result.failure for result in results] == [None, None]
    return [Dataset.read(result.dataset_folder) for result in results]


def parting(engine, native):
    """The largest differences in any frame or sample, by what differs."""
    of = {
        "position_m": lambda run: run.motion.position_m,
        "velocity_m_s": lambda run: run.motion.velocity_m_s,
        "angular_velocity_rad_s": lambda run: run.motion.angular_velocity_rad_s,
        "bar_force_N": lambda run: run.resistance["force_y_N"].to_numpy(),
        "sideways_force_N": lambda run: run.resistance["force_x_N"].to_numpy(),
        "tip_force_N": lambda run: run.resistance["tip_force_y_N"].to_numpy(),
        "contacts": lambda run: run.resistance["contacts"].to_numpy(),
        "floor_force_N": lambda run: run.resistance["floor_force_y_N"].to_numpy(),
    }
    return {
        name: float(np.max(np.abs(values(engine) - values(native)))) for name, values in of.items()
    }


@pytest.mark.parametrize("case_of", LIMITS_M, ids=lambda case_of: case_of.__name__)
def test_the_native_scheme_of_its_name_moves_every_particle_alike(case_of, engine_name, tmp_path):
    case = case_of(tmp_path)
    if case_of in RESIST_ROLLING and engine_name.startswith("yade"):
        assert isinstance(native_twin_or_why(case, engine_name), str)
        return
    engine, native = twins(case, engine_name, tmp_path)
    parted, step_s = parting(engine, native), get_engine(engine_name).step_s(case)
    print(f"{case_of.__name__}, {engine_name}: {parted}")
    limit_m = LIMITS_M[case_of].get(engine_name, 0.0)
    assert parted["position_m"] <= limit_m, parted
    assert parted["velocity_m_s"] * step_s <= limit_m, parted
    assert parted["angular_velocity_rad_s"] * step_s * engine.radius_m.max() <= limit_m, parted
    # Sums over all contacts, here in the order of the particles and there in that of the contacts.
    forces_N = [value for name, value in parted.items() if name.endswith("_N")]
    assert max(forces_N) <= 1e-12 + 1000 * limit_m, parted
    assert parted["contacts"] == 0, parted
    if engine.motion.angle_rad is not None:
        assert engine.motion.angle_rad == pytest.approx(native.motion.angle_rad, rel=1e-9, abs=1e-9)
