"""The inner loops of bench and road in machine code (numba), with MuJoCo's steps by their C names, without Python.

Importing this raises MissingPartError without numba.
"""

import math
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple, TypeAlias

import mujoco
import numpy as np

from fes_mj.common.arrays import FloatArray, IntArray
from fes_mj.common.errors import require_extra
from fes_mj.common.machine_code import inlined_machine_code, kept_machine_code, machine_code
from fes_mj.linkage.joints import JOINTS
from fes_mj.linkage.legs import Leg
from fes_mj.linkage.torque_source import TorqueSource
from fes_mj.moments.torque_map import TorqueMap, scalar_map
from fes_mj.simulation.bench import joint_drives
from fes_mj.simulation.road_control import RoadControl, RoadMemory, act, memory_of
from fes_mj.simulation.stepping import FORCE_EVERY, Loop, Records, drive_addresses, servos_of

_numba: Any = require_extra("optimize", "numba", "llvmlite")


_names = ("libmujoco*.so*", "libmujoco*.dylib", "mujoco.dll")  # of MuJoCo's library, beside its Python bindings
_library = next(path for name in _names for path in Path(mujoco.__file__).parent.glob(name))
require_extra("optimize", "llvmlite.binding").load_library_permanently(str(_library))
_address = _numba.types.intp
_of_model_and_data = _numba.types.void(_address, _address)
_position, _position_sensors, _velocity, _velocity_sensors, _step2 = (
    _numba.types.ExternalFunction(name, _of_model_and_data)
    for name in ("mj_fwdPosition", "mj_sensorPos", "mj_fwdVelocity", "mj_sensorVel", "mj_step2")
)


class Fields(NamedTuple):
    """What of MjData a loop reads and writes; lead: speeds at the positions' own time, held: those of MuJoCo.

    servos: of stepping.servos_of, shape (servos, 2).
    """

    qpos: FloatArray
    qvel: FloatArray
    qacc: FloatArray
    ctrl: FloatArray
    actuator_velocity: FloatArray
    sensordata: FloatArray
    efc_force: FloatArray
    lead: FloatArray
    held: FloatArray
    servos: IntArray


# Steps a model: half a time step, addresses of model and data, arguments of the control, fields, rows of sensors and
# constraint forces to fill.
Advance: TypeAlias = Callable[[float, tuple[int, int], Any, Fields, FloatArray, FloatArray], None]


@inlined_machine_code
def lead_speeds(half: float, fields: Fields) -> None:
    """Find the speeds at the positions' own time, as in stepping.controlled_loop."""
    for i in range(len(fields.lead)):
        fields.lead[i] = fields.qvel[i] + half * fields.qacc[i]


@inlined_machine_code
def step(pointers: tuple[int, int], fields: Fields) -> None:
    """Step the model with the forces of the speeds that `lead_speeds` found, as in stepping.controlled_loop."""
    model, data = pointers
    _position(model, data)
    _position_sensors(model, data)
    for i in range(len(fields.held)):
        fields.held[i], fields.qvel[i] = fields.qvel[i], fields.lead[i]
    _velocity(model, data)
    for i in range(len(fields.held)):
        fields.qvel[i] = fields.held[i]
    for row in range(len(fields.servos)):
        fields.actuator_velocity[fields.servos[row, 0]] = fields.qvel[fields.servos[row, 1]]
    _velocity_sensors(model, data)
    _step2(model, data)


