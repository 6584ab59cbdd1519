"""Closing, joint ranges and transmission, against other ways to the same numbers."""

import math

import numpy as np
import pytest
from hypothesis import given

from fes_mj.linkage import kinematics
from fes_mj.linkage.assembly import (
    DYADS,
    clearances,
    grashof_margin,
    joint_ranges,
    transmission_angles,
)
from fes_mj.linkage.design import Design, Linkage
from fes_mj.linkage.kinematics import FULL_TURN
from fes_mj.moments.reference_tricycle import PAPER_TRICYCLE
from tests.linkages import designs


def test_transmission_angle_of_the_trt() -> None:
    """By the law of cosines at the two ends."""
    motion = kinematics.solve(PAPER_TRICYCLE.design)
    frame, crank = abs(PAPER_TRICYCLE.design.linkage.crank_centre), PAPER_TRICYCLE.design.linkage.crank
    thigh, shank = PAPER_TRICYCLE.design.rider.thigh, float(PAPER_TRICYCLE.design.knee_to_pedal)

    def at_knee(span: float) -> float:
        angle = math.degrees(math.acos((thigh**2 + shank**2 - span**2) / (2 * thigh * shank)))
        return min(angle, 180 - angle)

    assert transmission_angles(motion)["knee"] == pytest.approx(
        min(at_knee(frame - crank), at_knee(frame + crank)), abs=0.01
    )


def test_joint_ranges_are_those_of_the_closed_form() -> None:
    """An extreme is missed by half a step at most, over which the angle turns round with its largest curvature."""
    design, half_step = PAPER_TRICYCLE.design, np.pi / len(FULL_TURN)
    curvature = max(np.abs(rotation[1]).max() for rotation in kinematics.solve(design).joint_rotation)
    exact = np.degrees([*PAPER_TRICYCLE.ranges.knee, *PAPER_TRICYCLE.ranges.hip])
    assert joint_ranges(design) == pytest.approx(exact, rel=0, abs=np.degrees(curvature * half_step**2 / 2))


def test_grashofs_inequality_tells_which_cranks_turn() -> None:
    """They do where rocker and coupler reach both positions of the crank in line with the frame."""
    random = np.random.default_rng(0)
    frame, coupler, rocker = random.uniform(0.2, 0.6, (3, 1000, 1))
    crank = random.uniform(0.01, 0.2, (1000, 1))
    linkage = Linkage("cdt", 0j, crank, 0.0, pivot_to_crank=frame * 1j, coupler=coupler, rocker=rocker)
    turns = (np.abs(rocker - coupler) < frame - crank) & (frame + crank < rocker + coupler)
    assert 0 < turns.sum() < 1000
    assert np.array_equal(grashof_margin(Design("batch", linkage)) > 0, turns.ravel())


@given(designs())
def test_clearances_are_those_of_a_fine_search(design: Design) -> None:
    points = kinematics.positions(design, np.linspace(0, 2 * np.pi, 200_001))
    for links, margin, span, angle in clearances(design):
        start, end, _ = DYADS[links]
        spans = np.abs(points[end] - points[start])
        one, other = (float(design.link_lengths[link]) for link in links)
        searched = min(one + other - spans.max(), spans.min() - abs(one - other))
        assert margin[0] == pytest.approx(searched, abs=1e-8 if searched < 0.02 else 1e-3)
        there = kinematics.positions(design, angle)
        assert span[0] == pytest.approx(np.abs(there[end] - there[start]).item(), abs=1e-12)
