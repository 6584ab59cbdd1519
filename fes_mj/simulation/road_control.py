"""What the rider's muscles and the freewheel do in each step of a ride in MuJoCo."""

import math
from typing import Any, NamedTuple

import mujoco
import numpy as np

from fes_mj.common.arrays import FloatArray, IntArray
from fes_mj.common.machine_code import machine_code
from fes_mj.linkage.legs import TWO_LEGS
from fes_mj.moments.drive import drive
from fes_mj.moments.muscle_response import MUSCLES, Response, between, delivered, lead, place
from fes_mj.riding.ride import Ride
from fes_mj.simulation.road_mjcf import ROAD
from fes_mj.simulation.stepping import drive_addresses


class RoadControl(NamedTuple):
    """What the control knows of a ride and its model; arrays by MUSCLES.

    travel: m/rad. road, crank, crank_speed: addresses of the joints' positions and of a speed; so joint_speed and, of
    the motors, actuator. leg_lag: rad. command: N m over a turn of the own leg's crank, shape (4, cells + 1). kept:
    part of the distance to its command that a muscle's answer keeps in a step.
    """

    fixed: bool
    travel: float
    road: int
    crank: int
    crank_speed: int
    actuator: IntArray
    joint_speed: IntArray
    leg_lag: FloatArray
    command: FloatArray
    response: Response
    kept: float


class Memory(NamedTuple):
    """What changes from step to step. limit: range of the tendon from road to crank, rad, of which the first moves.

    answer, command: moments at rest by MUSCLES, N m; NaN before the first step.
    """

    limit: FloatArray
    answer: FloatArray
    command: FloatArray


def road_control(ride: Ride, model: mujoco.MjModel) -> RoadControl:
    """The control of a ride in its model."""
    cells = len(ride.table.ahead)
    drives = {leg: drive(ride.design, ride.moments.of_leg(leg.prefix), ride.lag, cells) for leg in TWO_LEGS}
    commands = [drives[leg].command[joint] for leg, joint in MUSCLES]
    actuators, _, speeds = np.array([drive_addresses(model, leg.prefix + joint) for leg, joint in MUSCLES]).T.copy()
    crank = model.joint("crank")
    return RoadControl(
        fixed=ride.fixed,
        travel=ride.travel,
        road=int(model.joint(ROAD).qposadr[0]),
        crank=int(crank.qposadr[0]),
        crank_speed=int(crank.dofadr[0]),
        actuator=actuators,
        joint_speed=speeds,
        leg_lag=np.array([leg.lag for leg, _ in MUSCLES]),
        command=np.array([np.append(command, command[0]) for command in commands]),
        response=Response.of(ride.moments, ride.lag),
        kept=math.exp(-model.opt.timestep / ride.lag) if ride.lag else 0.0,
    )


def memory_of(model: mujoco.MjModel) -> Memory:
    """That of a ride that begins."""
    return Memory(model.tendon_range.reshape(-1), *np.full((2, len(MUSCLES)), np.nan))


@machine_code
def act(control: RoadControl, memory: Memory, qpos: Any, speeds: Any, ctrl: Any) -> None:
    """Set the moments, and keep the freewheel's limit at the length reached.

    qpos, speeds: positions, and speeds at their own time. ctrl: of the motors, N m.
    """
    angle, response = qpos[control.crank], control.response
    if not control.fixed:
        memory.limit[0] = max(memory.limit[0], qpos[control.road] / control.travel - angle)
    ahead = angle + lead(response, speeds[control.crank_speed])
    for muscle in range(len(memory.answer)):
        curve = control.command[muscle]
        row, part = place(ahead - control.leg_lag[muscle], len(curve) - 1)
        moment = command = between(curve, row, part)
        if response.lag > 0:
            answer, before = memory.answer[muscle], memory.command[muscle]
            if not math.isnan(answer):  # exact for a command that stays at its mean over the step
                mean = (before + command) / 2
                moment = mean + control.kept * (answer - mean)
            memory.answer[muscle], memory.command[muscle] = moment, command
        rate = speeds[control.joint_speed[muscle]]
        ctrl[control.actuator[muscle]] = delivered(response, muscle, moment, rate)
