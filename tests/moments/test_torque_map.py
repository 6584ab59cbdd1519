"""The torque map: the moments on their own tricycle, same for arrays and floats, kept at its ends."""

import math

import numpy as np
import pytest

import fes_mj
from fes_mj.linkage import kinematics
from fes_mj.linkage.joints import JOINTS
from fes_mj.moments.joint_moments import JointMoments
from fes_mj.moments.reference_tricycle import PAPER_TRICYCLE
from fes_mj.moments.torque_map import TorqueMap, scalar_map
from tests.moments.test_reference_tricycle import TURN


def test_on_the_reference_itself_the_map_gives_back_the_moments(smooth_moments: JointMoments) -> None:
    torque_map, motion = (
        TorqueMap(smooth_moments),
        kinematics.solve(PAPER_TRICYCLE.design, TURN + PAPER_TRICYCLE.top_dead_centre),
    )
    for joint in JOINTS:
        given = np.interp(TURN, smooth_moments.crank_angle, getattr(smooth_moments, joint), period=2 * np.pi)
        mapped = torque_map.moment(joint, motion.joint_angle[joint], motion.joint_rate[joint])
        assert np.abs(mapped - given).max() < 1e-3  # 0.1 deg table


@pytest.mark.parametrize("joint", JOINTS)
def test_floats_and_arrays_agree(joint: str, smooth_moments: JointMoments) -> None:
    torque_map = TorqueMap(smooth_moments)
    scalar = torque_map.feedback(joint)
    angle = np.radians(np.linspace(20, 170, 1501))
    for rate in (-2.0, 0.0, 0.5):
        array = torque_map.moment(joint, angle, rate)
        assert np.abs(array - [scalar(float(a), rate) for a in angle]).max() < 1e-9


@pytest.mark.parametrize("joint", JOINTS)
def test_beyond_its_range_the_map_keeps_the_end_value_and_there_both_directions_meet(
    joint: str, smooth_moments: JointMoments
) -> None:
    torque_map = TorqueMap(smooth_moments)
    low, high = PAPER_TRICYCLE.ranges[joint]
    for end, beyond in ((low, low - 0.3), (high, high + 0.3)):
        inside = torque_map.moment(joint, np.array([end, beyond, beyond]), np.array([1.0, 1.0, -1.0]))
        assert inside == pytest.approx([inside[1]] * 3, abs=1e-6)  # acos at its end: 1e-8 rad


def test_a_rate_of_zero_counts_as_extension(smooth_moments: JointMoments) -> None:
    torque_map, angle = TorqueMap(smooth_moments), math.radians(95)
    assert torque_map.moment("knee", angle, 0.0) == torque_map.moment("knee", angle, 1.0)
    assert torque_map.moment("knee", angle, 0.0) != torque_map.moment("knee", angle, -1.0)


@pytest.mark.parametrize("joint", JOINTS)
def test_the_map_of_floats_is_the_map_of_arrays(joint: str, moments: fes_mj.JointMoments) -> None:
    torque_map = TorqueMap(moments)
    scalar = scalar_map(joint, lambda value: math.acos(min(1.0, max(-1.0, value))))
    angles, table = np.linspace(1.0, 2.4, 201), torque_map.table[joint]
    for rate in (-1.0, 0.0, 1.0):
        expected = torque_map.moment(joint, angles, rate)
        assert [
            scalar(torque_map.reference.parameters(joint), table, angle, rate) for angle in angles
        ] == pytest.approx(list(expected), abs=1e-9)
