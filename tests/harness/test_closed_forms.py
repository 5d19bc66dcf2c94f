"""Closed forms against each other, against known numbers, and against the impact that is solved piece by piece."""

import dataclasses
import math

import pytest

from crossdem.compare import closed_forms
from crossdem.compare.engine_laws import engine_law
from crossdem.compare.impact import ContactLaw, Impact, rebound

PAPER = ContactLaw()
LIGGGHTS = ContactLaw(cap_on_total=True)
YADE = ContactLaw(cap_on_total=True, clipped=True)
LAWS = (PAPER, LIGGGHTS, YADE)
MASS = 3.0041481e-4  # [kg] the paper's 5 mm disc
ETA = 0.774  # [N s/m] Table 2


def impact(**changes) -> Impact:
    """Of the paper's 5 mm disc on a wall, without damping unless said."""
    plain = Impact(
        mass=MASS,
        normal_stiffness=1000.0,
        normal_damping=0.0,
        shear_stiffness=250.0,
        shear_damping=0.0,
        friction=0.25,
        normal_speed=0.001,
    )
    return dataclasses.replace(plain, **changes)


def test_the_papers_damping_is_critical_for_an_equal_pair_and_overdamps_no_wall():
    assert closed_forms.damping_ratio(MASS / 2, 1000.0, ETA) == pytest.approx(1, abs=2e-3)
    assert closed_forms.damping_ratio(MASS, 1000.0, ETA) == pytest.approx(math.sqrt(0.5), abs=2e-3)


@pytest.mark.parametrize("zeta, allowed, clipped", [(0, 1, 1), (1, 0, math.exp(-2))])
def test_restitution_at_both_ends(zeta, allowed, clipped):
    assert closed_forms.restitution(zeta) == pytest.approx(allowed, abs=1e-15)
    assert closed_forms.restitution_clipped(zeta) == pytest.approx(clipped, rel=1e-15)


@pytest.mark.parametrize("zeta", [0.0, 0.0918, 0.5, 0.7061, 0.9])
def test_restitution_is_that_of_the_impact_solved_piece_by_piece(zeta):
    damped = impact(normal_damping=2 * zeta * math.sqrt(1000.0 * MASS))
    for law, formula in (
        (PAPER, closed_forms.restitution),
        (LIGGGHTS, closed_forms.restitution),
        (YADE, closed_forms.restitution_clipped),
    ):
        assert rebound(damped, law).normal_speed / 0.001 == pytest.approx(formula(zeta), abs=1e-10)


@pytest.mark.parametrize("zeta", [1.0, 1.5])
def test_an_overdamped_impact_parts_only_where_the_dashpot_must_not_pull(zeta):
    damped = impact(normal_damping=2 * zeta * math.sqrt(1000.0 * MASS), pressed=0.0)
    clipped = closed_forms.restitution_clipped(zeta)
    assert rebound(damped, YADE).normal_speed / 0.001 == pytest.approx(clipped, abs=1e-9)
    assert closed_forms.restitution(zeta) == 0


def test_an_undamped_contact_lasts_half_a_period_and_gravity_gives_back_what_it_took():
    plain = rebound(impact(), PAPER)
    assert plain.duration == pytest.approx(math.pi * math.sqrt(MASS / 1000), rel=1e-11)
    pressed = rebound(impact(pressed=9.80665, normal_speed=0.5), PAPER)
    assert pressed.normal_speed == pytest.approx(0.5, rel=1e-11)
    assert pressed.duration > plain.duration


def test_a_disc_that_hardly_moves_is_held_by_its_weight():
    with pytest.raises(ValueError, match="do not part"):
        rebound(impact(normal_damping=ETA, pressed=9.80665), PAPER)
    with pytest.raises(ValueError, match="do not approach"):
        rebound(impact(normal_speed=0.0), PAPER)


def test_the_dashpot_pulls_hardest_as_the_two_part():
    found = rebound(impact(normal_damping=0.1006), PAPER)
    assert found.largest_pull == pytest.approx(0.1006 * found.normal_speed, rel=1e-9)
    assert rebound(impact(normal_damping=0.1006), YADE).largest_pull == 0


@pytest.mark.parametrize("eta", [0.0, 0.1006, ETA])
def test_a_contact_that_sticks_all_along_turns_its_slip_round_as_it_does_its_approach(eta):
    # Shear spring and dashpot are a third of the normal ones, as is the mass: the same oscillation twice.
    alike = impact(
        normal_damping=eta,
        shear_stiffness=1000.0 / 3,
        shear_damping=eta / 3,
        friction=1.0,
        slip_speed=0.001,
    )
    found = rebound(alike, PAPER)
    assert found.slip_speed == pytest.approx(-found.normal_speed, rel=1e-9)


@pytest.mark.parametrize("eta", [0.0, 0.1006, ETA])
def test_a_contact_that_slides_all_along_loses_mu_times_the_normal_impulse(eta):
    # Capped by the spring: its impulse is the whole normal one, as the dashpot's adds up to nothing.
    found = rebound(impact(normal_damping=eta, slip_speed=0.01), PAPER)
    impulse = MASS * (0.001 + found.normal_speed)
    assert MASS / 3 * (0.01 - found.slip_speed) == pytest.approx(0.25 * impulse, rel=1e-9)


