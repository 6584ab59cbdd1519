"""Joint moments in a search, what it maximises and limits of designs that they drive; stimulated.MuscleDrive beside it.

What drives a search answers the same few questions: its power, how far joints are inside what is known of it, forces.
"""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from fes_mj.common.arrays import BoolArray, FloatArray
from fes_mj.linkage.design import Design
from fes_mj.linkage.joints import JOINTS, PerJoint
from fes_mj.linkage.kinematics import solve, uniform_turn
from fes_mj.moments.joint_moments import JointMoments
from fes_mj.moments.torque_map import torque_map
from fes_mj.optimization.buildable import SEARCH_POINTS, pin_force
from fes_mj.statics.cycles import Cycles
from fes_mj.statics.extrapolation import NO_MORE


@dataclass(frozen=True, eq=False)
class MomentDrive:
    """Joint moments that belong to joint angles, in one set or several.

    moments: for forces on pins, if these are limited. caution: with moments as of work_table.uncertain_table, how many
    standard deviations of the gain over `baseline` (power of a design to beat, W, shape (sets,)) are taken off it.
    """

    moments: JointMoments | None = None
    caution: float = 0.0
    baseline: FloatArray | float = 0.0

    proportional: ClassVar = True  # power to the gear ratio, which then follows from the joint speeds
    inside_limit: ClassVar = ("overlap", 0.1)  # what the joints' angles lie in, and how far they must at least, deg

    def inside(self, turn: Cycles) -> PerJoint[FloatArray]:
        """How far joints come into the range of the moments, from whichever side, deg, (designs,); 0 or less: never."""

        def overlap(joint: str) -> FloatArray:
            low, high, bottom, top = _ends(joint, turn)
            common = np.degrees(np.minimum(high - bottom, top - low))
            # the angle beside a dead centre is too sharp for the parabola that found its extreme
            return np.asarray(np.where(turn.outside[1][joint], np.minimum(common, 0.0), common))

        return PerJoint.of(overlap)

    def outside(self, turn: Cycles) -> FloatArray:
        """Share of the turn outside the moments' range, (designs,); not 0 where it is left between two crank angles."""
        ends = (_ends(joint, turn) for joint in JOINTS)
        excess = np.max([(bottom - low, high - top) for low, high, bottom, top in ends], axis=(0, 1))
        return np.asarray(np.maximum(turn.outside[0], (excess > NO_MORE / 2) / turn.angles[0].knee.shape[1]))

    def power(self, designs: Design, turn: Cycles, turns_per_s: FloatArray, within: BoolArray) -> FloatArray:
        """Mean crank power of one leg, W, shape (designs, sets); turns_per_s and `within`, who needs it: (designs,)."""
        return turn.work * turns_per_s[:, None]

    def worth(self, power: FloatArray) -> FloatArray:
        """What is maximised, W, shape (n,); power: shape (n, sets), by the first set less what caution takes off."""
        doubt = self.caution * np.linalg.norm((power - self.baseline)[:, 1:], axis=1) if self.caution else 0.0
        return np.asarray(power[:, 0] - doubt)

    def pin_force(self, design: Design) -> float:
        """Largest on any pin while riding with masses, N, of a design that turns."""
        assert self.moments, "limits of what can be built need the moments"
        motion = solve(design, uniform_turn(SEARCH_POINTS))
        return pin_force(motion, torque_map(self.moments).along(motion, design.linkage.cadence))


def _ends(joint: str, turn: Cycles) -> tuple[FloatArray, FloatArray, float, float]:
    """A joint's smallest and largest angle, (designs,), by whole turns beside the moments' range, and that's; rad."""
    low, high, *_ = turn.joints[joint]
    shift = turn.reference.turns_to_range(joint, low, high)
    return low + shift, high + shift, *turn.reference.ranges[joint]
