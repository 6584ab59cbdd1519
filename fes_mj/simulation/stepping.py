"""Stepping a model with feedback on its joint motors, and what is recorded of it."""

from collections.abc import Callable
from copy import copy
from typing import Any, NamedTuple, TypeAlias, cast

import mujoco
import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.common.errors import UnstableError
from fes_mj.linkage.legs import Leg
from fes_mj.linkage.torque_source import LegControl, TorqueSource

# An exact pose with exact velocities still rings for a few steps, while the stiff loops find their forces.
PRE_ROLL = 20  # steps
FORCE_EVERY = 8  # steps; reading the constraint forces costs a tenth of a step
# MuJoCo softens a constraint by a ten-thousandth of its bodies' inverse weights: too much for a loop near its dead
# centre, which is as soft in one direction by itself. A hundredth of this factor changes nothing.
LOOP_SOFTNESS = 1e-4


class Run(NamedTuple):
    """Sensor rows of all steps, one before and one after, energies (J), recorded fields (rows, size) by name."""

    sensors: FloatArray
    start_energy: tuple[float, float]  # potential, kinetic
    end_energy: tuple[float, float]
    fields: dict[str, FloatArray]


# Steps a model so many times; gives the sensor rows of each step, a row that is left free, and recorded fields of some.
Records: TypeAlias = dict[str, FloatArray]
Loop: TypeAlias = Callable[[mujoco.MjModel, mujoco.MjData, int], tuple[FloatArray, Records]]
# Given a model, its data and a view of the speeds at the positions' own time: what sets the controls before each step.
Control: TypeAlias = Callable[[mujoco.MjModel, mujoco.MjData, Any], Callable[[], None]]
# Makes a loop that drives these legs.
LoopMaker: TypeAlias = Callable[[TorqueSource, tuple[Leg, ...]], Loop]


def feedback_loop(
    torque: TorqueSource, legs: tuple[Leg, ...], record: tuple[str, ...] = ("efc_force",), every: int = FORCE_EVERY
) -> Loop:
    """The loop in Python. Its records are fields of MjData after the first and then after each `every` steps.

    record: names of these, each of constant size. With muscles also `activation` of all legs in every step, shape
    (steps, groups of all legs).
    """
    controls: list[LegControl] = []  # made for the first of several calls, as they remember

    def control(model: mujoco.MjModel, data: mujoco.MjData, speeds: Any) -> Callable[[], None]:
        controls.extend([] if controls else (torque.control(leg, model.opt.timestep) for leg in legs))
        return actuation(dict(zip(legs, controls, strict=True)), model, data, speeds)

    def loop(model: mujoco.MjModel, data: mujoco.MjData, count: int) -> tuple[FloatArray, Records]:
        sensors, records = stepped(model, data, count)
        if controls[0].activation:
            records["activation"] = np.hstack([control.activation[-count:] for control in controls])
        return sensors, records

    stepped = controlled_loop(control, record, every)
    return loop


def actuation(
    controls: dict[Leg, LegControl], model: mujoco.MjModel, data: mujoco.MjData, speeds: Any
) -> Callable[[], None]:
    """What sets the motors of legs, by the positions of the data and a view of speeds."""
    position_of, ctrl = memoryview(data.qpos), cast("Any", memoryview(data.ctrl))
    crank = int(model.joint("crank").qposadr[0])
    drives = [
        (control.moments, drive_addresses(model, f"{leg.prefix}knee"), drive_addresses(model, f"{leg.prefix}hip"))
        for leg, control in controls.items()
    ]

    def act() -> None:
        angle = position_of[crank]
        for moments, (knee, knee_at, knee_rate), (hip, hip_at, hip_rate) in drives:
            ctrl[knee], ctrl[hip] = moments(
                angle, position_of[knee_at], position_of[hip_at], speeds[knee_rate], speeds[hip_rate]
            )

    return act


def controlled_loop(control: Control, record: tuple[str, ...] = (), every: int = FORCE_EVERY) -> Loop:
    """A loop that asks `control` before each step; record, every: as of feedback_loop."""

    def loop(model: mujoco.MjModel, data: mujoco.MjData, count: int) -> tuple[FloatArray, Records]:
        # plain floats through memory views and rows as bytes cost half of numpy scalars and row assignment
        qvel, acceleration, lead, held = data.qvel, data.qacc, np.empty(model.nv), np.empty(model.nv)
        act = control(model, data, memoryview(lead.data))
        position, position_sensors, velocity = mujoco.mj_fwdPosition, mujoco.mj_sensorPos, mujoco.mj_fwdVelocity
        velocity_sensors, second = mujoco.mj_sensorVel, mujoco.mj_step2
        read, half = data.sensordata.tobytes, model.opt.timestep / 2
        speed, servo_speed, servos = memoryview(qvel), cast("Any", memoryview(data.actuator_velocity)), servos_of(model)
        width, place = data.sensordata.nbytes, 0
        sensors = bytearray((count + 1) * width)
        fields: dict[str, list[bytes]] = {name: [] for name in record}
        for number in range(count):
            # MuJoCo's speeds lag its positions by half a step: with those at the positions' own time, moments and
            # centrifugal forces are of second order. A servo holds the speed that is integrated: told another one it
            # would ring. What mj_step1 does beyond this is a look for bad states, of which mj_step2 has another.
            np.multiply(acceleration, half, out=lead)
            np.add(lead, qvel, out=lead)
            act()
            position(model, data)
            position_sensors(model, data)
            held[:] = qvel
            qvel[:] = lead
            velocity(model, data)
            qvel[:] = held
            for servo, dof in servos:
                servo_speed[servo] = speed[dof]
            velocity_sensors(model, data)
            second(model, data)
            sensors[place : place + width] = read()
            place += width
            if not number % every:
                for name, rows in fields.items():
                    rows.append(getattr(data, name).tobytes())
        records: Records = {name: np.frombuffer(b"".join(rows)).reshape(len(rows), -1) for name, rows in fields.items()}
        return np.frombuffer(sensors).reshape(count + 1, -1), records

    return loop


