"""MuJoCo's own muscles against the muscles that they were fitted to: every error is the one that is stated."""

from __future__ import annotations

import json
import math
from functools import cache
from pathlib import Path

import mujoco
import numpy as np
import pytest

import fes_mj
from fes_mj.cli.app import run
from fes_mj.common.arrays import FloatArray
from fes_mj.common.checks import find
from fes_mj.common.errors import InputError
from fes_mj.linkage import kinematics
from fes_mj.muscles.anatomy import anatomy
from fes_mj.muscles.geometry import Flexion
from fes_mj.muscles.pull import pull
from fes_mj.muscles.timing import TURN_ANGLES
from fes_mj.simulation.native_fit import native_curve
from fes_mj.simulation.native_muscles import NativeMuscles, native_muscles
from fes_mj.statics.muscle_static import MuscleStatic

DESIGN = fes_mj.load_design("trt")
DRIVE = fes_mj.load_muscles()
CADENCE = DESIGN.linkage.cadence
MUSCLES = anatomy()


@cache
def fitted() -> NativeMuscles:
    return native_muscles(DESIGN, DRIVE, CADENCE)


@pytest.fixture(scope="module")
def exported(tmp_path_factory: pytest.TempPathFactory) -> tuple[mujoco.MjModel, dict[str, FloatArray]]:
    path = tmp_path_factory.mktemp("muscles") / "trt.xml"
    files = fes_mj.export(DESIGN, DRIVE, path, variants=["muscles"])
    table = np.genfromtxt(files["table"], delimiter=",", names=True)
    return mujoco.MjModel.from_xml_path(str(path)), {name: table[name] for name in table.dtype.names}


def test_the_curves_are_those_of_mujoco() -> None:
    muscle = fitted().muscles[0]
    parameters = np.array([0.5, 1.5, 1.0, 1.0, 1 - muscle.width, 1 + muscle.width, 3.0, 1e-12, muscle.plateau])
    for length in np.linspace(0.1, 1.9, 19):
        for speed in np.linspace(-1.2, 1.2, 25):
            # the length range is that of 0.5 to 1.5 optimal lengths, of 1 m
            gain = mujoco.mju_muscleGain(length, 3.0 * speed, np.array([[0.5], [1.5]]), 1.0, parameters[:, None])
            own = native_curve(np.array(length), np.array(speed), muscle.width, muscle.plateau)
            assert own == pytest.approx(-gain, abs=1e-12)


def test_lengths_arms_and_forces_are_within_what_is_stated(
    exported: tuple[mujoco.MjModel, dict[str, FloatArray]],
) -> None:
    """In the loaded model, at the joint angles of its table; lengths less the slack that the range implies."""
    model, table = exported
    data, rider = mujoco.MjData(model), DRIVE.riders.most_probable
    scale, slack = MUSCLES.length_scale(DESIGN.rider).ravel(), rider.slack(MUSCLES).ravel()
    offset = math.radians(rider.values["hip_offset_deg"][0])
    along, arm, wanted_along, wanted_arm = [], [], [], []
    first, width = model.actuator_lengthrange[1:].T[0], np.ptp(model.actuator_lengthrange[1:], axis=1)
    for row in range(0, len(table["knee_deg"]), 4):
        knee, hip = (math.radians(table[f"{joint}_deg"][row]) for joint in ("knee", "hip"))
        data.joint("knee").qpos[0], data.joint("hip").qpos[0] = knee, hip
        mujoco.mj_forward(model, data)
        along.append(data.ten_length - (first - 0.5 * width))
        moments = np.zeros((model.nu, model.nv))
        mujoco.mju_sparse2dense(
            moments, data.actuator_moment, data.moment_rownnz, data.moment_rowadr, data.moment_colind
        )
        arm.append(moments[1:, [model.joint(joint).dofadr[0] for joint in ("knee", "hip")]])
        lengths = MUSCLES.lengths.at(Flexion(np.array([math.pi - hip + offset]), np.array([math.pi - knee])))
        wanted_along.append(scale * (lengths.value[:, 0] - slack))
        wanted_arm.append(-scale[:, None] * np.concatenate([lengths.by_knee, lengths.by_hip], axis=1))
    length_error = np.abs(np.array(along) - wanted_along).max(axis=0)
    arm_error = np.abs(np.array(arm) - wanted_arm).max(axis=(0, 2)) / np.abs(wanted_arm).max(axis=(0, 2))
    for muscle, length, moment_arm in zip(fitted().muscles, length_error, arm_error, strict=True):
        assert length == pytest.approx(muscle.length_error, rel=0.02, abs=1e-7)
        assert moment_arm == pytest.approx(muscle.arm_error, rel=0.02, abs=1e-4)


