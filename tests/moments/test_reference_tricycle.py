"""The reference tricycle: top dead centre, ranges and inverse against its own motion."""

import math

import numpy as np
import pytest

from fes_mj.linkage import kinematics
from fes_mj.linkage.joints import JOINTS
from fes_mj.moments.reference_tricycle import PAPER_TRICYCLE

TURN = np.linspace(0.003, 2 * np.pi, 997, endpoint=False)  # avoids the exact reversals


def test_top_dead_centre_is_where_the_leg_is_most_bent() -> None:
    turn = np.linspace(0, 2 * np.pi, 360_000, endpoint=False)
    knee = kinematics.solve(PAPER_TRICYCLE.design, turn).joint_angle.knee
    assert math.degrees(PAPER_TRICYCLE.top_dead_centre) == pytest.approx(22.4, abs=0.05)  # the 22 deg of the paper
    assert turn[np.argmin(knee)] == pytest.approx(PAPER_TRICYCLE.top_dead_centre, abs=1e-4)


@pytest.mark.parametrize("joint", JOINTS)
def test_source_angle_inverts_the_reference(joint: str) -> None:
    motion = kinematics.solve(PAPER_TRICYCLE.design, TURN + PAPER_TRICYCLE.top_dead_centre)
    angle, rate = motion.joint_angle[joint], motion.joint_rate[joint]
    error = np.exp(1j * (PAPER_TRICYCLE.source_angle(joint, angle, rate) - TURN)) - 1
    assert np.abs(error).max() < 1e-10


def test_reference_ranges_are_the_extremes_of_its_motion() -> None:
    motion = kinematics.solve(PAPER_TRICYCLE.design, np.linspace(0, 2 * np.pi, 36_000))
    for joint, angle in motion.joint_angle.items():
        assert PAPER_TRICYCLE.ranges[joint] == pytest.approx((angle.min(), angle.max()), abs=1e-7)
