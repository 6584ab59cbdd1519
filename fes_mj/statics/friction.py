"""Friction in the bearings of a linkage: what it loses over a turn, to first order.

A pin of radius r that bears a force F and turns against its neighbour at a speed w loses mu r abs(F) abs(w). F is that
of the motion without friction, with masses; hip and knee, which are no bearings, are left out.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.linkage.joints import JOINTS
from fes_mj.linkage.kinematics import Motion
from fes_mj.statics.joint_forces import JointForces


class Bearings(NamedTuple):
    """Coefficient of friction and radius of the pins, m."""

    friction: float
    radius: float


@dataclass(frozen=True, eq=False)
class BearingLoss:
    """What the bearings of one leg's linkage lose over the turn of its joint forces."""

    forces: JointForces
    bearings: Bearings

    @cached_property
    def by_joint(self) -> dict[str, float]:
        """Mean over the turn, W."""
        turn = self.forces.static
        arm = self.bearings.friction * self.bearings.radius * turn.cadence
        return {
            joint: arm * float(np.mean(np.abs(self.forces.with_masses[joint]) * slip))
            for joint, slip in slips(turn.motion).items()
        }

    @property
    def power(self) -> float:
        """Of all bearings, mean over the turn, W."""
        return sum(self.by_joint.values())

    @cached_property
    def moments(self) -> dict[str, float]:
        """Constant moments that lose as much in each bearing, N m: what MuJoCo can apply."""
        turn = self.forces.static
        return {
            joint: self.by_joint[joint] / (turn.cadence * float(np.mean(slip)))
            for joint, slip in slips(turn.motion).items()
        }

    def crank_moment(self, motion: Motion) -> FloatArray:
        """What the constant moments take off the crank's along a motion, N m."""
        return np.asarray(sum(self.moments[joint] * slip for joint, slip in slips(motion).items()))


def slips(motion: Motion) -> dict[str, FloatArray]:
    """How fast the two bodies of each bearing turn against each other per crank speed, by joint."""
    still = np.zeros_like(motion.rotation["crank"].first)
    rate = {"frame": still} | {body: rotation.first for body, rotation in motion.rotation.items()}
    joints = motion.design.linkage.architecture.joints
    return {joint: np.abs(rate[one] - rate[other]) for joint, (one, other) in joints.items() if joint not in JOINTS}
