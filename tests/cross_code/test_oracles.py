"""Oracles without a reference: what must not matter to a run, and what must, each seen in every engine."""

from dataclasses import replace

import numpy as np
import pytest
from few_particles import Disc, few_particles, heap, top_of
from units import in_units

from crossdem.adapters.case import Case
from crossdem.adapters.dataset import Dataset
from crossdem.adapters.packing import make_packing
from crossdem.adapters.run import RunRequest, run_all

# A heap of discs of both sizes falls into a narrow box while the bar comes in.
WIDTH_M = 0.02
BAR_X_M = 0.009  # off the middle: a mirrored heap has its bar elsewhere
HEAP = heap(12, WIDTH_M, seed=5)
BAR_TIP_M = top_of(HEAP) + 1e-4  # so that rounding does not decide whether it touches them
HEAP_CASE = (f"bar.centre_x_m={BAR_X_M}", "time.penetration_s=0.06")
# Runs that differ in the order of their sums part by rounding, 1e-17 m, which a heap makes tenfold about every 30 ms.
ROUNDING_M, ROUNDING_N = 1e-12, 1e-9

# Two discs that meet in free flight, at an angle and turning, out of reach of the walls.
PAIR = [
    Disc(0.020, 0.020, 0.0025, velocity_x=0.2, velocity_y=0.05, spin=15.0),
    Disc(0.0255, 0.0215, 0.002, velocity_x=-0.2, velocity_y=0.0, spin=-40.0),
]
FREE_FLIGHT = ("gravity_m_s2=0.0", "container.width_m=0.06", "time.penetration_s=0.03")


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """One for all tests: what one has run the next need not run again."""
    return tmp_path_factory.mktemp("oracles")


@pytest.fixture
def run(engine, folder):
    """Runs cases in the engine, to their datasets."""

    def run_cases(*cases: Case) -> list[Dataset]:
        packings = [make_packing(case, 1, folder / "packings" / case.hash) for case in cases]
        requests = [RunRequest(*pair, engine.name) for pair in zip(cases, packings)]
        results = run_all(requests, folder / "out", 2)
        assert [result.failure for result in results] == [None] * len(results)
        return [Dataset.read(result.dataset_folder) for result in results]

    return run_cases


@pytest.fixture
def heap_case(tmp_path):
    """The heap under the bar, with any changes."""

    def case_of(*overrides: str, discs=HEAP) -> Case:
        return few_particles(discs, tmp_path, *HEAP_CASE, *overrides, bar_tip_m=BAR_TIP_M)

    return case_of


def largest_difference(one, other) -> float:
    return float(np.max(np.abs(one - other)))


def test_a_mirrored_heap_moves_as_the_mirror_image(run, heap_case):
    mirrored = [
        replace(disc, x=WIDTH_M - disc.x, velocity_x=-disc.velocity_x, spin=-disc.spin)
        for disc in HEAP
    ]
    image_case = heap_case(f"bar.centre_x_m={WIDTH_M - BAR_X_M}", discs=mirrored)
    heap_run, image = run(heap_case(), image_case)
    image_m = image.motion.position_m * [-1, 1] + [WIDTH_M, 0]
    assert largest_difference(heap_run.motion.position_m, image_m) < ROUNDING_M
    for column, sign in (("force_x_N", -1), ("force_y_N", 1), ("floor_force_y_N", 1)):
        mirrored_N = sign * image.resistance[column]
        assert largest_difference(heap_run.resistance[column], mirrored_N) < ROUNDING_N, column
    assert heap_run.resistance["force_y_N"].max() > 0.01  # there is something to mirror


def test_it_does_not_matter_which_particle_is_which(run, heap_case):
    order = np.random.default_rng(1).permutation(len(HEAP))
    heap_run, other = run(heap_case(), heap_case(discs=[HEAP[old] for old in order]))
    same_m = heap_run.motion.position_m[:, order]
    assert largest_difference(other.motion.position_m, same_m) < ROUNDING_M
    forces_N = heap_run.resistance["force_y_N"], other.resistance["force_y_N"]
    assert largest_difference(*forces_N) < ROUNDING_N


@pytest.mark.parametrize(
    "length, mass, tolerance_m, tolerance_N",
    [
        pytest.param(100.0, 1000.0, ROUNDING_M, ROUNDING_N, id="cm, g, s"),
        # round nothing; but LIGGGHTS writes forces with 15 digits
        pytest.param(128.0, 1024.0, 0.0, 1e-14, id="powers of two"),
    ],
)
def test_units_do_not_matter(run, heap_case, length, mass, tolerance_m, tolerance_N):
    heap_run, other = run(heap_case(), in_units(heap_case(), length, mass))
    in_metres = other.motion.position_m / length
    assert largest_difference(heap_run.motion.position_m, in_metres) <= tolerance_m
    in_newtons = other.resistance["force_y_N"] / (mass * length)
    assert largest_difference(heap_run.resistance["force_y_N"], in_newtons) <= tolerance_N


def test_how_often_output_is_written_changes_no_bit(run, heap_case):
    seldom = heap_case("time.sample_interval_s=0.06", "time.frame_interval_s=0.06")
    often_run, seldom_run = run(heap_case(), seldom)
    for name in ("position_m", "velocity_m_s", "angular_velocity_rad_s"):
        last = getattr(often_run.motion, name)[-1], getattr(seldom_run.motion, name)[-1]
        assert np.array_equal(*last), name
    assert often_run.resistance.iloc[-1].equals(seldom_run.resistance.iloc[-1])


