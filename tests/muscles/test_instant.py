from itertools import pairwise

import numpy as np
import pytest

from fes_mj.common.machine_code import in_lists, readable
from fes_mj.linkage import kinematics
from fes_mj.linkage.design_file import DESIGNS, load_design
from fes_mj.muscles import instant, step
from fes_mj.muscles.activation import periodic_activation, trapezium
from fes_mj.muscles.anatomy import MUSCLE_GROUPS
from fes_mj.muscles.contraction import PLATEAU, tension
from fes_mj.muscles.instant import LegMuscles, Stimulus, activated, joint_moments, stimulation, weights
from fes_mj.muscles.pull import pull
from fes_mj.muscles.timing import TURN_ANGLES, Windows, activation

GROUP_NUMBERS = range(len(MUSCLE_GROUPS))


def curves(leg, motion, cadence, active):
    """Knee and hip moments along a motion under constant activations of the groups, shape (2, angles)."""
    angle, rate = motion.joint_angle, motion.joint_rate
    states = zip(angle.knee, angle.hip, cadence * rate.knee, cadence * rate.hip, strict=True)
    return np.array([joint_moments(leg, active, *map(float, state)) for state in states]).T


@pytest.mark.parametrize("name", DESIGNS)
def test_moments_are_those_of_the_turn(name, riders):
    design = load_design(name)
    motion, cadence = kinematics.solve(design, TURN_ANGLES[::20]), design.linkage.cadence
    for row in (0, 5):
        pulled = pull(riders.taken([row]), motion, cadence).moment
        leg = LegMuscles.of(riders.taken([row]), design.rider).in_lists
        for group in GROUP_NUMBERS:
            alone = curves(leg, motion, cadence, np.eye(len(MUSCLE_GROUPS))[group])
            for joint, curve in zip(("knee", "hip"), alone, strict=True):
                expected = pulled[joint][group, 0, 0]
                assert curve == pytest.approx(expected, rel=1e-12, abs=1e-12 * np.abs(expected).max())


def test_moments_are_the_groups_together(riders):
    design = load_design("d2")
    motion = kinematics.solve(design, TURN_ANGLES[::60])
    leg, share = LegMuscles.of(riders.taken([2]), design.rider).in_lists, np.array([0.3, 0.5, 0.7])
    apart = [curves(leg, motion, 9.0, row) for row in np.diag(share)]
    assert curves(leg, motion, 9.0, share) == pytest.approx(np.sum(apart, axis=0), rel=1e-12)


def test_fibres_do_the_work_that_joints_do(riders):
    """Moments times rates are what the lengths lose times the tension, by differences of the lengths alone."""
    design, step = load_design("d1"), 1e-5
    leg = LegMuscles.of(riders.taken([1]), design.rider)
    knee, hip, rates = 1.9, 1.6, np.array([2.0, -1.5])

    def length(muscle, seconds):
        bent = leg.straight - np.array([knee, hip]) - seconds * rates
        return np.polynomial.polynomial.polyval2d(
            *bent[:: 1 - 2 * leg.knee_inside[muscle]], leg.lengths[muscle, ::-1, ::-1]
        )

    power = 0.0
    for muscle in range(len(leg.group)):
        speed = (length(muscle, step) - length(muscle, -step)) / (2 * step)
        optimal, pennation = leg.optimal[muscle], np.arcsin(leg.thickness[muscle] / leg.optimal[muscle])
        state = np.array([length(muscle, 0)]), np.array([speed])
        pulled, _ = tension(*state, optimal, leg.slack[muscle], pennation, leg.max_speed[muscle] / optimal)
        power -= leg.force[muscle] * pulled[0] * speed
    moments = joint_moments(leg.in_lists, np.ones(len(MUSCLE_GROUPS)), knee, hip, *rates.tolist())
    assert moments @ rates == pytest.approx(power, rel=1e-6)