def test_forces_are_within_what_is_stated() -> None:
    """The curves at the exact lengths and speeds, beside the forces of the other implementation."""
    pulled = pull(DRIVE.riders.most_probable, kinematics.solve(DESIGN, TURN_ANGLES), CADENCE)
    rider = DRIVE.riders.most_probable
    isometric, slack = MUSCLES.force * rider.strength(MUSCLES).ravel(), rider.slack(MUSCLES).ravel()
    for row, muscle in enumerate(fitted().muscles):
        scale = pulled.scale[row].item()
        length = scale * (pulled.lengths.value[row, 0, 0] - slack[row]) / muscle.optimal
        speed = scale * pulled.speed[row, 0, 0] / (muscle.optimal * muscle.max_speed)
        own = muscle.force / isometric[row] * native_curve(length, speed, muscle.width, muscle.plateau)
        assert np.sqrt(np.mean((own - pulled.force[row, 0, 0] / isometric[row]) ** 2)) == pytest.approx(
            muscle.force_error, rel=1e-6
        )


def test_a_turn_that_is_played_back_has_the_power_that_is_stated(
    exported: tuple[mujoco.MjModel, dict[str, FloatArray]],
) -> None:
    """Plain steps of the file, activations straight between rows of its table; power where the crank meets its load."""
    model, table = exported
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    activation = np.stack([table[f"{muscle.name}_activation"] for muscle in fitted().muscles])
    rows, steps, power = activation.shape[1], round(2 * math.pi / CADENCE / model.opt.timestep), []
    for _ in range(8 + steps):  # the first ones settle the constraints
        before, share = divmod(math.degrees(data.joint("crank").qpos[0]) * rows / 360, 1)
        ends = activation[:, int(before) % rows], activation[:, int(before + 1) % rows]
        data.ctrl[1:] = (1 - share) * ends[0] + share * ends[1]
        mujoco.mj_step(model, data)
        power.append(data.sensor("crank_torque").data[1] * data.joint("crank").qvel[0])
    static = MuscleStatic.solve(DESIGN, DRIVE.riders, CADENCE, "best").summary()["power_mode_W"]
    summary = fitted().summary()
    assert summary["power_static_W"] == pytest.approx(static, rel=1e-12)
    limit = find("mean_power").limit * static
    assert np.mean(power[8:]) - static == pytest.approx(summary["power_difference_W"], abs=limit)


def test_the_command_states_the_difference(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    command = ["export", "trt", "-o", str(tmp_path / "a.xml"), "--variant", "muscles"]
    assert run(command) == 0
    sentence = f"({fitted().summary()['power_difference_W']:+.2f} W)"
    assert sentence in capsys.readouterr().out
    assert sentence in (tmp_path / "a.xml").read_text()
    assert run([*command, "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["native_muscles"][0].keys() >= {"name", "length_error_mm"}
    assert run([*command, "--moments", "mine.csv"]) == 2
    assert "--moments say nothing of muscles" in capsys.readouterr().err


def test_moments_that_have_no_activation_are_refused() -> None:
    with pytest.raises(InputError, match="timing by-angle"):
        native_muscles(DESIGN, fes_mj.load_muscles(timing="by-angle"), CADENCE)
