"""Free-body equilibrium against virtual work, the paper's own equations and the definition of power."""

import math

import numpy as np
import pytest

import fes_mj
from fes_mj import quasi_static
from fes_mj.common.checks import LEAST_POWER
from fes_mj.common.errors import InputError
from fes_mj.linkage.assembly import clearances
from fes_mj.linkage.design import Design
from fes_mj.linkage.design_file import load_design
from fes_mj.linkage.kinematics import solve
from fes_mj.moments.joint_moments import JointMoments
from fes_mj.moments.reference_tricycle import PAPER_TRICYCLE
from fes_mj.moments.torque_map import torque_map
from fes_mj.statics.equilibrium import equilibrium, virtual_work
from fes_mj.statics.turn import TURN_POINTS, LegTurns, ratio_sd, turn_points
from studies.random_linkages import random_design, random_moments

MANY = 200_000  # crank angles


def test_equilibrium_is_virtual_work(design: Design, moments: JointMoments) -> None:
    result = quasi_static(design, moments)
    work = virtual_work(result.motion, result.joint_moment)
    assert np.abs(result.crank_moment - work).max() < 1e-9 * np.abs(work).max()


def test_reactions_balance_every_body(design: Design, smooth_moments: JointMoments) -> None:
    """Force balance of each body, and the shank's moments about the knee, from the reactions alone."""
    result = quasi_static(design, smooth_moments)
    joints, points = design.linkage.architecture.joints, result.motion.points
    for body in design.linkage.architecture.bodies:
        forces = [
            (1 if pair[1] == body else -1) * result.reactions[point] for point, pair in joints.items() if body in pair
        ]
        assert np.abs(np.sum(forces, axis=0)).max() < 1e-9
    arm = points["pedal"].value - points["knee"].value
    on_shank = -result.reactions["pedal"]  # the shank is the first body of the pedal joint
    assert np.abs((np.conj(arm) * on_shank).imag - result.joint_moment.knee).max() < 1e-9


def test_the_corrected_equation_4_gives_the_same_crank_moment(smooth_moments: JointMoments) -> None:
    """Eq. 4 with R4 on both terms, M_k in the first row and the shank's sign turned, solved by hand."""
    result = quasi_static(PAPER_TRICYCLE.design, smooth_moments, points=360)
    motion, linkage, rider = result.motion, PAPER_TRICYCLE.design.linkage, PAPER_TRICYCLE.design.rider
    thigh, shank, crank = (motion.direction(body) for body in ("thigh", "shank", "crank"))
    r4, r3 = rider.thigh, PAPER_TRICYCLE.design.knee_to_pedal
    matrix = np.array([[r4 * thigh.imag, -r4 * thigh.real], [r3 * shank.imag, -r3 * shank.real]]).transpose(2, 0, 1)
    right = np.stack([result.joint_moment.hip + result.joint_moment.knee, -result.joint_moment.knee], axis=1)
    force_x, force_y = np.linalg.solve(matrix, right[..., None])[..., 0].T
    crank_moment = linkage.crank * (force_x * crank.imag - force_y * crank.real)
    assert np.abs(crank_moment - result.crank_moment).max() < 1e-9


def test_power_in_the_reference_is_joint_power_at_the_crank_angle(smooth_moments: JointMoments) -> None:
    result = quasi_static(PAPER_TRICYCLE.design, smooth_moments)
    source = result.crank_angle - PAPER_TRICYCLE.top_dead_centre
    knee, hip = (
        np.interp(source, smooth_moments.crank_angle, getattr(smooth_moments, joint), period=2 * np.pi)
        for joint in ("knee", "hip")
    )
    power = result.cadence * (knee * result.motion.joint_rate.knee + hip * result.motion.joint_rate.hip)
    assert result.power_mean == pytest.approx(power.mean(), rel=1e-5)
    assert result.work_per_turn == pytest.approx(result.power_mean * 2 * np.pi / result.cadence, rel=1e-12)


def test_the_mean_does_not_depend_on_the_number_of_points(design: Design, moments: JointMoments) -> None:
    assert turn_points(design) == TURN_POINTS
    coarse, fine = (quasi_static(design, moments, points=points).power_mean for points in (None, 36_000))
    assert coarse == pytest.approx(fine, rel=1e-5)