@inlined_machine_code
def record(row: int, fields: Fields, sensor_rows: FloatArray, force_rows: FloatArray) -> None:
    """Keep the sensors, and of every so many steps the constraint forces."""
    for i in range(sensor_rows.shape[1]):
        sensor_rows[row, i] = fields.sensordata[i]
    if len(force_rows) and not row % FORCE_EVERY:
        for i in range(force_rows.shape[1]):
            force_rows[row // FORCE_EVERY, i] = fields.efc_force[i]


def compiled_loop(torque: TorqueSource, legs: tuple[Leg, ...]) -> Loop:
    """The loop of stepping.feedback_loop for these legs under a torque map.

    It releases Python's lock: loops run side by side in threads.
    """
    if not isinstance(torque, TorqueMap):
        raise TypeError("the compiled loop takes a torque map")
    if torque.moments.left is not None:
        raise ValueError("the compiled loop takes the same moments for both legs")
    drives = joint_drives(legs)
    knee, hip = ((torque.reference.parameters(joint), torque.table[joint]) for joint in JOINTS)
    kinds = np.array([JOINTS.index(joint) for joint in drives.values()])

    def arguments(model: mujoco.MjModel) -> tuple[Any, ...]:
        return np.array([drive_addresses(model, name) for name in drives]), kinds, knee, hip

    return compiled_controlled_loop(_map_advance(), arguments, forces=True)


def compiled_controlled_loop(
    advance: Advance, arguments: Callable[[mujoco.MjModel], tuple[Any, ...]], forces: bool
) -> Loop:
    """The loop of stepping.controlled_loop around `advance`, which is in machine code.

    arguments: of its control, for a model. forces: record the constraint forces, whose number must not change.
    """

    def loop(model: mujoco.MjModel, data: mujoco.MjData, count: int) -> tuple[FloatArray, Records]:
        acceleration = data.qacc.copy()  # of the step before, which the next one needs
        mujoco.mj_forward(model, data)  # makes the constraints, whose number and place in memory then stay
        data.qacc[:] = acceleration
        force = data.efc_force if forces else np.empty(0)
        sensor_rows = np.empty((count + 1, model.nsensordata))
        force_rows = np.empty((-(-count // FORCE_EVERY) if forces else 0, len(force)))
        lead, held = np.empty((2, model.nv))
        fields = Fields(
            data.qpos,
            data.qvel,
            data.qacc,
            data.ctrl,
            data.actuator_velocity,
            data.sensordata,
            force,
            lead,
            held,
            np.array(servos_of(model), int).reshape(-1, 2),
        )
        pointers = (model._address, data._address)
        advance(model.opt.timestep / 2, pointers, arguments(model), fields, sensor_rows, force_rows)
        if forces and data.efc_force.ctypes.data != force.ctypes.data:
            raise AssertionError("MuJoCo moved its constraint forces during a run")
        return sensor_rows, {"efc_force": force_rows} if forces else {}

    return loop


@cache
def _map_advance() -> Advance:
    """Steps under the moments of the torque map."""

    @inlined_machine_code
    def acos(value: float) -> float:
        return math.acos(min(1.0, max(-1.0, value)))

    knee_map, hip_map = (scalar_map(joint, acos, inlined_machine_code) for joint in JOINTS)

    @inlined_machine_code
    def control(arguments: Any, qpos: Any, speeds: Any, ctrl: Any) -> None:
        addresses, kinds, knee, hip = arguments
        for drive in range(len(kinds)):
            actuator, position, speed = addresses[drive]
            if kinds[drive] == 0:
                ctrl[actuator] = knee_map(knee[0], knee[1], qpos[position], speeds[speed])
            else:
                ctrl[actuator] = hip_map(hip[0], hip[1], qpos[position], speeds[speed])

    @machine_code
    def advance(half: float, pointers: Any, arguments: Any, fields: Any, sensor_rows: Any, force_rows: Any) -> None:
        for row in range(len(sensor_rows) - 1):
            lead_speeds(half, fields)
            control(arguments, fields.qpos, fields.lead, fields.ctrl)
            step(pointers, fields)
            record(row, fields, sensor_rows, force_rows)

    return advance


def compiled_road_loop(make_control: Callable[[mujoco.MjModel], RoadControl]) -> Loop:
    """The loop of a ride under its control; its machine code is kept on disk."""
    return compiled_controlled_loop(_road_advance, lambda model: (make_control(model), memory_of(model)), forces=False)


@kept_machine_code()
def _road_advance(
    half: float,
    pointers: tuple[int, int],
    arguments: tuple[RoadControl, RoadMemory],
    fields: Fields,
    sensor_rows: Any,
    force_rows: Any,
) -> None:
    control, memory = arguments
    for row in range(len(sensor_rows) - 1):
        lead_speeds(half, fields)
        act(control, memory, fields.qpos, fields.lead, fields.ctrl)
        step(pointers, fields)
        record(row, fields, sensor_rows, force_rows)
