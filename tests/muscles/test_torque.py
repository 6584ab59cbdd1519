import numpy as np
import pytest

from fes_mj.common.errors import InputError
from fes_mj.linkage import kinematics
from fes_mj.linkage.design_file import DESIGNS, load_design
from fes_mj.linkage.joints import JOINTS
from fes_mj.linkage.legs import ONE_LEG, TWO_LEGS
from fes_mj.muscles.drive import Muscles, load_muscles
from fes_mj.muscles.rules import BY_ANGLE, STIMULATION_BY_ANGLE
from fes_mj.muscles.timing import TURN_ANGLES

STEPS = 720


def stepped(torque, leg, steps=STEPS):
    """Moments of knee and hip, shape (2, steps), and activations (groups, steps), along an exact turn."""
    cadence, angle = torque.cadence, np.arange(steps) * (2 * np.pi / steps)
    motion = kinematics.solve(torque.design, angle - leg.lag)
    rates = motion.joint_rate.map(lambda rate: cadence * rate)
    control = torque.control(leg, 2 * np.pi / cadence / steps)
    states = zip(angle.tolist(), *(column.tolist() for column in (*motion.joint_angle, *rates)), strict=True)
    return np.array([control.moments(*state) for state in states]).T, np.array(control.activation).T, motion


@pytest.mark.parametrize(("name", "timing"), [("d1", "best"), ("trt", "measured"), ("r2", STIMULATION_BY_ANGLE)])
def test_steps_give_what_the_turn_gives(name, timing, riders):
    design = load_design(name)
    torque = Muscles(riders.taken([0, 3]), timing).torque(design, design.linkage.cadence)
    moments, active, motion = stepped(torque, ONE_LEG[0])
    hidden = torque.hidden(2 * np.pi / torque.cadence / STEPS)
    assert active == pytest.approx(torque.activation(motion.crank_angle), abs=hidden)
    along = torque.along(motion, torque.cadence)
    largest = max(np.abs(along[joint]).max() for joint in JOINTS)
    assert moments == pytest.approx(np.array([*along]), abs=3 * hidden * largest / active.max())


def test_a_turn_ends_as_it_began_and_the_next_is_the_same(riders):
    design = load_design("d2")
    torque = Muscles(riders.taken([1])).torque(design, design.linkage.cadence)
    angle = np.arange(2 * STEPS) * (2 * np.pi / STEPS)
    control = torque.control(ONE_LEG[0], 2 * np.pi / torque.cadence / STEPS)
    for crank in angle.tolist():
        control.moments(crank, 1.8, 1.7, 0.0, 0.0)  # windows are of the crank alone
    first, second = np.split(np.array(control.activation), 2)
    assert second == pytest.approx(first, abs=1e-7)


def test_the_left_leg_does_the_same_half_a_turn_later(riders):
    design = load_design("d1")
    torque = Muscles(riders.taken([2])).torque(design, design.linkage.cadence)
    right, left = (stepped(torque, leg)[0] for leg in TWO_LEGS)
    assert left == pytest.approx(np.roll(right, STEPS // 2, axis=1), abs=1e-6)


@pytest.mark.parametrize("name", DESIGNS)
def test_activation_of_a_rider_is_that_of_statics(name):
    """But for what whole degrees leave open (timing.TURN_ANGLES)."""
    design, muscles = load_design(name), load_muscles("p1p2", "measured")
    one = muscles.simulated(design, design.linkage.cadence)
    torque = muscles.torque(design, design.linkage.cadence)
    assert torque.activation(TURN_ANGLES) == pytest.approx(one.turn.activation[:, 0, 0], abs=5e-4)


def test_by_angle_the_moments_of_the_measurement_are_mapped():
    design, muscles = load_design("r2"), load_muscles("p1p3", BY_ANGLE)
    one, cadence = muscles.simulated(design, design.linkage.cadence), design.linkage.cadence
    mapped = muscles.torque(design, cadence).along(one.motion, cadence)
    power = cadence * sum(mapped[joint] * one.motion.joint_rate[joint] for joint in JOINTS)
    # a Fourier series in the place of straight lines between whole degrees
    assert power.mean() == pytest.approx(one.power.mean(), abs=0.01)


def test_the_most_probable_rider_is_stimulated_as_is_best_for_all():
    design, muscles = load_design("d1"), load_muscles("p1p2")
    every, one = (f(design, design.linkage.cadence) for f in (muscles.stimulated, muscles.simulated))
    assert one.power[0] == pytest.approx(every.power[every.most_probable])
    assert one.riders.likelihood == [every.riders.likelihood.max()]
    assert one.windows is every.windows


def test_an_unknown_timing_is_refused(riders):
    with pytest.raises(InputError, match=r"timing is 'soon'.* best, measured"):
        Muscles(riders, "soon")