def test_a_muscle_is_hills_at_its_ends():
    """One muscle with a moment arm of 5 cm at the knee, at its optimal length, and slack."""
    knee_alone = np.array([[[0.05, 0.4]]])
    columns = np.ones((4, 1)) * [[100.0], [0.1], [0.3], [0.0]]
    group, inside = np.zeros(1, int), np.ones(1, bool)
    leg = LegMuscles(group, inside, knee_alone, np.zeros(2), *columns, np.array([0.8]), 0.1, 0.1, 0.0)
    leg = leg.in_lists

    def pulled(knee, shortening):
        return joint_moments(leg, [1.0], knee, 1.0, shortening / 0.05, 0.0)[0] / 100 / 0.05

    assert [pulled(0.0, speed) for speed in (0.0, 0.8, 5.0, -0.8, -5.0)] == pytest.approx([1, 0, 0, PLATEAU, PLATEAU])
    assert pulled(0.9, 0.0) == pytest.approx(np.exp(-1))
    assert pulled(2.1, 0.0) == pulled(3.0, 0.0) == 0


@pytest.mark.long
def test_machine_code_says_the_same(riders):
    leg, stimulus = LegMuscles.of(riders.taken([6]), load_design("r1").rider), Stimulus(*np.ones((2, 3)), 0.4)
    state, active = (1.8, 1.5, -2.0, 1.0), np.array([0.2, 0.9, 0.4])
    for function, arguments in {
        "joint_moments": (leg, active, *state),
        "stimulation": (stimulus, 1, 7.5),
        "weights": (0.01, 0.08),
        "activated": (0.3, 0.4, 0.5, (0.9, 0.04, 0.06), (0.8, 0.1, 0.1)),
    }.items():
        given = getattr(step, function)(*map(readable, arguments))
        assert given == pytest.approx(getattr(instant, function)(*map(in_lists, arguments)), rel=1e-13)


def test_stimulation_is_the_trapezium_over_any_turns():
    windows = Windows(np.reshape([300.0, 10, 0], (3, 1, 1)), np.reshape([100.0, 15, 0], (3, 1, 1)))
    stimulus, angles = Stimulus.of(windows, cadence=7.0), np.linspace(-7, 14, 211)
    for group in GROUP_NUMBERS:
        expected = trapezium(angles - stimulus.on[group], stimulus.width[group], stimulus.ramp)
        given = [stimulation(in_lists(stimulus), group, angle) for angle in angles.tolist()]
        assert given == pytest.approx(expected, abs=1e-14)


def test_steps_of_activation_are_those_of_the_turn(riders):
    member, turn = riders.taken([4]), 0.8
    rise, fall = float(member["rise_s"].item()), float(member.fall.item())
    stimulus = trapezium(TURN_ANGLES - 1.0, 2.0, 0.4)
    expected = periodic_activation(stimulus, turn, rise, fall)
    step, value = turn / len(TURN_ANGLES), float(expected[0])
    rising, falling = weights(step, rise), weights(step, fall)
    for before, after, then in zip(stimulus, np.roll(stimulus, -1), np.roll(expected, -1), strict=True):
        value = activated(value, float(before), float(after), rising, falling)
        assert value == pytest.approx(then, abs=2e-7)  # a turn may end so far from where it began


def test_fine_steps_tell_what_a_turn_of_whole_degrees_leaves_open(riders):
    """The delay and the corners of a window lie between the degrees; both answers are those of the same rider."""
    design, member = load_design("trt"), riders.taken([3])
    windows = Windows(np.full((3, 1, 1), 205.0), np.full((3, 1, 1), 95.0))
    cadence, steps = design.linkage.cadence, 3600
    expected = activation(windows, member, cadence)[0, 0, 0]
    leg, stimulus = LegMuscles.of(member, design.rider), Stimulus.of(windows, cadence)
    shift = cadence * leg.delay
    angles = np.arange(-4 * steps, steps) * (2 * np.pi / steps)
    given = [stimulation(in_lists(stimulus), 0, angle - shift) for angle in angles.tolist()]
    rising, falling = (weights(2 * np.pi / cadence / steps, constant) for constant in (leg.rise, leg.fall))
    values = [0.0]
    for before, after in pairwise(given):
        values.append(activated(values[-1], before, after, rising, falling))
    # what a corner between two degrees hides of the stimulation's area, at most, per time constant
    hidden = (2 * np.pi / len(TURN_ANGLES)) ** 2 / (8 * stimulus.ramp) / (cadence * leg.rise)
    assert values[4 * steps :: 10] == pytest.approx(expected, abs=hidden)
