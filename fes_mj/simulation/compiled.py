"""The simulation's inner loop in machine code (numba): the torque map and mj_step by its C address, without Python."""

from __future__ import annotations

import ctypes
import math
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import mujoco
import numpy as np

from fes_mj.arrays import FloatArray
from fes_mj.errors import require_extra
from fes_mj.joints import JOINTS
from fes_mj.simulation.stepping import FORCE_EVERY, Loop, Records, drive_addresses
from fes_mj.torque_map import TorqueMap, scalar_map


def compiled_loop(torque: TorqueMap, drives: dict[str, str]) -> Loop:
    """The loop of stepping.feedback_loop for the drives (joint name -> "knee" or "hip") under a torque map.

    It releases Python's lock: loops run side by side in threads. Raises MissingPartError without numba.
    """
    if torque.moments.torque_velocity is not None:
        raise ValueError("the compiled loop takes moments that do not depend on speed")
    advance = _advance()
    maps = [item for joint in JOINTS for item in (torque.parameters(joint), torque.table[joint])]
    kinds = np.array([JOINTS.index(joint) for joint in drives.values()])

    def loop(model: mujoco.MjModel, data: mujoco.MjData, count: int) -> tuple[FloatArray, Records]:
        addresses = np.array([drive_addresses(model, name) for name in drives])
        mujoco.mj_forward(model, data)  # makes the constraints, whose number and place in memory then stay
        forces = data.efc_force
        sensor_rows = np.empty((count + 1, model.nsensordata))
        force_rows = np.empty((-(-count // FORCE_EVERY), len(forces)))
        state = (data.qpos, data.qvel, data.ctrl, data.sensordata, forces)
        advance(model._address, data._address, addresses, kinds, *maps, *state, sensor_rows, force_rows)
        if data.efc_force.ctypes.data != forces.ctypes.data:
            raise AssertionError("MuJoCo moved its constraint forces during a run")
        return sensor_rows, {"efc_force": force_rows}

    return loop


@cache
def _advance() -> Callable[..., None]:
    njit: Any = require_extra("optimize", "numba").njit
    step = ctypes.CDLL(str(_library())).mj_step
    step.argtypes, step.restype = (ctypes.c_ssize_t, ctypes.c_ssize_t), None

    @njit  # type: ignore[untyped-decorator]
    def acos(value: float) -> float:
        return math.acos(min(1.0, max(-1.0, value)))

    knee_map, hip_map = (scalar_map(joint, acos, njit) for joint in JOINTS)

    @njit(nogil=True)  # type: ignore[untyped-decorator]
    def advance(
        model: int,
        data: int,
        addresses: Any,
        kinds: Any,
        knee_where: Any,
        knee_table: Any,
        hip_where: Any,
        hip_table: Any,
        qpos: Any,
        qvel: Any,
        ctrl: Any,
        sensors: Any,
        forces: Any,
        sensor_rows: Any,
        force_rows: Any,
    ) -> None:
        for row in range(len(sensor_rows) - 1):
            for drive in range(len(kinds)):
                actuator, position, speed = addresses[drive]
                if kinds[drive] == 0:
                    ctrl[actuator] = knee_map(knee_where, knee_table, qpos[position], qvel[speed])
                else:
                    ctrl[actuator] = hip_map(hip_where, hip_table, qpos[position], qvel[speed])
            step(model, data)
            sensor_rows[row] = sensors
            if not row % FORCE_EVERY:
                force_rows[row // FORCE_EVERY] = forces

    return advance


def _library() -> Path:
    """MuJoCo's shared library, beside its Python bindings."""
    folder = Path(mujoco.__file__).parent
    return next(
        path for pattern in ("libmujoco*.so*", "libmujoco*.dylib", "mujoco.dll") for path in folder.glob(pattern)
    )
