"""Joints outside the range of their moments: refused, or counted and paid for in certainty."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given

import fes_mj
from fes_mj.common.errors import InputError
from fes_mj.linkage.design import Design
from fes_mj.linkage.joints import JOINTS
from fes_mj.moments.joint_moments import JointMoments
from fes_mj.moments.reference_tricycle import PAPER_TRICYCLE
from fes_mj.moments.torque_map import torque_map
from fes_mj.statics.extrapolation import NO_MORE, turning_in_range
from tests.linkages import designs, periodic_moments


def flipped(name: str, **parts: complex) -> Design:
    """A design whose R1 (and R7) are multiplied in x and y by the real and imaginary part of the given factors."""
    design = fes_mj.load_design(name)
    changes = {
        part: complex(getattr(design.linkage, part).real * sign.real, getattr(design.linkage, part).imag * sign.imag)
        for part, sign in parts.items()
    }
    return design.with_linkage(**changes)


@pytest.mark.parametrize("name", ["r1", "r2", "d1", "d2"])
@pytest.mark.parametrize(
    ("sign", "said"),
    [
        (-1 + 1j, r"\+x"),
        (1 - 1j, "y is down"),
        (-1 - 1j, "x is forwards and y down"),
    ],
)
def test_a_mirrored_sketch_is_recognised(name: str, sign: complex, said: str) -> None:
    with pytest.raises(InputError, match=said):
        fes_mj.quasi_static(flipped(name, ground=sign, pivot_to_crank=sign), fes_mj.load_moments())


@pytest.mark.parametrize("name", ["trt", "r1", "r2", "d1", "d2"])
def test_a_wrong_sign_of_r1_is_recognised_before_anything_runs(name: str) -> None:
    wrong = flipped(name, ground=-1 + 1j)
    for run in (fes_mj.quasi_static, fes_mj.simulate):
        with pytest.raises(InputError, match="R1's x"):
            run(wrong, fes_mj.load_moments())


@given(designs())
def test_a_hip_that_never_enters_the_range_is_refused_and_one_that_does_is_not(design: Design) -> None:
    turning_in_range(design, PAPER_TRICYCLE)
    high = PAPER_TRICYCLE.ranges.hip[1]
    angle = fes_mj.quasi_static(design, fes_mj.load_moments(), points=360).joint_angle.hip
    beyond = replace(
        design, linkage=replace(design.linkage, seat_angle=design.linkage.seat_angle + angle.min() - high - 0.01)
    )
    with pytest.raises(InputError, match="the hip"):
        turning_in_range(beyond, PAPER_TRICYCLE)


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
