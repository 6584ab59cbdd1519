"""One turn of many designs at once: joint ranges, joint travel and work, from positions alone.

The torque map depends on joint angle and direction only, so the virtual work of a joint over a turn is the area of
the loops it draws in the moment-angle plane: a sum over its reversals, where nothing but its angle is needed.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import TypeAlias

import numpy as np
from scipy.integrate import cumulative_trapezoid
from scipy.sparse import csr_array

from fes_mj.common.arrays import BoolArray, FloatArray, IntArray
from fes_mj.common.errors import InputError
from fes_mj.linkage.assembly import SCAN
from fes_mj.linkage.design import Design
from fes_mj.linkage.joints import PerJoint
from fes_mj.linkage.kinematics import joint_angles, positions
from fes_mj.linkage.turning import BatchTurning, batch_turning, leg_reach
from fes_mj.moments.fourier import fourier
from fes_mj.moments.joint_moments import JointMoments
from fes_mj.moments.reference_tricycle import ReferenceTricycle
from fes_mj.moments.torque_map import torque_map
from fes_mj.moments.uncertainty import independent_deviations
from fes_mj.statics.extrapolation import beyond, drift_area, never_inside, outside_share

# Joint, crank angle of the measurement from top dead centre -> N m, last axis: sets.
Moments: TypeAlias = Callable[[str, FloatArray], FloatArray]

# Against 36,000 angles the work per turn of the printed designs changes by less than 2e-5 of itself.
TURN_POINTS = len(SCAN)
# Positions in a block: its arrays stay in the processor's cache, where a position costs half of what it does outside.
BLOCK_POSITIONS = 8000
_TABLE_STEPS = 5400  # over the 1.5 turns that source_angle returns


class WorkTable:
    """Work of each joint, for one or several sets of joint moments side by side, ready to be read at reversals."""

    def __init__(self, moments: Moments, measured_on: ReferenceTricycle) -> None:
        """moments: called with a joint and crank angles (m,) from top dead centre, rad; returns N m, (m, sets)."""
        self.measured_on, grid = measured_on, np.linspace(-np.pi, 2 * np.pi, _TABLE_STEPS + 1)
        rate, values = measured_on.joint_rates(grid), PerJoint.of(lambda joint: moments(joint, grid))
        self._work = PerJoint.of(
            lambda joint: cumulative_trapezoid(values[joint] * rate[joint][:, None], grid, axis=0, initial=0)
        )
        # N m, by which the first set of moments varies inside the range: what is not known of it outside
        self.spread = values.map(lambda each: float(each[grid >= 0][:-1, 0].std()))

    @classmethod
    def of(cls, *moments: JointMoments) -> "WorkTable":
        """Table of the given joint moments, a set each, all measured on the same tricycle."""
        maps = [torque_map(each) for each in moments]
        return cls(
            lambda joint, angle: np.stack([each.at_source(joint, angle) for each in maps], axis=-1),
            moments[0].measured_on,
        )

    @property
    def sets(self) -> int:
        return int(self._work.knee.shape[1])

    def work(self, joint: str, angle: FloatArray, sign: FloatArray, counts: IntArray) -> FloatArray:
        """Work of a joint that turns round at these angles, J a turn, shape (designs, sets).

        angle: rad, and sign: 1 for a maximum, -1 for a minimum, shape (m,), design by design. counts: reversals of each
        design, shape (designs,).
        """
        # work of extending to an angle and flexing back, up to a constant: linear in four entries of the table
        index, weight = np.empty((len(angle), 4), np.int64), np.empty((len(angle), 4))
        for column, direction in ((0, 1.0), (2, -1.0)):
            source = self.measured_on.source_angle(joint, angle, direction)
            position = (source + np.pi) * (_TABLE_STEPS / (3 * np.pi))
            index[:, column] = np.minimum(position.astype(np.int64), _TABLE_STEPS - 1)
            index[:, column + 1] = index[:, column] + 1
            weight[:, column + 1] = direction * sign * (position - index[:, column])
            weight[:, column] = direction * sign - weight[:, column + 1]
        ends = np.concatenate([[0], 4 * np.cumsum(counts)])
        shape = (len(counts), _TABLE_STEPS + 1)
        return np.asarray(csr_array((weight.ravel(), index.ravel(), ends), shape) @ self._work[joint])


@lru_cache(maxsize=32)
def uncertain_table(moments: JointMoments) -> WorkTable:
    """Table whose first set of moments is the given one, the others its deviations along independent directions.

    A power p, shape (sets,), has the mean p[0] and the norm of p[1:] as its standard deviation. Raises InputError for
    moments whose covariance is not known.
    """
    if moments.covariance is None:
        raise InputError(
            f"{moments.name}: nothing is known of the error of these moments; only a rider group's have one"
        )
    deviations = PerJoint(*np.split(independent_deviations(moments.covariance), 2))
    torque = torque_map(moments)

    def sets(joint: str, angle: FloatArray) -> FloatArray:
        return np.column_stack([torque.at_source(joint, angle), fourier(angle) @ deviations[joint]])

    return WorkTable(sets, moments.measured_on)


@dataclass(frozen=True)
class Cycles:
    """One turn of each design; NaN for those that do not turn.

    turning: which of them turn, and why the others do not.
    low, high, travel: by joint, shape (designs,), rad: smallest and largest angle, and the way made in a turn.
    reversals: by joint, shape (designs,), how often it turns round. work: shape (designs, sets), J a turn and leg.
    outside_sd: shape (designs,), J, of the work, by not knowing the moments beyond their range
    (extrapolation.extrapolation). angles: of the joints in blocks of designs, rad, shape (designs, points) each.
    """

    turning: BatchTurning
    low: PerJoint[FloatArray]
    high: PerJoint[FloatArray]
    travel: PerJoint[FloatArray]
    reversals: PerJoint[IntArray]
    work: FloatArray
    outside_sd: FloatArray
    angles: list[PerJoint[FloatArray]]
    reference: ReferenceTricycle

    @property
    def turns(self) -> BoolArray:
        """Which of the designs turn, shape (designs,)."""
        return self.turning.turns

    @cached_property
    def outside(self) -> tuple[FloatArray, PerJoint[BoolArray]]:
        """Share of the turn in which a joint is beyond the moments' range, and by joint whether it is all the turn.

        Shape (designs,) each; one that never enters has a work that says nothing. Found out when it is asked for.
        """
        found = [(outside_share(each), never_inside(each)) for each in (beyond(self.reference, a) for a in self.angles)]
        share = np.concatenate([each for each, _ in found])
        never = PerJoint.of(lambda joint: np.concatenate([each[joint] for _, each in found]))
        return np.where(self.turns, share, np.nan), never


def cycles(design: Design, table: WorkTable, points: int = TURN_POINTS) -> Cycles:
    """Turn a batch of designs: any number of the linkage or the rider may be an array of shape (designs, 1).

    points: crank angles, uniform; the extremes between them are found by a parabola.
    """
    crank_angle = np.linspace(0, 2 * np.pi, points, endpoint=False)
    size = max(1, BLOCK_POSITIONS // points)
    parts = [_turn(design.taken(slice(start, start + size)), crank_angle) for start in range(0, design.size, size)]
    reach, swing = (np.concatenate([part[i] for part in parts]) for i in (0, 1))
    turning = batch_turning(design, reach, swing)
    turns = turning.turns
    first_rows, work = size * np.arange(len(parts)), np.zeros((len(reach), table.sets))
    work[~turns] = np.nan
    reference, variance = table.measured_on, np.zeros(len(reach))

    def of_joint(joint: str) -> tuple[FloatArray, FloatArray, FloatArray, IntArray]:
        """Smallest and largest angle, travel and reversals of a joint; its work is added to the others'."""
        found = [part[3][joint] for part in parts]
        rows = np.concatenate([each[0] + first for each, first in zip(found, first_rows, strict=True)])
        angle, sign = (np.concatenate([each[i] for each in found]) for i in (1, 2))
        low, high = np.full((2, len(reach)), np.nan)
        np.fmin.at(low, rows, angle)
        np.fmax.at(high, rows, angle)
        travel = np.where(turns, 2 * np.bincount(rows, sign * angle, len(reach)), np.nan)
        middle = (low + high) / 2  # the whole path by whole turns, so that it does not jump where it is far outside
        angle = angle + (reference.around(joint, middle) - middle)[rows]
        counts = np.bincount(rows, minlength=len(reach))
        work[:] += table.work(joint, np.clip(angle, *reference.ranges[joint]), sign, counts)
        for excess in (reference.ranges[joint][0] - angle, angle - reference.ranges[joint][1]):
            drift = np.bincount(rows, sign * drift_area(excess, reference.half_range(joint)), len(reach))
            variance[:] += 2 * (table.spread[joint] * drift) ** 2  # in extension and in flexion, independently
        low[~turns] = high[~turns] = np.nan
        return low, high, travel, counts

    low, high, travel, count = (PerJoint(*each) for each in zip(*PerJoint.of(of_joint), strict=True))
    outside_sd = np.where(turns, np.sqrt(variance), np.nan)
    angles = [part[2] for part in parts]
    return Cycles(turning, low, high, travel, count, work, outside_sd, angles, reference)


