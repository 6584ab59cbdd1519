"""The generated model: exact start, planarity, names, and what is written is what is loaded."""

import math

import mujoco
import numpy as np
import pytest

import fes_mj
from fes_mj.linkage.inertia import inertias
from fes_mj.linkage.kinematics import solve
from fes_mj.simulation.mjcf import ModelOptions, build_mjcf


@pytest.mark.parametrize("anchors", ["sites", "bodies"])
@pytest.mark.parametrize("legs", [1, 2])
def test_the_keyframe_is_assembled_and_moves_as_the_kinematics_say(
    design: fes_mj.Design, legs: int, anchors: str
) -> None:
    model = build_mjcf(design, legs=legs, options=ModelOptions(anchors=anchors)).compile()
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    mujoco.mj_forward(model, data)
    assert np.abs(data.efc_pos).max() < 1e-12
    assert np.abs(data.efc_vel).max() < 1e-12
    prefix = "right_" if legs == 2 else ""
    motion = solve(design, np.array([0.0]))
    pedal = motion.points["pedal"].value[0]
    assert data.site(f"{prefix}shank_pedal").xpos[[0, 2]] == pytest.approx([pedal.real, pedal.imag], abs=1e-12)
    assert data.joint("crank").qvel[0] == pytest.approx(design.linkage.cadence)


def test_two_legs_are_half_a_turn_apart(design: fes_mj.Design) -> None:
    model = build_mjcf(design, legs=2).compile()
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    late, early = solve(design, np.array([-np.pi])), solve(design, np.array([0.0]))
    assert data.joint("left_knee").qpos[0] == pytest.approx(float(late.joint_angle.knee[0]))
    assert data.joint("right_knee").qpos[0] == pytest.approx(float(early.joint_angle.knee[0]))


def test_masses_and_hinges_are_planar_and_complete(design: fes_mj.Design) -> None:
    model = build_mjcf(design).compile()
    for body, inertia in inertias(design).items():
        assert model.body(body).mass[0] == pytest.approx(inertia.mass)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    assert np.abs(np.abs(data.xaxis @ [0, 1, 0]) - 1).max() < 1e-15
    assert np.abs(data.xanchor[:, 1]).max() == 0


def test_drives_do_the_work_of_virtual_work(design: fes_mj.Design) -> None:
    """A unit hip or knee motor acts on the very coordinate phi_h or phi_k, extension positive."""
    model = build_mjcf(design).compile()
    data = mujoco.MjData(model)
    for joint in ("hip", "knee"):
        mujoco.mj_resetDataKeyframe(model, data, 0)
        data.ctrl[:] = 0
        data.actuator(joint).ctrl = 1.0
        mujoco.mj_forward(model, data)
        expected = np.zeros(model.nv)
        expected[model.joint(joint).dofadr[0]] = 1.0
        servo = data.actuator("crank_servo").force[0]
        expected[model.joint("crank").dofadr[0]] = servo
        assert data.qfrc_actuator == pytest.approx(expected)


@pytest.mark.parametrize("offset", [1e-9, 3e-7, 9e-7])
@pytest.mark.parametrize(("gamma_deg", "near"), [(90.0, 0.0), (0.0, math.sqrt(2) - 1), (180.0, 1.0)])
def test_no_offset_is_too_small_for_the_compiler(offset: float, gamma_deg: float, near: float) -> None:
    """The pedal beside the rocker joint, beside the coupler's centre of mass; and that beside the rocker joint."""
    coupler = 0.20
    linkage = fes_mj.Linkage(
        "cdt", -0.55 + 0.2j, 0.06, 0.08, -0.3 + 0j, near * coupler + offset, coupler, 0.2, math.radians(gamma_deg)
    )
    design = fes_mj.Design("small", linkage, fes_mj.Rider(0.5, 0.5))
    model = build_mjcf(design).compile()
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    mujoco.mj_forward(model, data)
    assert np.abs(data.efc_pos[data.efc_type == mujoco.mjtConstraint.mjCNSTR_EQUALITY]).max() < 1e-12
    motion, part = solve(design, np.zeros(1)), inertias(design)["coupler"]
    centre = motion.body_point("coupler", part.centre).value[0]
    assert data.xipos[model.body("coupler").id][[0, 2]] == pytest.approx([centre.real, centre.imag], abs=1e-12)
