"""The torque map: exact inverse of the reference TRT, same for arrays and floats, kept at its ends."""

import math

import numpy as np
import pytest

from fes_mj import kinematics
from fes_mj.joints import JOINTS
from fes_mj.moments import JointMoments
from fes_mj.reference_tricycle import PAPER_TRICYCLE
from fes_mj.torque_map import TorqueMap

_TURN = np.linspace(0.003, 2 * np.pi, 997, endpoint=False)  # avoids the exact reversals


def test_top_dead_centre_is_where_the_leg_is_most_bent() -> None:
    turn = np.linspace(0, 2 * np.pi, 360_000, endpoint=False)
    knee = kinematics.solve(PAPER_TRICYCLE.design, turn).joint_angle.knee
    assert math.degrees(PAPER_TRICYCLE.top_dead_centre) == pytest.approx(22.4, abs=0.05)  # the 22 deg of the paper
    assert turn[np.argmin(knee)] == pytest.approx(PAPER_TRICYCLE.top_dead_centre, abs=1e-4)


@pytest.mark.parametrize("joint", JOINTS)
def test_source_angle_inverts_the_reference(joint: str) -> None:
    motion = kinematics.solve(PAPER_TRICYCLE.design, _TURN + PAPER_TRICYCLE.top_dead_centre)
    angle, rate = motion.joint_angle[joint], motion.joint_rate[joint]
    error = np.exp(1j * (PAPER_TRICYCLE.source_angle(joint, angle, rate) - _TURN)) - 1
    assert np.abs(error).max() < 1e-10


def test_on_the_reference_itself_the_map_gives_back_the_moments(smooth_moments: JointMoments) -> None:
    torque_map, motion = (
        TorqueMap(smooth_moments),
        kinematics.solve(PAPER_TRICYCLE.design, _TURN + PAPER_TRICYCLE.top_dead_centre),
    )
    for joint in JOINTS:
        given = np.interp(_TURN, smooth_moments.crank_angle, getattr(smooth_moments, joint), period=2 * np.pi)
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


def test_reference_ranges_are_the_extremes_of_its_motion() -> None:
    motion = kinematics.solve(PAPER_TRICYCLE.design, np.linspace(0, 2 * np.pi, 36_000))
    for joint, angle in motion.joint_angle.items():
        assert PAPER_TRICYCLE.ranges[joint] == pytest.approx((angle.min(), angle.max()), abs=1e-7)


def test_reference_ranges_are_those_of_table_1() -> None:
    assert np.degrees(PAPER_TRICYCLE.ranges.knee) == pytest.approx([69, 122], abs=0.5)
    assert np.degrees(PAPER_TRICYCLE.ranges.hip) == pytest.approx([85, 120], abs=0.5)
