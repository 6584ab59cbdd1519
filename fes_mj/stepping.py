"""Stepping a model with feedback on its joint motors, and what is recorded of it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import mujoco
import numpy as np
from numpy.typing import NDArray

from fes_mj.errors import UnstableError
from fes_mj.torque import TorqueMap

# An exact pose with exact velocities still rings for some six steps, while the stiff loops find their forces.
PRE_ROLL = 20  # steps
FORCE_EVERY = 8  # steps; reading the constraint forces costs a tenth of a step


class Run(NamedTuple):
    """Records of a run: sensor rows of all steps and one more, energies (J), recorded fields (rows, size) by name."""

    sensors: NDArray[np.float64]
    start_energy: tuple[float, float]  # potential, kinetic
    end_energy: tuple[float, float]
    fields: dict[str, NDArray[np.float64]]


# Steps a model so many times; gives the sensor rows of each step and the recorded fields of some.
Records = dict[str, NDArray[np.float64]]
Loop = Callable[[mujoco.MjModel, mujoco.MjData, int], tuple[NDArray[np.float64], Records]]
# Makes a loop that drives the given joints (name -> "knee" or "hip") by a torque map.
LoopMaker = Callable[[TorqueMap, dict[str, str]], Loop]


def feedback_loop(torque_map: TorqueMap, drives: dict[str, str]) -> Loop:
    """The loop in Python, the recorded field the constraint forces."""
    return recording_loop({name: torque_map.feedback(joint) for name, joint in drives.items()})


def recording_loop(
    feedback: dict[str, Callable[[float, float], float]],
    record: tuple[str, ...] = ("efc_force",),
    every: int = FORCE_EVERY,
) -> Loop:
    """A loop in which `feedback` maps a joint's angle and speed to the motor of the same name.

    record: fields of MjData to read, each of constant size, after the first and then after each `every` steps.
    """

    def loop(model: mujoco.MjModel, data: mujoco.MjData, count: int) -> tuple[NDArray[np.float64], Records]:
        # plain floats through memory views and rows as bytes cost half of numpy scalars and row assignment
        qpos, qvel = memoryview(data.qpos), memoryview(data.qvel)
        ctrl: Any = memoryview(data.ctrl)
        drives = [(*drive_addresses(model, name), moment) for name, moment in feedback.items()]
        step, read = mujoco.mj_step, data.sensordata.tobytes
        sensors: list[bytes] = []
        fields: dict[str, list[bytes]] = {name: [] for name in record}
        for number in range(count):
            for actuator, position, speed, moment in drives:
                ctrl[actuator] = moment(qpos[position], qvel[speed])
            step(model, data)
            sensors.append(read())
            if not number % every:
                for name, rows in fields.items():
                    rows.append(getattr(data, name).tobytes())
        return _matrix(sensors), {name: _matrix(rows) for name, rows in fields.items()}

    return loop


def drive_addresses(model: mujoco.MjModel, name: str) -> tuple[int, int, int]:
    """Index of the motor of a joint in ctrl, of the joint in qpos and in qvel."""
    joint = model.joint(name)
    return int(model.actuator(name).id), int(joint.qposadr[0]), int(joint.dofadr[0])


def run_loop(model: mujoco.MjModel, loop: Loop, steps: int) -> Run:
    """Pre-roll from the keyframe, then record so many steps of `loop`. Raises UnstableError."""
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    previous = mujoco.get_mju_user_warning()
    mujoco.set_mju_user_warning(lambda _: None)  # MuJoCo would write MUJOCO_LOG.TXT into the user's folder
    try:
        loop(model, data, PRE_ROLL)
        start = _energy(model, data)
        sensors, fields = loop(model, data, steps)
        if any(warning.number for warning in data.warning):
            raise UnstableError(
                f"{model.names[: model.names.index(0)].decode()}: the simulation became unstable "
                f"with a time step of {1e3 * model.opt.timestep:.3g} ms; give a smaller --timestep"
            )
        end = _energy(model, data)
        mujoco.mj_forward(model, data)
    finally:
        mujoco.set_mju_user_warning(previous)
    return Run(np.vstack([sensors, data.sensordata]), start, end, fields)


def _matrix(rows: list[bytes]) -> NDArray[np.float64]:
    return np.frombuffer(b"".join(rows), np.float64).reshape(len(rows), -1)


def _energy(model: mujoco.MjModel, data: mujoco.MjData) -> tuple[float, float]:
    """Potential and kinetic energy of the current state, J; the state itself is left alone."""
    probe = mujoco.MjData(model)
    probe.qpos, probe.qvel = data.qpos, data.qvel
    mujoco.mj_forward(model, probe)
    mujoco.mj_energyPos(model, probe)
    mujoco.mj_energyVel(model, probe)
    return float(probe.energy[0]), float(probe.energy[1])
