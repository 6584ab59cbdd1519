"""Friction in MuJoCo against statics: two ways to the same loss."""

import mujoco
import numpy as np
import pytest

import fes_mj
from fes_mj.linkage.legs import LEGS
from fes_mj.simulation.bearings import add_friction
from fes_mj.simulation.mjcf import build_mjcf
from fes_mj.statics.friction import Bearings, slips


@pytest.mark.parametrize("legs", [1, 2])
def test_a_bearings_tendon_turns_as_its_two_bodies(design: fes_mj.Design, legs: int) -> None:
    spec = build_mjcf(design, legs=legs)
    moments = dict.fromkeys(design.linkage.architecture.joints, 0.1)
    add_friction(spec, design.linkage.architecture, LEGS[legs], moments)
    model = spec.compile()
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    mujoco.mj_forward(model, data)
    for leg in LEGS[legs]:
        motion = fes_mj.linkage.kinematics.solve(design, np.array([-leg.lag]))
        for joint, slip in slips(motion).items():
            speed = data.ten_velocity[model.tendon(f"{leg.prefix}{joint}_bearing").id]
            assert abs(speed) == pytest.approx(design.linkage.cadence * slip[0], rel=1e-9), joint


@pytest.mark.parametrize("name", ["trt", "r1"])
def test_mujoco_loses_what_statics_do(name: str) -> None:
    """Mean power, instantaneous power and energy agree within the same limits as without friction."""
    moments = fes_mj.load_moments("p1p2")
    case = fes_mj.Case(fes_mj.load_design(name), moments, bearings=Bearings(0.1, 0.008))
    assert case.agrees
    assert case.friction_loss > 0.05 * case.statics.power_mean
    smooth = fes_mj.Case(fes_mj.load_design(name), moments)
    assert smooth.simulation.power_mean - case.simulation.power_mean == pytest.approx(case.friction_loss, rel=1e-3)


@pytest.mark.long
@pytest.mark.parametrize("legs", [1, 2])
def test_all_designs_lose_what_statics_say(design: fes_mj.Design, moments: fes_mj.JointMoments, legs: int) -> None:
    case = fes_mj.Case(design, moments, legs=legs, bearings=Bearings(0.1, 0.008))
    assert case.agrees, [check for check in case.checks if not check.ok]
