"""Friction against a bearing by hand, and against another first-order sum."""

import numpy as np
import pytest

import fes_mj
from fes_mj.linkage.kinematics import solve
from fes_mj.statics.friction import BearingLoss, Bearings, slips
from fes_mj.statics.joint_forces import JointForces

PLAIN = Bearings(0.1, 0.008)


def _loss(design: fes_mj.Design, bearings: Bearings = PLAIN) -> BearingLoss:
    turn = fes_mj.quasi_static(design, fes_mj.load_moments("p1p2"), points=720)
    return BearingLoss(JointForces(turn), bearings)


def test_loss_is_force_times_radius_times_turning() -> None:
    """Of the TRT's axle by hand: it turns at the cadence under the force of the crank."""
    loss = _loss(fes_mj.load_design("trt"))
    force = np.abs(loss.forces.with_masses["crank_centre"])
    assert loss.by_joint["crank_centre"] == pytest.approx(0.1 * 0.008 * force.mean() * loss.forces.static.cadence)
    assert loss.by_joint.keys() == {"crank_centre", "pedal"}


def test_slip_is_how_the_angle_of_two_bodies_changes(design: fes_mj.Design) -> None:
    """By differences of their directions."""
    step = 1e-5
    before, motion, after = (solve(design, np.linspace(0, 2 * np.pi, 90) + lead) for lead in (-step, 0.0, step))
    for joint, pair in design.linkage.architecture.joints.items():
        if joint in slips(motion):
            turned = [np.conj(before.direction(body)) * after.direction(body) for body in pair if body != "frame"]
            between = turned[-1] * np.conj(turned[0]) if len(turned) == 2 else turned[0]
            assert slips(motion)[joint] == pytest.approx(np.abs(np.angle(between)) / (2 * step), abs=1e-8)


def test_constant_moments_lose_as_much(design: fes_mj.Design) -> None:
    loss = _loss(design)
    turn = loss.forces.static
    assert turn.cadence * loss.crank_moment(turn.motion).mean() == pytest.approx(loss.power, rel=1e-12)


def test_loss_is_proportional(design: fes_mj.Design) -> None:
    assert _loss(design, Bearings(0.3, 0.016)).power == pytest.approx(6 * _loss(design).power)
    assert _loss(design, Bearings(0.0, 0.016)).power == 0
