"""What the rider's muscles and the freewheel do in each step of a ride in MuJoCo."""

import math
from typing import Any, NamedTuple

import mujoco
import numpy as np

from fes_mj.common.arrays import FloatArray, IntArray
from fes_mj.common.machine_code import inlined_machine_code
from fes_mj.linkage.legs import TWO_LEGS
from fes_mj.moments.drive import drive as driven_by_moments
from fes_mj.moments.joint_moments import JointMoments
from fes_mj.muscles.anatomy import MUSCLE_GROUPS
from fes_mj.muscles.step import LegMuscles, activated, joint_moments, stimulation, weights
from fes_mj.riding.lookup import DRIVEN, between, place
from fes_mj.riding.ride import Ride
from fes_mj.riding.stimulated import NO_STIMULATOR, Stimulator, lead
from fes_mj.simulation.road_mjcf import ROAD
from fes_mj.simulation.stepping import drive_addresses


class RoadControl(NamedTuple):
    """What the control knows of a ride and its model; arrays by DRIVEN.

    travel: m/rad. road, crank, crank_speed: addresses of the joints' positions and of a speed; drives: those of
    drive_addresses, shape (4, 3). leg_lag: rad. moment: N m over a turn of the own leg's crank, shape (4, cells + 1);
    of a ride by muscles none, but `muscles` and their `stimulator`. rising, falling: step.weights of a time step.
    """

    fixed: bool
    travel: float
    road: int
    crank: int
    crank_speed: int
    drives: IntArray
    leg_lag: FloatArray
    moment: FloatArray
    muscles: LegMuscles
    stimulator: Stimulator
    rising: tuple[float, float, float]
    falling: tuple[float, float, float]


class RoadMemory(NamedTuple):
    """What changes from step to step. limit: range of the tendon from road to crank, rad, of which the first moves.

    activation, felt: of the groups and what they last felt of the stimulation, shape (legs, groups); NaN before the
    first step.
    """

    limit: FloatArray
    activation: FloatArray
    felt: FloatArray


_NO_MUSCLES = LegMuscles(
    group=np.zeros(0, int),
    knee_inside=np.zeros(0, bool),
    lengths=np.zeros((0, 1, 1)),
    **dict.fromkeys(("straight", "force", "optimal", "slack", "thickness", "max_speed"), np.zeros(0)),
    rise=1.0,
    fall=1.0,
    delay=0.0,
)


def road_control(ride: Ride, model: mujoco.MjModel) -> RoadControl:
    """The control of a ride in its model."""
    cells, drive, step = len(ride.table.ahead), ride.drive, float(model.opt.timestep)
    muscles, stimulator, moments = _NO_MUSCLES, NO_STIMULATOR, np.zeros((0, cells + 1))
    if isinstance(drive, JointMoments):
        drives = {leg: driven_by_moments(ride.design, drive.of_leg(leg.prefix), cells) for leg in TWO_LEGS}
        moments = np.array([np.append(curve, curve[0]) for curve in (drives[leg][joint] for leg, joint in DRIVEN)])
    else:
        muscles, stimulator = LegMuscles.of(drive.riders, ride.design.rider), drive.stimulator
    crank = model.joint("crank")
    return RoadControl(
        fixed=ride.fixed,
        travel=ride.travel,
        road=int(model.joint(ROAD).qposadr[0]),
        crank=int(crank.qposadr[0]),
        crank_speed=int(crank.dofadr[0]),
        drives=np.array([drive_addresses(model, leg.prefix + joint) for leg, joint in DRIVEN]),
        leg_lag=np.array([leg.lag for leg, _ in DRIVEN]),
        moment=moments,
        muscles=muscles,
        stimulator=stimulator,
        rising=weights(step, stimulator.rise),
        falling=weights(step, stimulator.fall),
    )


def memory_of(model: mujoco.MjModel) -> RoadMemory:
    """That of a ride that begins, with muscles at rest."""
    shape = len(TWO_LEGS), len(MUSCLE_GROUPS)
    return RoadMemory(model.tendon_range.reshape(-1), np.zeros(shape), np.full(shape, np.nan))


@inlined_machine_code
def act(control: RoadControl, memory: RoadMemory, qpos: Any, speeds: Any, ctrl: Any) -> None:
    """Set the moments, and keep the freewheel's limit at the length reached.

    qpos, speeds: positions, and speeds at their own time. ctrl: of the motors, N m.
    """
    angle = qpos[control.crank]
    if not control.fixed:
        memory.limit[0] = max(memory.limit[0], qpos[control.road] / control.travel - angle)
    for driven in range(len(control.moment)):
        curve = control.moment[driven]
        row, part = place(angle - control.leg_lag[driven], len(curve) - 1)
        ctrl[control.drives[driven][0]] = between(curve, row, part)
    if len(control.muscles.group) > 0:
        for leg in range(len(memory.activation)):
            set_moments(control, memory, leg, qpos, speeds, ctrl)


@inlined_machine_code
def set_moments(control: RoadControl, memory: RoadMemory, leg: int, qpos: Any, speeds: Any, ctrl: Any) -> None:
    """Set the moments of a leg's muscles."""
    row, activation, before = 2 * leg, memory.activation[leg], memory.felt[leg]  # of DRIVEN: the knee, then the hip
    knee, knee_at, knee_rate = control.drives[row]
    hip, hip_at, hip_rate = control.drives[row + 1]
    felt = qpos[control.crank] - control.leg_lag[row] + lead(control.stimulator, speeds[control.crank_speed])
    for group in range(len(activation)):
        now = stimulation(control.stimulator.stimulus, group, felt)
        if not math.isnan(before[group]):
            activation[group] = activated(activation[group], before[group], now, control.rising, control.falling)
        before[group] = now
    ctrl[knee], ctrl[hip] = joint_moments(
        control.muscles, activation, qpos[knee_at], qpos[hip_at], speeds[knee_rate], speeds[hip_rate]
    )