def test_a_moving_frame_sees_the_same_collision(run, tmp_path):
    seen_from = np.array([0.1, 0.05])  # m/s
    moving = [
        replace(disc, velocity_x=disc.velocity_x + 0.1, velocity_y=disc.velocity_y + 0.05)
        for disc in PAIR
    ]
    still, shifted = run(
        *[few_particles(discs, tmp_path, *FREE_FLIGHT) for discs in (PAIR, moving)]
    )
    way_m = seen_from * still.motion.time_s[:, np.newaxis, np.newaxis]
    # rounding of the sums alone: there is no chaos in a single collision
    assert largest_difference(still.motion.position_m + way_m, shifted.motion.position_m) < 1e-13
    turning = still.motion.angular_velocity_rad_s
    assert largest_difference(turning, shifted.motion.angular_velocity_rad_s) < 1e-9
    assert abs(turning[-1] - turning[0]).min() > 1  # they have met


def test_half_the_bars_speed_leaves_the_slope(run, tmp_path):
    # Two discs on three, wedged between the side walls: the bar presses them down, so slowly that springs and sliding
    # friction alone resist. The dashpots add a force of 2 mN at the most, which does not grow with depth.
    width_m, radius_m = 0.0149, 0.0025
    bottom = [Disc(x, radius_m) for x in (radius_m, width_m / 2, width_m - radius_m)]
    spacing_m = width_m / 2 - radius_m
    height_m = radius_m + (4 * radius_m**2 - spacing_m**2 / 4) ** 0.5
    upper = [Disc(width_m / 2 + side * spacing_m / 2, height_m) for side in (-1, 1)]
    discs = bottom + upper

    def at_speed(speed_m_s):
        overrides = (
            f"container.width_m={width_m}",
            f"bar.centre_x_m={width_m / 2}",
            f"bar.speed_m_s={speed_m_s}",
            f"time.penetration_s={2e-4 / speed_m_s}",
            "time.rest_s=0.1",
        )
        return few_particles(discs, tmp_path, *overrides, bar_tip_m=top_of(discs))

    def slope_N_m(dataset):
        table = dataset.resistance[dataset.resistance["depth_m"] >= 1e-4 - 1e-9]
        return np.polyfit(table["depth_m"], table["force_y_N"], 1)[0]

    fast, slow = run(at_speed(0.002), at_speed(0.001))
    assert slope_N_m(fast) > 300
    assert slope_N_m(fast) == pytest.approx(slope_N_m(slow), rel=1e-4)


def test_the_rougher_the_bar_the_harder_it_slides(run, tmp_path):
    # One disc in the corner of floor and left wall, pressed there by the side of the bar that slides down along it.
    radius_m, squeezed_m = 0.0025, 1e-4
    disc = Disc(radius_m - squeezed_m / 2, radius_m)
    overrides = (
        f"bar.centre_x_m={2 * radius_m - squeezed_m + 0.003}",
        "bar.speed_m_s=0.005",
        "time.rest_s=0.02",
    )
    frictions = (0.0, 0.25, 0.75)
    cases = [
        few_particles(
            [disc],
            tmp_path,
            *overrides,
            f"contact.particle_wall.friction={friction}",
            bar_tip_m=0.0015,
        )
        for friction in frictions
    ]
    tables = [dataset.resistance for dataset in run(*cases)]
    force_N = [table["force_y_N"][table["time_s"] > 0.05].mean() for table in tables]
    assert abs(force_N[0]) < 1e-12
    assert (
        np.diff(force_N).min() > 0.01
    ), force_N  # squeezed by 0.05 N: 0.0125 and 0.025 N at the least


def test_a_collision_with_dashpots_never_gains_energy(run, tmp_path):
    def with_dashpots(share):
        return few_particles(
            PAIR,
            tmp_path,
            *FREE_FLIGHT,
            f"contact.particle_particle.normal_damping_N_s_m={0.774 * share}",
            f"contact.particle_particle.shear_damping_N_s_m={0.387 * share}",
            "time.step_s=2e-5",  # a fifth of the paper's, at which its scheme adds more than weak dashpots take
            "time.sample_interval_s=1e-4",
        )

    for collision in run(with_dashpots(1.0), with_dashpots(0.13)):
        energy_J = collision.resistance["kinetic_energy_J"]
        assert energy_J.max() <= energy_J[0] * (1 + 1e-12)
        assert energy_J.iloc[-1] < 0.95 * energy_J[0]


def restitution_without_dashpots(engine_name: str) -> float:
    """The paper's scheme adds energy to an undamped contact: an expected difference, which must not vanish.

    Its displacement, the mean over all steps before, lags velocity by a step. On the spring this acts as a dashpot of
    the wrong sign: exp(pi dt sqrt(k/m) / 2) = 1.33 in first order of dt, 1.31 in steps of 1e-4 s.
    """
    return 1.31 if engine_name == "native" or engine_name.endswith("-averaged") else 1.0


def test_a_contact_without_dashpots_gives_back_what_the_scheme_says(run, engine, tmp_path):
    disc = Disc(0.006, 0.02, velocity_x=-0.2)
    undamped = [
        f"contact.{kind}.{name}=0.0"
        for kind in ("particle_particle", "particle_wall")
        for name in ("normal_damping_N_s_m", "shear_damping_N_s_m", "friction")
    ]
    [bounce] = run(few_particles([disc], tmp_path, *FREE_FLIGHT, *undamped))
    found = bounce.motion.velocity_m_s[-1, 0, 0] / 0.2
    # by where in a step the contact begins it varies by 0.005
    assert found == pytest.approx(restitution_without_dashpots(engine.name), abs=0.01)