@pytest.mark.parametrize("seed", [0, *(pytest.param(seed, marks=pytest.mark.long) for seed in range(1, 40))])
def test_the_number_of_points_follows_from_the_sharpness(seed: int) -> None:
    """Within 1.5 mm of a dead centre a tenth of what the cross-check allows, against virtual work at 200,000 angles."""
    random = np.random.default_rng(seed)
    design = random_design(random, nearest=1.05e-4)
    while min(clearance.margin[0] for clearance in clearances(design)) > 1.5e-3:
        design = random_design(random, nearest=1.05e-4)
    for moments in (fes_mj.load_moments("p1p2"), fes_mj.load_moments("p1p3"), random_moments(random)):
        torque, cadence, total = torque_map(moments), design.linkage.cadence, 0.0
        for part in np.array_split(np.linspace(0, 2 * np.pi, MANY, endpoint=False), 20):
            motion = solve(design, part)
            total += float(virtual_work(motion, torque.along(motion, cadence)).sum())
        exact = cadence * total / MANY
        assert quasi_static(design, moments).power_mean == pytest.approx(exact, abs=5e-5 * max(abs(exact), LEAST_POWER))


def test_loads_enter_equilibrium_as_they_enter_virtual_work(design: Design, smooth_moments: JointMoments) -> None:
    from fes_mj.linkage.inertia import body_loads

    result = quasi_static(design, smooth_moments, points=360)
    loads = body_loads(result.motion, result.cadence)
    moment, _ = equilibrium(result.motion, result.joint_moment, loads)
    work = virtual_work(result.motion, result.joint_moment, loads)
    assert np.abs(moment - work).max() < 1e-9 * np.abs(work).max()


def test_a_batch_of_designs_is_refused_with_the_name_of_what_takes_it(moments: JointMoments) -> None:
    batch = load_design("d1").with_rider(thigh=np.array([[0.5], [0.52]]))
    with pytest.raises(InputError, match=r"d1: a batch of designs; fes_mj\.statics\.cycles\.cycles"):
        quasi_static(batch, moments)


@pytest.mark.parametrize("cadence", [0.0, -1.0, np.nan])
def test_a_crank_that_does_not_turn_is_refused(moments: JointMoments, cadence: float) -> None:
    with pytest.raises(InputError, match="d1: cadence is"):
        quasi_static(load_design("d1"), moments, cadence)


def test_two_legs_are_one_leg_and_itself_half_a_turn_later(smooth_moments: fes_mj.JointMoments) -> None:
    design = fes_mj.load_design("d1")
    one = quasi_static(design, smooth_moments)
    both = LegTurns.solve(design, smooth_moments, one.cadence, legs=2)
    motion = solve(design, one.crank_angle - np.pi)
    later = virtual_work(motion, one.torque.along(motion, one.cadence))
    np.testing.assert_allclose(both.power, one.power + later * one.cadence, atol=1e-9)
    assert both.power_mean == pytest.approx(one.power_mean, rel=1e-12)
    assert both.summary()["work_per_turn_J"] == pytest.approx(one.work_per_turn, rel=1e-12)


def test_legs_with_moments_of_their_own() -> None:
    """The mean is over the legs; the errors of two recordings are independent."""
    design, right, left = fes_mj.load_design("r1"), fes_mj.load_moments("p1p2"), fes_mj.load_moments("p1p3")
    one, other = quasi_static(design, right), quasi_static(design, left)
    both = LegTurns.solve(design, fes_mj.load_moments("p1p2", left="p1p3"), one.cadence, legs=2)
    assert both.power_mean == pytest.approx((one.power_mean + other.power_mean) / 2, rel=1e-12)
    assert both.power_sd == pytest.approx(math.hypot(one.power_sd, other.power_sd) / 2, rel=1e-12)
    half = len(one.power) // 2
    np.testing.assert_allclose(both.power, one.power + np.concatenate([other.power[half:], other.power[:half]]))


def test_the_ratio_of_designs_under_the_same_moments(moments: fes_mj.JointMoments) -> None:
    """As ratio_sd for one leg; what is the same is once itself without error."""
    trt, d1 = (
        LegTurns.solve(design, moments, design.linkage.cadence) for design in map(fes_mj.load_design, ("trt", "d1"))
    )
    ratio, deviation = d1.ratio(trt)
    assert ratio == pytest.approx(d1.first.power_mean / trt.first.power_mean, rel=1e-12)
    assert deviation == pytest.approx(ratio_sd(d1.first, trt.first), rel=1e-12)
    assert d1.ratio(d1) == (1.0, 0.0)