def joint_speeds(design: Design, table: WorkTable) -> PerJoint[float]:
    """Mean absolute speed of knee and hip over a turn at the design's own cadence, deg/s."""
    return cycles(design, table).travel.map(
        lambda travel: math.degrees(float(travel[0])) * design.linkage.cadence / (2 * math.pi)
    )


Reversals: TypeAlias = tuple[IntArray, FloatArray, FloatArray]


def _turn(
    design: Design, crank_angle: FloatArray
) -> tuple[FloatArray, FloatArray, PerJoint[FloatArray], PerJoint[Reversals]]:
    """Reach of the leg, swing of the thigh, angles and reversals of knee and hip of one block."""
    points = positions(design, crank_angle)
    reach = leg_reach(design, points["pedal"])
    closes = (reach > 0)[:, None]
    angles = joint_angles(design, points).map(lambda angle: np.where(closes, angle, 0.0))  # or it stays at rest
    return reach, np.ptp(angles.hip, axis=1), angles, angles.map(reversals)


def reversals(angle: FloatArray) -> Reversals:
    """Where joint angles over a turn, shape (designs, points), turn round.

    Returns the design, the angle (at the top of a parabola through three points) and 1 for a maximum, -1 for a minimum.
    """
    rising = np.empty(angle.shape, bool)
    np.greater(angle[:, 1:], angle[:, :-1], out=rising[:, :-1])
    np.greater(angle[:, 0], angle[:, -1], out=rising[:, -1])
    before = np.roll(rising, 1, axis=1)
    rows, columns = np.nonzero(rising != before)
    sign = np.where(before[rows, columns], 1.0, -1.0)
    here, count = angle[rows, columns], angle.shape[1]
    left, right = angle[rows, columns - 1] - here, angle[rows, (columns + 1) % count] - here
    return rows, here - (right - left) ** 2 / (8 * (left + right)), sign
