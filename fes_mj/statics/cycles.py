"""One turn of many designs at once: joint ranges, joint travel and work, from positions alone.

The torque map depends on joint angle and direction only, so the virtual work of a joint over a turn is the area of
the loops it draws in the moment-angle plane: a sum over its reversals, where nothing but its angle is needed.
"""

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from fes_mj.common.arrays import BoolArray, FloatArray, IntArray
from fes_mj.common.units import turns_per_second
from fes_mj.linkage.assembly import SCAN
from fes_mj.linkage.design import Design
from fes_mj.linkage.joints import PerJoint
from fes_mj.linkage.kinematics import joint_angles, positions, uniform_turn
from fes_mj.linkage.turning import BatchTurning, batch_turning, leg_reach
from fes_mj.moments.reference_tricycle import ReferenceTricycle
from fes_mj.statics.extrapolation import beyond, drift_area, never_inside, outside_share
from fes_mj.statics.work_table import WorkTable

# Against 36,000 angles the work per turn of the printed designs changes by less than 2e-5 of itself.
CYCLE_POINTS = len(SCAN)
# Positions in a block: its arrays stay in the processor's cache, where a position costs half of what it does outside.
BLOCK_POSITIONS = 8000


class JointTurn(NamedTuple):
    """A joint over a turn of each design, shape (designs,) each, NaN for those that do not turn.

    low, high, travel: rad, smallest and largest angle, and the way made. reversals: how often it turns round. work: J,
    shape (designs, sets). variance: J^2, of the work, by not knowing the moments beyond their range.
    """

    low: FloatArray
    high: FloatArray
    travel: FloatArray
    reversals: IntArray
    work: FloatArray
    variance: FloatArray


@dataclass(frozen=True)
class Cycles:
    """One turn of each design; NaN for those that do not turn.

    turning: which of them turn, and why the others do not.
    joints: what each does. work: shape (designs, sets), J a turn and leg. outside_sd: shape (designs,), J, of the work,
    by not knowing the moments beyond their range (extrapolation.extrapolation). angles: of the joints in blocks of
    designs, rad, shape (designs, points) each.
    """

    turning: BatchTurning
    joints: PerJoint[JointTurn]
    work: FloatArray
    outside_sd: FloatArray
    angles: list[PerJoint[FloatArray]]
    reference: ReferenceTricycle

    @property
    def turns(self) -> BoolArray:
        """Which of the designs turn, shape (designs,)."""
        return self.turning.turns

    def power(self, cadence: Any) -> FloatArray:
        """Mean crank power of one leg, W, shape (designs, sets of moments); cadence: rad/s, of all or (designs,)."""
        return self.work * np.reshape(turns_per_second(cadence), (-1, 1))

    @cached_property
    def outside(self) -> tuple[FloatArray, PerJoint[BoolArray]]:
        """Share of the turn in which a joint is beyond the moments' range, and by joint whether it is all the turn.

        Shape (designs,) each; one that never enters has a work that says nothing. Found out when it is asked for.
        """
        excess = [beyond(self.reference, angles) for angles in self.angles]
        share = np.concatenate([outside_share(block) for block in excess])
        never = [never_inside(block) for block in excess]
        by_joint = PerJoint.of(lambda joint: np.concatenate([block[joint] for block in never]))
        return np.where(self.turns, share, np.nan), by_joint


class Reversals(NamedTuple):
    """Where a joint of several designs turns round: design, joint angle (rad), and 1 for a maximum, -1 for a minimum.

    Design by design, shape (reversals,) each.
    """

    design: IntArray
    angle: FloatArray
    sign: FloatArray


