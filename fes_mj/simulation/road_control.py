"""What the rider's muscles and the freewheel do in each step of a ride in MuJoCo."""

from typing import Any, NamedTuple

import mujoco
import numpy as np

from fes_mj.common.arrays import FloatArray, IntArray
from fes_mj.common.machine_code import machine_code
from fes_mj.linkage.legs import TWO_LEGS
from fes_mj.moments.drive import drive
from fes_mj.riding.lookup import DRIVEN, between, place
from fes_mj.riding.ride import Ride
from fes_mj.simulation.road_mjcf import ROAD
from fes_mj.simulation.stepping import drive_addresses


class RoadControl(NamedTuple):
    """What the control knows of a ride and its model; arrays by DRIVEN.

    travel: m/rad. road, crank: addresses of the joints' positions; so actuator, of the motors. leg_lag: rad. moment:
    N m over a turn of the own leg's crank, shape (4, cells + 1).
    """

    fixed: bool
    travel: float
    road: int
    crank: int
    actuator: IntArray
    leg_lag: FloatArray
    moment: FloatArray


class Memory(NamedTuple):
    """What changes from step to step. limit: range of the tendon from road to crank, rad, of which the first moves."""

    limit: FloatArray


def road_control(ride: Ride, model: mujoco.MjModel) -> RoadControl:
    """The control of a ride in its model."""
    cells = len(ride.table.ahead)
    drives = {leg: drive(ride.design, ride.moments.of_leg(leg.prefix), cells) for leg in TWO_LEGS}
    moments = [drives[leg].moment[joint] for leg, joint in DRIVEN]
    return RoadControl(
        fixed=ride.fixed,
        travel=ride.travel,
        road=int(model.joint(ROAD).qposadr[0]),
        crank=int(model.joint("crank").qposadr[0]),
        actuator=np.array([drive_addresses(model, leg.prefix + joint)[0] for leg, joint in DRIVEN]),
        leg_lag=np.array([leg.lag for leg, _ in DRIVEN]),
        moment=np.array([np.append(moment, moment[0]) for moment in moments]),
    )


def memory_of(model: mujoco.MjModel) -> Memory:
    """That of a ride that begins."""
    return Memory(model.tendon_range.reshape(-1))


@machine_code
def act(control: RoadControl, memory: Memory, qpos: Any, speeds: Any, ctrl: Any) -> None:
    """Set the moments, and keep the freewheel's limit at the length reached.

    qpos, speeds: positions, and speeds at their own time. ctrl: of the motors, N m.
    """
    angle = qpos[control.crank]
    if not control.fixed:
        memory.limit[0] = max(memory.limit[0], qpos[control.road] / control.travel - angle)
    for driven in range(len(control.actuator)):
        curve = control.moment[driven]
        row, part = place(angle - control.leg_lag[driven], len(curve) - 1)
        ctrl[control.actuator[driven]] = between(curve, row, part)