def servos_of(model: mujoco.MjModel) -> list[tuple[int, int]]:
    """Index of every actuator whose force goes by the speed of its joint, and of this in qvel."""
    joint = model.actuator_trnid[:, 0]
    return [(int(servo), int(model.jnt_dofadr[joint[servo]])) for servo in np.flatnonzero(model.actuator_biastype)]


def drive_addresses(model: mujoco.MjModel, name: str) -> tuple[int, int, int]:
    """Index of the motor of a joint in ctrl, of the joint in qpos and in qvel."""
    joint = model.joint(name)
    return int(model.actuator(name).id), int(joint.qposadr[0]), int(joint.dofadr[0])


def run_loop(model: mujoco.MjModel, loop: Loop, steps: int, pre_roll: int = PRE_ROLL) -> Run:
    """Pre-roll from the keyframe, then record so many steps of `loop`. Raises UnstableError."""
    model = copy(model)
    for inverse_weights in (model.body_invweight0, model.dof_invweight0, model.tendon_invweight0):
        inverse_weights *= LOOP_SOFTNESS
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    previous = mujoco.get_mju_user_warning()
    mujoco.set_mju_user_warning(lambda _: None)  # MuJoCo would write MUJOCO_LOG.TXT into the user's folder
    try:
        before, _ = loop(model, data, pre_roll)
        start = energy(model, data, model.opt.timestep / 2)
        sensors, fields = loop(model, data, steps)
        if data.warning.number.any():
            raise UnstableError(
                f"{model.names[: model.names.index(0)].decode()}: the simulation became unstable "
                f"with a time step of {1e3 * model.opt.timestep:.3g} ms; a shorter one may do"
            )
        end = energy(model, data, model.opt.timestep / 2)
        mujoco.mj_forward(model, data)
    finally:
        mujoco.set_mju_user_warning(previous)
    sensors[-1] = data.sensordata
    return Run(np.vstack([before[-2:-1], sensors]), start, end, fields)


def energy(model: mujoco.MjModel, data: mujoco.MjData, lag: float = 0.0) -> tuple[float, float]:
    """Potential and kinetic energy of the current state, J; state and accelerations are left alone.

    lag: time by which the speeds are behind the positions, s.
    """
    held = data.qvel.copy()
    data.qvel += lag * data.qacc
    mujoco.mj_fwdPosition(model, data)
    mujoco.mj_energyPos(model, data)
    mujoco.mj_energyVel(model, data)
    data.qvel[:] = held
    return float(data.energy[0]), float(data.energy[1])


class Sensors:
    """Rows of MjData.sensordata, shape (rows, size), and the model they are of."""

    def __init__(self, model: Any, rows: FloatArray) -> None:
        self._rows = rows
        self._column = {model.sensor(i).name: int(model.sensor(i).adr[0]) for i in range(model.nsensor)}
        self.names = [*self._column]
        self.joints = [model.joint(i).name for i in range(model.njnt)]

    def __getitem__(self, name: str) -> FloatArray:
        """A sensor of one number, shape (rows,)."""
        return self._rows[:, self._column[name]]

    def vector(self, name: str) -> FloatArray:
        """A sensor of three numbers, shape (rows, 3)."""
        start = self._column[name]
        return self._rows[:, start : start + 3]

    def speed(self, joint: str) -> FloatArray:
        """Speed of a joint at the time of its angle, rad/s, shape (rows - 2,): MuJoCo's lag by half a step."""
        return self.following_speed(joint)[1:]

    def following_speed(self, joint: str) -> FloatArray:
        """The same from the first row on, shape (rows - 1,)."""
        lagging = self[f"{joint}_speed"]
        return (lagging[:-1] + lagging[1:]) / 2

    def crank_moment(self) -> FloatArray:
        """Moment on the load, N m, shape (rows,): the frame brakes the crank about +y, against its turning about -y."""
        return self.vector("crank_torque")[:, 1]