def cycles(design: Design, table: WorkTable, points: int = CYCLE_POINTS) -> Cycles:
    """Turn a batch of designs: any number of the linkage or the rider may be an array of shape (designs, 1).

    points: crank angles, uniform; the extremes between them are found by a parabola.
    """
    crank_angle = uniform_turn(points)
    size = max(1, BLOCK_POSITIONS // points)
    blocks = (_block(design.taken(slice(start, start + size)), crank_angle) for start in range(0, design.size, size))
    reach, angles, turned = zip(*blocks, strict=True)
    swing = [np.ptp(block.hip, axis=1) for block in angles]
    turning = batch_turning(design, np.concatenate(reach), np.concatenate(swing))
    turns = turning.turns

    def of_joint(joint: str) -> JointTurn:
        parts = [block[joint] for block in turned]
        rows = np.concatenate([part.design + size * number for number, part in enumerate(parts)])
        angle, sign = (np.concatenate(columns) for columns in zip(*(part[1:] for part in parts), strict=True))
        return _joint_turn(joint, Reversals(rows, angle, sign), turns, table)

    joints = PerJoint.of(of_joint)
    return Cycles(
        turning,
        joints,
        work=joints.knee.work + joints.hip.work,
        outside_sd=np.sqrt(joints.knee.variance + joints.hip.variance),
        angles=[*angles],
        reference=table.measured_on,
    )


def joint_speeds(design: Design, table: WorkTable) -> PerJoint[float]:
    """Mean absolute speed of knee and hip over a turn at the design's own cadence, deg/s."""
    turns = turns_per_second(design.linkage.cadence)
    return cycles(design, table).joints.map(lambda joint: math.degrees(float(joint.travel[0])) * turns)


def _joint_turn(joint: str, reversals: Reversals, turns: BoolArray, table: WorkTable) -> JointTurn:
    reference, count, (rows, angle, sign) = table.measured_on, len(turns), reversals
    low, high = np.full((2, count), np.nan)
    np.fmin.at(low, rows, angle)
    np.fmax.at(high, rows, angle)
    travel = np.asarray(2 * np.bincount(rows, sign * angle, count), float)
    angle = angle + reference.turns_to_range(joint, low, high)[rows]
    number = np.bincount(rows, minlength=count)
    work = table.work(joint, np.clip(angle, *reference.ranges[joint]), sign, number)
    variance, (bottom, top) = np.zeros(count), reference.ranges[joint]
    for excess in (bottom - angle, angle - top):
        drift = np.bincount(rows, sign * drift_area(excess, reference.half_range(joint)), count)
        variance += 2 * (table.spread[joint] * drift) ** 2  # in extension and in flexion, independently
    for values in (low, high, travel, work, variance):
        values[~turns] = np.nan
    return JointTurn(low, high, travel, number, work, variance)


def _block(design: Design, crank_angle: FloatArray) -> tuple[FloatArray, PerJoint[FloatArray], PerJoint[Reversals]]:
    """A turn of some designs: reach of the leg (m), joint angles (rad) and reversals."""
    points = positions(design, crank_angle)
    reach = leg_reach(design, points["pedal"])
    closes = (reach > 0)[:, None]
    angles = joint_angles(design, points).map(lambda angle: np.where(closes, angle, 0.0))  # or it stays at rest
    return reach, angles, angles.map(reversals)


def reversals(angle: FloatArray) -> Reversals:
    """Where joint angles over a turn, rad, shape (designs, points), turn round: on the top of a parabola by three."""
    rising = np.empty(angle.shape, bool)
    np.greater(angle[:, 1:], angle[:, :-1], out=rising[:, :-1])
    np.greater(angle[:, 0], angle[:, -1], out=rising[:, -1])
    before = np.roll(rising, 1, axis=1)
    rows, columns = np.nonzero(rising != before)
    sign = np.where(before[rows, columns], 1.0, -1.0)
    here, count = angle[rows, columns], angle.shape[1]
    earlier, later = angle[rows, columns - 1] - here, angle[rows, (columns + 1) % count] - here
    return Reversals(rows, here - (later - earlier) ** 2 / (8 * (earlier + later)), sign)
