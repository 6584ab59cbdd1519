"""Stimulation that belongs to a joint's angle and direction: what was stimulated there in a measurement is stimulated.

It jumps where the joint turns round. So the crank angles over which it is known have each of these moments twice, just
before and just after it, and what the muscles answer is that of the jump itself, wherever it falls between two degrees.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.linkage import kinematics
from fes_mj.linkage.design import Design
from fes_mj.linkage.joints import JOINTS, PerJoint
from fes_mj.muscles.activation import periodic_activation, trapezium
from fes_mj.muscles.anatomy import MUSCLE_GROUPS
from fes_mj.muscles.prior import ramp
from fes_mj.muscles.riders import Riders

LEADING = {"quadriceps": "knee", "hamstrings": "knee", "gluteus": "hip"}
TURNED = 1e-7  # rad, between the two crank angles: nearer to a reversal rounding says where a joint goes


@dataclass(frozen=True, eq=False)
class JointLed:
    """Stimulation of riders on a design as it arrives, and the activation that it makes.

    crank_angle: rad, ascending within a turn, of every rider's own delay, shape (members, nodes). stimulation: in
    [0, 1], shape (groups, members, nodes).
    """

    riders: Riders
    cadence: float
    crank_angle: FloatArray
    stimulation: FloatArray

    @classmethod
    def of(cls, riders: Riders, design: Design, cadence: float, crank_angle: FloatArray) -> "JointLed":
        """At crank angles of a turn, rad, shape (angles,), and where joints turn round; cadence: rad/s."""
        late = cadence * riders["delay_s"][:, 0]
        turned = (around_reversals(design, crank_angle) + late) % (2 * np.pi)
        nodes = np.sort(np.concatenate([np.broadcast_to(crank_angle, (len(riders), crank_angle.size)), turned], axis=1))
        trial, motion = riders.measured_on, kinematics.solve(design, nodes - late)
        angle, rate = motion.joint_angle, motion.joint_rate
        source = PerJoint.of(lambda joint: trial.source_angle(joint, angle[joint], rate[joint]))
        on, width = np.radians(np.moveaxis(riders.windows(), -1, 0))[..., None]
        there = np.stack([source[LEADING[group]] for group in MUSCLE_GROUPS])
        return cls(riders, cadence, nodes, trapezium(there - on, width, trial.cadence * ramp()))

    def activation(self, start: Any = 0.0) -> FloatArray:
        """At the nodes, shape (groups, members, nodes); start: at the first, as well as it is known."""
        turn, rise, fall = 2 * np.pi / self.cadence, self.riders["rise_s"][:, 0, 0], self.riders.fall[:, 0, 0]
        step = np.diff(self.crank_angle, append=self.crank_angle[:, :1] + 2 * np.pi) / (2 * np.pi)
        return periodic_activation(
            self.stimulation, turn, rise, fall, start, np.broadcast_to(step, self.stimulation.shape)
        )

    def activation_at(self, crank_angle: FloatArray) -> FloatArray:
        """At angles that are among the nodes, shape (groups, members, angles)."""
        place = np.stack([np.searchsorted(nodes, crank_angle) for nodes in self.crank_angle])
        return np.take_along_axis(self.activation(), place[None], axis=-1)


def around_reversals(design: Design, crank_angle: FloatArray) -> FloatArray:
    """Crank angles just before and just after each joint turns round, rad, shape (2 * reversals,).

    crank_angle: rad, ascending within a turn, between which a joint turns round no more than once.
    """
    rate = kinematics.solve(design, crank_angle).joint_rate
    ends = []
    for joint in JOINTS:
        extends = rate[joint] >= 0
        rows = np.flatnonzero(extends != np.roll(extends, -1))
        low, high = crank_angle[rows], np.append(crank_angle, crank_angle[0] + 2 * np.pi)[rows + 1]
        while np.max(high - low, initial=0.0) > TURNED:
            middle = (low + high) / 2
            before = (kinematics.solve(design, middle).joint_rate[joint] >= 0) == extends[rows]
            low, high = np.where(before, middle, low), np.where(before, high, middle)
        ends += [low, high]
    return np.concatenate(ends)
