"""The paper's rule put to riders who are known: the moment belongs to the joint's angle and direction of motion.

Moments that muscles give on the tricycle of a measurement are read where another linkage has the same joint angle.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.linkage import kinematics
from fes_mj.linkage.design import Design
from fes_mj.linkage.joints import PerJoint
from fes_mj.linkage.kinematics import Motion
from fes_mj.moments.reference_tricycle import PAPER_TRICYCLE, ReferenceTricycle
from fes_mj.muscles.power import best_turn
from fes_mj.muscles.riders import Riders
from fes_mj.muscles.timing import TURN_ANGLES, TURN_POINTS


def moments_by_angle(
    moment: PerJoint[FloatArray], motion: Motion, reference: ReferenceTricycle
) -> PerJoint[FloatArray]:
    """Joint moments along a motion of one design, N m, shape (..., angles).

    moment: on the tricycle of the measurement over TURN_ANGLES of its crank, N m, shape (..., TURN_POINTS).
    """

    def of_joint(joint: str) -> FloatArray:
        source = reference.source_angle(joint, motion.joint_angle[joint], motion.joint_rate[joint])
        position = np.mod(source + reference.top_dead_centre, 2 * np.pi) * (TURN_POINTS / (2 * np.pi))
        index = position.astype(np.int64)
        table, part = moment[joint], position - index
        here, there = table[..., index % TURN_POINTS], table[..., (index + 1) % TURN_POINTS]
        return np.asarray(here + part * (there - here))

    return PerJoint.of(of_joint)


class Gains(NamedTuple):
    """Mean power per that on the tricycle of the measurement, shape (designs, riders).

    true: each rider stimulated at its own best on every linkage. by_angle: as the paper's rule makes it.
    """

    true: FloatArray
    by_angle: FloatArray


def null_test(riders: Riders, designs: Sequence[Design], reference: ReferenceTricycle = PAPER_TRICYCLE) -> Gains:
    """Gains of riders whose muscles are known, each at the designs' own cadences, beside what the rule says of them."""
    measured, _ = best_turn(riders, reference.design, reference.cadence, each_its_own=True)
    moment = measured.moment.map(lambda values: values[:, 0])
    true, by_angle = [], []
    for design in designs:
        turn, _ = best_turn(riders, design, each_its_own=True)
        motion = kinematics.solve(design, TURN_ANGLES)
        mapped, rate = moments_by_angle(moment, motion, reference), motion.joint_rate
        work = mapped.knee * rate.knee + mapped.hip * rate.hip
        true.append(turn.power_mean[:, 0])
        by_angle.append(design.linkage.cadence * work.mean(axis=-1))
    base = measured.power_mean[:, 0]
    return Gains(np.stack(true) / base, np.stack(by_angle) / base)
