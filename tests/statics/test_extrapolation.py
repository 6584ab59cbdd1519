"""Joints outside the range of their moments: counted, and paid for in certainty."""

import numpy as np
import pytest
from hypothesis import given

import fes_mj
from fes_mj.linkage.design import Design
from fes_mj.linkage.joints import JOINTS
from fes_mj.moments.joint_moments import JointMoments
from fes_mj.moments.reference_tricycle import PAPER_TRICYCLE
from fes_mj.moments.torque_map import torque_map
from fes_mj.statics.extrapolation import NO_MORE
from tests.linkages import designs, periodic_moments


@given(designs(), periodic_moments())
def test_seat_angles_a_turn_apart_are_the_same(design: Design, moments: JointMoments) -> None:
    turned = design.with_linkage(seat_angle=design.linkage.seat_angle - 2 * np.pi)
    one, other = (fes_mj.quasi_static(seated, moments, points=360) for seated in (design, turned))
    assert one.crank_moment == pytest.approx(other.crank_moment, abs=1e-9)
    assert one.joint_range_deg.hip == pytest.approx(other.joint_range_deg.hip, abs=1e-9)


@given(periodic_moments())
def test_numbers_and_arrays_agree_all_round_the_circle(moments: JointMoments) -> None:
    torque, angle = torque_map(moments), np.linspace(-4 * np.pi, 4 * np.pi, 301)
    for joint in JOINTS:
        scalar = torque.feedback(joint)
        assert [scalar(value, 1.0) for value in angle] == pytest.approx(torque.moment(joint, angle, 1.0), abs=1e-9)


def test_the_share_of_a_known_excursion() -> None:
    """The TRT reclined by 6 deg: shares against a count, the error against the integral by hand."""
    trt, moments = fes_mj.load_design("trt"), fes_mj.load_moments()
    reclined = trt.with_linkage(seat_angle=trt.linkage.seat_angle - np.radians(6))
    result = fes_mj.quasi_static(reclined, moments)
    low, high = PAPER_TRICYCLE.ranges.hip
    outside = result.joint_angle.hip > high + NO_MORE
    beyond = result.extrapolation
    assert beyond.share == outside.mean()
    assert beyond.excess.hip == pytest.approx(result.joint_angle.hip.max() - high)
    # out and back over the same excess: by the drift of half the range, once in extension and once in flexion
    depth, half = beyond.excess.hip, (high - low) / 2
    by_hand = result.cadence / (2 * np.pi) * torque_map(moments).table.hip.std() * depth**2 / (2 * half) * np.sqrt(2)
    assert beyond.sd == pytest.approx(by_hand, rel=1e-3)
    inside = fes_mj.quasi_static(trt, moments)
    assert inside.extrapolation.share == inside.extrapolation.sd == 0
    assert inside.extrapolation.verdict is None
    assert inside.notes == []


def test_the_error_bar_grows_with_the_excess() -> None:
    d1, moments = fes_mj.load_design("d1"), fes_mj.load_moments()
    results = [fes_mj.quasi_static(d1.with_linkage(seat_angle=np.radians(seat)), moments) for seat in (24, 21, 18.5)]
    assert np.all(np.diff([result.extrapolation.sd for result in results]) > 0)
    for result in results:
        assert result.power_sd is not None
        assert result.power_sd > result.extrapolation.sd
        assert result.summary()["extrapolation"] == result.extrapolation.verdict
        assert any("beyond the range of the moments" in note for note in result.notes)
