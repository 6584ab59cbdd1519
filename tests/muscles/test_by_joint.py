import numpy as np
import pytest

from fes_mj.linkage import kinematics
from fes_mj.linkage.design_file import DESIGNS, load_design
from fes_mj.linkage.joints import JOINTS, PerJoint
from fes_mj.moments.joint_moments import RIDER_GROUPS
from fes_mj.muscles.activation import periodic_activation, trapezium
from fes_mj.muscles.anatomy import MUSCLE_GROUPS
from fes_mj.muscles.by_joint import LEADING, TURNED, around_reversals
from fes_mj.muscles.prior import ramp
from fes_mj.muscles.pull import pull
from fes_mj.muscles.riders import load_riders
from fes_mj.muscles.rules import STIMULATION_BY_ANGLE, stimulated
from fes_mj.muscles.timing import TURN_ANGLES

FINE = 28_800  # crank angles


@pytest.mark.long
@pytest.mark.parametrize("group", RIDER_GROUPS)
@pytest.mark.parametrize("name", DESIGNS)
def test_expected_power_is_that_of_a_fine_grid(name, group):
    """Which is not told where joints turn round, and is a thousandth of a percent off for it."""
    design, riders = load_design(name), load_riders(group).taken(slice(0, None, 5))
    cadence, trial, turn = design.linkage.cadence, riders.measured_on, np.arange(FINE) * (2 * np.pi / FINE)
    motion = kinematics.solve(design, turn)
    source = PerJoint.of(lambda joint: trial.source_angle(joint, motion.joint_angle[joint], motion.joint_rate[joint]))
    on, width = np.radians(np.moveaxis(riders.windows(), -1, 0))[..., None]
    there = np.stack([source[LEADING[group]] for group in MUSCLE_GROUPS])[:, None]
    asked = trapezium(there - on, width, trial.cadence * ramp())
    active = periodic_activation(asked, 2 * np.pi / cadence, riders["rise_s"][..., 0, 0], riders.fall[..., 0, 0])
    late = np.round(riders["delay_s"][..., 0] * cadence / turn[1]).astype(int)
    active = np.take_along_axis(active, ((np.arange(FINE) - late) % FINE)[None], axis=-1)
    power = (active * pull(riders, motion, cadence).power[:, :, 0]).sum(axis=0).mean()
    assert stimulated(STIMULATION_BY_ANGLE, riders, design, cadence).power.mean() == pytest.approx(power, rel=2e-4)


def test_a_joint_turns_round_between_two_angles_that_are_all_but_one():
    design = load_design("trt")
    before, after = around_reversals(design, TURN_ANGLES).reshape(len(JOINTS), 2, 2).swapaxes(0, 1)
    assert np.abs(after - before).max() <= TURNED
    for row, joint in enumerate(JOINTS):
        rates = [kinematics.solve(design, ends[row]).joint_rate[joint] for ends in (before, after)]
        assert (np.sign(rates[0]) == -np.sign(rates[1])).all()
