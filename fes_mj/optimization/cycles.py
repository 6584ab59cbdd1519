"""One turn of many designs at once: joint ranges, joint travel and work, from positions alone.

The torque map depends on joint angle and direction only, so the virtual work of a joint over a turn is the area of
the loops it draws in the moment-angle plane: a sum over its reversals, where nothing but its angle is needed.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import cumulative_trapezoid

from fes_mj import kinematics
from fes_mj.design import Design
from fes_mj.torque import JOINTS, REFERENCE, TOP_DEAD_CENTRE, JointMoments, TorqueMap, joint_angles, source_angle

Moments = Callable[[str, Any], NDArray[np.float64]]  # joint, crank angle of the reference -> N m, last axis: sets

# Against 36,000 angles the work per turn of the printed designs changes by less than 2e-5 of itself.
TURN_POINTS = 120
# Positions in a block: its arrays stay in the processor's cache, where a position costs half of what it does outside.
BLOCK_POSITIONS = 8000
_TABLE_STEPS = 5400  # over the 1.5 turns that source_angle returns


class WorkTable:
    """Work of each joint, for one or several sets of joint moments side by side, ready to be read at reversals."""

    def __init__(self, moments: Moments) -> None:
        """moments: called with a joint and crank angles (m,) from top dead centre, rad; returns N m, (m, sets)."""
        self._grid = np.linspace(-np.pi, 2 * np.pi, _TABLE_STEPS + 1)
        motion = kinematics.solve(REFERENCE, self._grid + TOP_DEAD_CENTRE)
        self._work = {
            joint: cumulative_trapezoid(moments(joint, self._grid) * rate[:, None], self._grid, axis=0, initial=0)
            for joint, (_, rate) in joint_angles(motion).items()
        }

    @classmethod
    def of(cls, *moments: JointMoments) -> WorkTable:
        """Table of the given joint moments, a set each."""
        maps = [TorqueMap(each) for each in moments]
        return cls(lambda joint, angle: np.stack([each.at_source(joint, angle) for each in maps], axis=-1))

    @property
    def sets(self) -> int:
        return self._work["knee"].shape[1]

    def area(self, joint: str, angle: Any) -> NDArray[np.float64]:
        """Work of extending to `angle` (rad, shape (m,)) and flexing back, J, shape (m, sets), up to a constant."""
        return self._at(joint, source_angle(joint, angle, 1.0)) - self._at(joint, source_angle(joint, angle, -1.0))

    def _at(self, joint: str, source: Any) -> NDArray[np.float64]:
        position = (source + np.pi) * (_TABLE_STEPS / (3 * np.pi))
        index = np.minimum(position.astype(np.int64), _TABLE_STEPS - 1)
        work = self._work[joint]
        return work[index] + (position - index)[:, None] * (work[index + 1] - work[index])


@dataclass(frozen=True)
class Cycles:
    """One turn of each design; NaN for those that do not close over the whole turn.

    reach: shape (designs,), m, what the leg has left before it is stretched or folded flat; negative if it lacks.
    low, high, travel: by joint, shape (designs,), rad: smallest and largest angle, and the way made in a turn.
    reversals: by joint, shape (designs,), how often it turns round. work: shape (designs, sets), J a turn and leg.
    """

    reach: NDArray[np.float64]
    low: dict[str, NDArray[np.float64]]
    high: dict[str, NDArray[np.float64]]
    travel: dict[str, NDArray[np.float64]]
    reversals: dict[str, NDArray[np.int64]]
    work: NDArray[np.float64]


def cycles(design: Design, table: WorkTable, points: int = TURN_POINTS) -> Cycles:
    """Turn a batch of designs: any number of the linkage or the rider may be an array of shape (designs, 1).

    points: crank angles, uniform; the extremes between them are found by a parabola.
    """
    crank_angle = np.linspace(0, 2 * np.pi, points, endpoint=False)
    size = max(1, BLOCK_POSITIONS // points)
    parts = [
        _turn(take(design, slice(start, start + size)), crank_angle) for start in range(0, batch_size(design), size)
    ]
    reach = np.concatenate([part[0] for part in parts])
    count, first_rows = len(reach), size * np.arange(len(parts))
    result = Cycles(reach, {}, {}, {}, {}, np.zeros((count, table.sets)))
    result.work[~(reach > 0)] = np.nan
    for number, joint in enumerate(JOINTS, 1):
        rows = np.concatenate([part[number][0] + first for part, first in zip(parts, first_rows, strict=True)])
        angle, sign = (np.concatenate([part[number][i] for part in parts]) for i in (1, 2))
        low, high = np.full((2, count), np.nan)
        np.fmin.at(low, rows, angle)
        np.fmax.at(high, rows, angle)
        result.low[joint], result.high[joint] = low, high
        result.travel[joint] = np.where(reach > 0, 2 * np.bincount(rows, sign * angle, count), np.nan)
        result.reversals[joint] = np.bincount(rows, minlength=count)
        np.add.at(result.work, rows, sign[:, None] * table.area(joint, angle))
    return result


def joint_speeds(design: Design, table: WorkTable) -> dict[str, float]:
    """Mean absolute speed of knee and hip over a turn at the design's own cadence, deg/s, by joint."""
    turn = cycles(design, table)
    return {
        joint: math.degrees(float(turn.travel[joint][0])) * design.linkage.cadence / (2 * math.pi) for joint in JOINTS
    }


def batch_size(design: Design) -> int:
    """Number of designs in a batch; 1 for a single design."""
    return max((len(value) for _, _, value in _arrays(design)), default=1)


def take(design: Design, rows: Any) -> Design:
    """The designs of a batch at `rows` (an index array, a mask or a slice), as a batch."""
    changes: dict[str, dict[str, Any]] = {"linkage": {}, "rider": {}}
    for owner, name, value in _arrays(design):
        changes[owner][name] = value[rows]
    return replace(
        design, linkage=replace(design.linkage, **changes["linkage"]), rider=replace(design.rider, **changes["rider"])
    )


def _arrays(design: Design) -> Iterator[tuple[str, str, NDArray[Any]]]:
    for owner in ("linkage", "rider"):
        part = getattr(design, owner)
        for field in fields(part):
            value = getattr(part, field.name)
            if isinstance(value, np.ndarray):
                yield owner, field.name, value


Reversals = tuple[NDArray[np.int64], NDArray[np.float64], NDArray[np.float64]]


def _turn(design: Design, crank_angle: NDArray[np.float64]) -> tuple[NDArray[np.float64], Reversals, Reversals]:
    """Reach of the leg, reversals of the knee and of the hip of one block."""
    points = kinematics.positions(design, crank_angle)
    pedal = np.atleast_2d(np.abs(points["pedal"]))
    thigh, shank = (np.ravel(length) for length in (design.rider.thigh, design.knee_to_pedal))
    reach = np.minimum(thigh + shank - pedal.max(axis=1), pedal.min(axis=1) - np.abs(thigh - shank))
    angles = [np.atleast_2d(angle(design, points)) for angle in (kinematics.knee_angle, kinematics.hip_angle)]
    for angle in angles:
        angle[~(reach > 0)] = 0.0  # one that does not close stays at rest
    return reach, reversals(angles[0]), reversals(angles[1])


def reversals(angle: NDArray[np.float64]) -> Reversals:
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
