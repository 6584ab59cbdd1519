"""What a ride by joint moments commands: moments by crank angle, as a stimulator reads it off the crank's encoder.

The torque map takes the direction of a joint from the sign of its speed; here it is that of forward pedalling, whatever
the crank is doing.
"""

from dataclasses import dataclass

import numpy as np

from fes_mj.common.arrays import BoolArray, FloatArray
from fes_mj.linkage import kinematics
from fes_mj.linkage.design import Design
from fes_mj.linkage.joints import JOINTS, PerJoint
from fes_mj.moments.joint_moments import JointMoments
from fes_mj.moments.torque_map import TABLE_SIZE, torque_map

POINTS = TABLE_SIZE  # crank angles of a table over a turn


@dataclass(frozen=True, eq=False)
class Drive:
    """One turn of one leg over uniform crank angles, shape (points,).

    moment: N m, of each joint. breaks: whether a joint turns round, or leaves the range of the moments, between a crank
    angle and the next.
    """

    moment: PerJoint[FloatArray]
    breaks: BoolArray
    motion: kinematics.Motion


def drive(design: Design, moments: JointMoments, points: int = POINTS) -> Drive:
    """Moments for a design. points: crank angles of the turn."""
    return driven(kinematics.solve(design, np.linspace(0, 2 * np.pi, points, endpoint=False)), moments)


def driven(motion: kinematics.Motion, moments: JointMoments) -> Drive:
    """The same along a motion over uniform crank angles."""
    torque = torque_map(moments)
    angle, rate = motion.joint_angle, motion.joint_rate
    sides = [rate[joint] >= 0 for joint in JOINTS] + [
        torque.reference.excess(joint, angle[joint]) == 0 for joint in JOINTS
    ]
    breaks = np.logical_or.reduce([side != np.roll(side, -1) for side in sides])
    return Drive(torque.along(motion, torque.reference.cadence), breaks, motion)
