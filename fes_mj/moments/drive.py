"""What a ride by joint moments commands: moments by crank angle, as a stimulator reads it off the crank's encoder.

The torque map takes the direction of a joint from the sign of its speed; here it is that of forward pedalling, whatever
the crank is doing.
"""

import numpy as np

from fes_mj.common.arrays import BoolArray, FloatArray
from fes_mj.linkage.design import Design
from fes_mj.linkage.joints import JOINTS, PerJoint
from fes_mj.linkage.kinematics import Motion, solve, uniform_turn
from fes_mj.moments.joint_moments import JointMoments
from fes_mj.moments.reference_tricycle import ReferenceTricycle
from fes_mj.moments.torque_map import TABLE_SIZE, torque_map

DRIVE_POINTS = TABLE_SIZE  # crank angles of a table over a turn


def drive(design: Design, moments: JointMoments, points: int = DRIVE_POINTS) -> PerJoint[FloatArray]:
    """Moments of one leg of a design over so many uniform crank angles of a turn, N m, shape (points,)."""
    return driven(solve(design, uniform_turn(points)), moments)


def driven(motion: Motion, moments: JointMoments) -> PerJoint[FloatArray]:
    """The same along a motion over crank angles."""
    torque = torque_map(moments)
    return torque.along(motion, torque.reference.cadence)


def breaks(motion: Motion, reference: ReferenceTricycle) -> BoolArray:
    """Whether a joint turns round, or leaves the range of the moments, between a crank angle and the next.

    motion: over uniform crank angles of a turn. reference: the tricycle of the measurement.
    """
    angle, rate = motion.joint_angle, motion.joint_rate
    sides = [side for joint in JOINTS for side in (rate[joint] >= 0, reference.excess(joint, angle[joint]) == 0)]
    return np.asarray(np.logical_or.reduce([side != np.roll(side, -1) for side in sides]))
