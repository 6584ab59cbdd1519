"""The simulation's inner loop in machine code (numba): the torque map and mj_step by its C address, without Python."""

import ctypes
import math
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any, TypeAlias

import mujoco
import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.common.errors import require_extra
from fes_mj.linkage.joints import JOINTS
from fes_mj.moments.torque_map import TorqueMap, scalar_map
from fes_mj.simulation.stepping import FORCE_EVERY, Loop, Records, drive_addresses

# Given what makes machine code of Python functions: the function that sets the controls before each step, called with
# arguments of its own, the positions, the speeds at the positions' own time, and the controls.
MakeControl: TypeAlias = Callable[[Callable[[Any], Any]], Callable[..., None]]


def compiled_loop(torque: TorqueMap, drives: dict[str, str]) -> Loop:
    """The loop of stepping.feedback_loop for the drives (joint name -> "knee" or "hip") under a torque map.

    It releases Python's lock: loops run side by side in threads. Raises MissingPartError without numba.
    """
    if torque.moments.torque_velocity is not None:
        raise ValueError("the compiled loop takes moments that do not depend on speed")
    if torque.moments.left is not None:
        raise ValueError("the compiled loop takes the same moments for both legs")
    knee, hip = ((torque.parameters(joint), torque.table[joint]) for joint in JOINTS)
    kinds = np.array([JOINTS.index(joint) for joint in drives.values()])

    def arguments(model: mujoco.MjModel) -> tuple[Any, ...]:
        return np.array([drive_addresses(model, name) for name in drives]), kinds, knee, hip

    return compiled_controlled_loop(_map_control, arguments, forces=True)


def compiled_controlled_loop(
    make_control: MakeControl, arguments: Callable[[mujoco.MjModel], tuple[Any, ...]], forces: bool
) -> Loop:
    """The loop of stepping.controlled_loop in machine code.

    arguments: of the control, for a model. forces: record the constraint forces, whose number must not change.
    """
    advance = _advance(make_control)

    def loop(model: mujoco.MjModel, data: mujoco.MjData, count: int) -> tuple[FloatArray, Records]:
        acceleration = data.qacc.copy()  # of the step before, which the next one needs
        mujoco.mj_forward(model, data)  # makes the constraints, whose number and place in memory then stay
        data.qacc[:] = acceleration
        force = data.efc_force if forces else np.empty(0)
        sensor_rows = np.empty((count + 1, model.nsensordata))
        force_rows = np.empty((-(-count // FORCE_EVERY) if forces else 0, len(force)))
        state = (data.qpos, data.qvel, data.qacc, data.qfrc_bias, data.ctrl, data.sensordata, force)
        pointers = (model._address, data._address)
        advance(model.opt.timestep / 2, pointers, arguments(model), state, (sensor_rows, force_rows))
        if forces and data.efc_force.ctypes.data != force.ctypes.data:
            raise AssertionError("MuJoCo moved its constraint forces during a run")
        return sensor_rows, {"efc_force": force_rows} if forces else {}

    return loop


def _map_control(compiled: Callable[[Any], Any]) -> Callable[..., None]:
    """Moments of the torque map."""

    @compiled
    def acos(value: float) -> float:
        return math.acos(min(1.0, max(-1.0, value)))

    knee_map, hip_map = (scalar_map(joint, acos, compiled) for joint in JOINTS)

    @compiled
    def control(arguments: Any, qpos: Any, speeds: Any, ctrl: Any) -> None:
        addresses, kinds, knee, hip = arguments
        for drive in range(len(kinds)):
            actuator, position, speed = addresses[drive]
            if kinds[drive] == 0:
                ctrl[actuator] = knee_map(knee[0], knee[1], qpos[position], speeds[speed])
            else:
                ctrl[actuator] = hip_map(hip[0], hip[1], qpos[position], speeds[speed])

    result: Callable[..., None] = control
    return result


@cache
def _advance(make_control: MakeControl) -> Callable[..., None]:
    njit: Any = require_extra("optimize", "numba").njit
    library, address = ctypes.CDLL(str(_library())), ctypes.c_ssize_t
    first, second, velocities, bias_force = library.mj_step1, library.mj_step2, library.mj_comVel, library.mj_rne
    for function in (first, second, velocities, bias_force):
        function.argtypes, function.restype = (address, address), None
    bias_force.argtypes = (address, address, ctypes.c_int, address)
    control = make_control(njit)

    @njit(nogil=True)  # type: ignore[untyped-decorator]
    def advance(half: float, pointers: Any, arguments: Any, state: Any, records: Any) -> None:
        model, data = pointers
        qpos, qvel, acceleration, bias, ctrl, sensors, forces = state
        sensor_rows, force_rows = records
        held, lead = np.empty(len(qvel)), np.empty(len(qvel))
        for row in range(len(sensor_rows) - 1):
            lead[:] = qvel + half * acceleration  # as in stepping.controlled_loop
            control(arguments, qpos, lead, ctrl)
            first(model, data)
            held[:] = qvel
            qvel[:] = lead
            velocities(model, data)
            bias_force(model, data, 0, bias.ctypes.data)
            qvel[:] = held
            second(model, data)
            sensor_rows[row] = sensors
            if len(force_rows) and not row % FORCE_EVERY:
                force_rows[row // FORCE_EVERY] = forces

    compiled: Callable[..., None] = advance
    return compiled


def _library() -> Path:
    """MuJoCo's shared library, beside its Python bindings."""
    folder = Path(mujoco.__file__).parent
    return next(
        path for pattern in ("libmujoco*.so*", "libmujoco*.dylib", "mujoco.dll") for path in folder.glob(pattern)
    )