@pytest.mark.parametrize("law", LAWS)
def test_without_dashpots_all_codes_have_one_law(law):
    for slip in (0.0005, 0.0013, 0.01):
        stiff = impact(slip_speed=slip, shear_stiffness=500.0)
        assert rebound(stiff, law).slip_speed == pytest.approx(
            rebound(stiff, PAPER).slip_speed, rel=1e-8
        )


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("slip", [-0.02, -0.001, 0.0, 0.0007, 0.003])
def test_an_impact_never_gains_energy_and_knows_no_left_and_right(law, slip):
    damped = impact(normal_damping=0.1006, shear_damping=0.0503, slip_speed=slip)
    found, mirrored = rebound(damped, law), rebound(
        dataclasses.replace(damped, slip_speed=-slip), law
    )
    assert abs(found.slip_speed) <= abs(slip)
    assert found.slip_speed == pytest.approx(-mirrored.slip_speed, abs=1e-14)


def test_on_the_knife_edge_the_papers_scheme_has_two_answers():
    edge = impact(normal_damping=0.1006, shear_damping=0.0503, slip_speed=0.001)
    sticks, slips = (
        rebound(dataclasses.replace(edge, slip_speed=0.001 * share), PAPER).slip_speed
        for share in (1 - 1e-9, 1 + 1e-9)
    )
    assert slips - sticks == pytest.approx(2.1e-4, rel=0.02)


def test_a_disc_rolls_with_two_thirds_of_its_speed_and_a_third_of_its_spin():
    assert closed_forms.rolling_speed(1.0, 0.0, 0.0025, 0.0025) == pytest.approx(2 / 3)
    assert closed_forms.rolling_speed(0.0, 4.0, 0.0025, 0.0025) == pytest.approx(-0.01 / 3)
    assert closed_forms.rolling_speed(-0.01, 4.0, 0.0025, 0.0025) == pytest.approx(-0.01)


def test_a_pinched_disc_rolls_without_slip_and_hangs_on_both_sides():
    for wall_arm, bar_arm in ((0.0025, 0.0025), (0.0024, 0.00245)):
        sink = closed_forms.pinched_sink(0.01, wall_arm, bar_arm)
        spin = closed_forms.pinched_spin(0.01, wall_arm, bar_arm)
        assert sink == pytest.approx(spin * wall_arm)
        assert 0.01 - sink == pytest.approx(spin * bar_arm)
        on_bar = closed_forms.pinched_load(1.0, wall_arm, bar_arm)
        assert on_bar * bar_arm == pytest.approx((1 - on_bar) * wall_arm)


def test_a_column_sinks_in_by_the_weight_above_each_contact():
    top = closed_forms.column_top([1.0, 0.5], [2.0, 1.0], floor_stiffness=100, pair_stiffness=50)
    assert top == pytest.approx(1 - 3 / 100 + 1.5 - 1 / 50)


def test_a_fall_starts_with_its_speed():
    assert closed_forms.fall(10.0, 2.0, 0.5) == pytest.approx(1 + 1.25)


def test_each_engine_has_its_law():
    scheme = {
        "name": "paper",
        "attraction": "allowed",
        "slip_cap": "spring",
        "torque_arm": "radius",
    }
    assert engine_law("native", {"scheme": scheme}).contact == PAPER
    assert engine_law("liggghts", {"scheme": scheme}).contact == LIGGGHTS
    assert engine_law("yade", {"scheme": scheme}).contact == YADE
    for name in ("liggghts", "yade", "yade_averaged"):
        twin = engine_law("native", {"scheme": scheme | {"name": name}})
        assert twin == engine_law(name.replace("_", "-"), {"scheme": scheme})
    clipped = {"scheme": scheme | {"attraction": "clipped"}}
    assert engine_law("liggghts", clipped).contact.clipped
    assert engine_law("native", clipped).contact == ContactLaw(clipped=True)
    assert engine_law("yade", {"scheme": scheme}).wall_arm(1.0, 0.1) == pytest.approx(0.9)
    with pytest.raises(ValueError):
        engine_law("another", {"scheme": scheme})


def test_a_disc_that_resists_rolling_is_slowed_by_less_than_one_that_slides():
    assert closed_forms.rolling_slowing(0.3, 0.002, 0.002) == pytest.approx(0.2)
    assert closed_forms.rolling_slowing(0.0, 0.002, 0.002) == 0
    # By energy: the moment's work mu_r r m g (way / a) is taken from m v^2 / 2 (1 + r^2 / 2 a^2).
    radius, arm = 0.002, 0.0017
    slowing = 0.3 * radius / arm / (1 + radius**2 / (2 * arm**2))
    assert closed_forms.rolling_slowing(0.3, radius, arm) == pytest.approx(slowing, rel=1e-12)


def test_a_joint_takes_its_springs_energy():
    speed = closed_forms.parting_speed_from_joint(0.02, 1000.0, MASS, 0.1)
    lost_J = MASS / 2 * (0.1**2 - speed**2)
    assert lost_J == pytest.approx(0.02**2 / 2 / 1000.0, rel=1e-12)
    assert closed_forms.parting_speed_from_joint(0.0, 1000.0, MASS, 0.1) == pytest.approx(0.1)
    assert closed_forms.parting_speed_from_joint(1.0, 1000.0, MASS, 0.1) == 0, "it holds"
