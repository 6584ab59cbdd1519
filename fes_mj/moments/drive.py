"""What the muscles are commanded: joint moments by crank angle, as a stimulator reads it off the crank's encoder.

The torque map takes the direction of a joint from the sign of its speed; here it is that of forward pedalling, whatever
the crank is doing. Speed dependence and the muscles' lag come on top.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np

from fes_mj.common.arrays import BoolArray, FloatArray
from fes_mj.linkage import kinematics
from fes_mj.linkage.design import Design
from fes_mj.linkage.joints import JOINTS, PerJoint
from fes_mj.moments.joint_moments import JointMoments
from fes_mj.moments.torque_map import GRID, TABLE_SIZE, torque_map
from fes_mj.moments.torque_velocity import TorqueVelocity

POINTS = TABLE_SIZE  # crank angles of a table over a turn


@dataclass(frozen=True, eq=False)
class Drive:
    """One turn of one leg over uniform crank angles, shape (points,).

    command: N m, of each joint at rest: with a torque-velocity relation the moment that the muscle would have at rest.
    breaks: whether a joint turns round, or leaves the range of the moments, between a crank angle and the next.
    """

    command: PerJoint[FloatArray]
    breaks: BoolArray
    motion: kinematics.Motion


def drive(design: Design, moments: JointMoments, lag: float = 0.0, points: int = POINTS) -> Drive:
    """Commands for a design. lag: time constant of the muscles' answer, s. points: crank angles of the turn.

    With a lag the command is the one whose filtered answer, on the tricycle of the measurement at its cadence, is the
    map: u = m + lag * cadence * dm/da over that tricycle's crank angle a.
    """
    torque = torque_map(moments)
    motion = kinematics.solve(design, np.linspace(0, 2 * np.pi, points, endpoint=False))
    angle, rate = motion.joint_angle, motion.joint_rate

    def command(joint: str) -> FloatArray:
        table, speed = torque.table[joint][:POINTS], torque.reference_speed[joint][:POINTS]
        turn = commanded(table, torque.moments.torque_velocity, joint, speed, lag * torque.reference.cadence)
        source = torque.source_angle(joint, angle[joint], rate[joint])
        position = np.mod(source, 2 * np.pi) / GRID[1]
        return np.asarray(np.interp(position, np.arange(POINTS), turn, period=POINTS))

    sides = [rate[joint] >= 0 for joint in JOINTS] + [
        torque.reference.excess(joint, angle[joint]) == 0 for joint in JOINTS
    ]
    breaks = np.logical_or.reduce([side != np.roll(side, -1) for side in sides])
    return Drive(PerJoint.of(command), breaks, motion)


def commanded(
    moment: FloatArray, relation: TorqueVelocity | None, joint: str, speed: FloatArray, lag_angle: Any
) -> FloatArray:
    """Command over a turn of the tricycle of the measurement, N m, to which muscles with a lag answer with `moment`.

    moment: N m, and speed: rad/s, of the joint there, over uniform crank angles along the last axis. lag_angle: what
    that crank turns in the time constant of the lag, rad.
    """
    at_rest = moment / relation.factor(joint, np.sign(moment) * speed) if relation else moment
    change = np.roll(at_rest, -1, axis=-1) - np.roll(at_rest, 1, axis=-1)
    return np.asarray(at_rest + lag_angle * change * at_rest.shape[-1] / (4 * np.pi))
