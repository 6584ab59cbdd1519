"""What the reduced equation of motion must know of both legs at each crank angle, in tables over a turn.

Cells and steps are chosen beforehand, as fine as the linkage is sharp and its moments abrupt: where the crank turns
evenly a step of Runge and Kutta is Simpson's rule, and how exact that is the table itself can tell.
"""

import math
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from fes_mj.common.arrays import BoolArray, FloatArray, IntArray
from fes_mj.common.errors import InputError
from fes_mj.linkage import kinematics
from fes_mj.linkage.design import Design
from fes_mj.linkage.inertia import CrankInertia, crank_inertia
from fes_mj.linkage.joints import JOINTS, PerJoint
from fes_mj.linkage.legs import TWO_LEGS, Leg, all_legs, delayed
from fes_mj.moments.drive import DRIVE_POINTS, breaks, driven
from fes_mj.moments.joint_moments import JointMoments
from fes_mj.riding.muscle_table import NO_MUSCLES, MuscleTable, at_rest, muscle_table
from fes_mj.riding.stimulated import StimulatedRider, felt_over

# Errors over a turn of the muscles' work, and of what inertia and recoil change, as parts of the work without sign and
# of the largest inertia and recoil; those of all cells, or steps, are added up without their own signs.
CELL_TOLERANCE, STEP_TOLERANCE = 1e-5, 1e-4
LEAST_PUSH = 1e-3  # N m, of moments that are next to nothing
MOST_CELLS = 64 * DRIVE_POINTS
LONGEST_STEP = math.radians(4.0)
REST_POINTS = 360  # crank angles at which stimulation at a stand is known


class LegTable(NamedTuple):
    """Over uniform crank angles of a turn, the last axis, the first repeated at its end: cells + 1.

    masses: of both legs together, each of shape (cells + 1,). joint_rate: per crank speed, and moment: N m, by
    lookup.DRIVEN, shape (4, cells + 1); of a ride by muscles no moment, but `muscles`. push: virtual work of the legs
    at a stand per crank angle, N m. ahead, behind: crank angles at which a step that begins in the cell after a row
    ends at the latest, rad, shape (cells,).
    """

    masses: CrankInertia
    joint_rate: FloatArray
    moment: FloatArray
    muscles: MuscleTable
    push: FloatArray
    ahead: FloatArray
    behind: FloatArray


@lru_cache(maxsize=32)
def leg_table(design: Design, drive: JointMoments | StimulatedRider, fineness: int = 1) -> LegTable:
    """The table of a design. fineness: divides cells and steps.

    Raises InputError where not even MOST_CELLS are enough.
    """
    cells, legs = DRIVE_POINTS, _legs(design, drive, DRIVE_POINTS)
    while _cell_error(legs.curves) > CELL_TOLERANCE:
        cells *= 2
        if cells > MOST_CELLS:
            raise InputError(
                f"{design.name}: a ride needs more than {MOST_CELLS:,} crank angles a turn; keep the links farther "
                "from their dead centres"
            )
        legs = _legs(design, drive, cells)
    there, back = _steps(legs), _steps(legs.mirrored)
    if fineness > 1:
        legs = _legs(design, drive, fineness * cells)
    rows, cell = np.arange(fineness * cells), 2 * np.pi / (fineness * cells)
    ahead = rows + np.minimum(np.repeat(there, fineness), legs.room)
    behind = rows + 1 - np.minimum(np.repeat(back, fineness), legs.mirrored.room)[::-1]
    closed = CrankInertia(*map(_closed, legs.masses)), _closed(legs.joint_rate), _closed(legs.moment)
    return LegTable(*closed, legs.muscles, _closed(legs.push), cell * ahead, cell * behind)


class _Legs(NamedTuple):
    """Of both legs over uniform crank angles of a turn: fields of LegTable, and whether the moments break in each cell.

    curves: what is integrated over the crank angle, in units of what the tolerances are parts of, shape (..., cells).
    """

    masses: CrankInertia
    joint_rate: FloatArray
    moment: FloatArray
    muscles: MuscleTable
    push: FloatArray
    breaks: BoolArray
    curves: FloatArray

    @property
    def mirrored(self) -> "_Legs":
        """As a crank that turns backwards comes across them; curves and breaks only."""
        return self._replace(breaks=self.breaks[::-1], curves=np.roll(self.curves[:, ::-1], 1, axis=1))

    @property
    def room(self) -> IntArray:
        """Cells from each row on to the next end of one with a break."""
        count, broken = len(self.breaks), np.flatnonzero(self.breaks)
        if not len(broken):
            return np.full(count, count)
        ends = np.unique(np.concatenate([broken, broken + 1, broken + count, broken + count + 1]))
        return np.asarray(ends[np.searchsorted(ends, np.arange(count), "right")] - np.arange(count))


def _legs(design: Design, drive: JointMoments | StimulatedRider, cells: int) -> _Legs:
    motion = kinematics.solve(design, kinematics.uniform_turn(cells))
    masses = CrankInertia(*map(all_legs, crank_inertia(motion)))
    rate = _by_driven(dict.fromkeys(TWO_LEGS, motion.joint_rate))
    if isinstance(drive, JointMoments):
        by_leg = {leg: drive.of_leg(leg.prefix) for leg in TWO_LEGS}
        moment, muscles = _by_driven({leg: driven(motion, moments) for leg, moments in by_leg.items()}), NO_MUSCLES
        push = (rate * moment).sum(axis=0)
        pulls = push[None]
        broken = np.logical_or(*(delayed(breaks(motion, by_leg[leg].measured_on), leg.lag) for leg in TWO_LEGS))
    else:
        moment, muscles, broken = np.zeros((0, cells)), muscle_table(drive.riders, motion), np.zeros(cells, bool)
        angle = kinematics.uniform_turn(REST_POINTS)
        active = [
            np.interp(motion.crank_angle, angle, group, period=2 * np.pi)
            for group in felt_over(drive.stimulator, angle, 0.0)
        ]
        push = all_legs(at_rest(muscles, np.array(active)))
        pulls = all_legs(muscles.drive[:-1].T)
    work = 2 * np.pi * max(float(np.abs(pulls).mean(axis=1).max()), LEAST_PUSH)
    inertia, recoil = masses.inertia_rate / masses.inertia.max(), masses.recoil_rate / np.abs(masses.recoil).max()
    return _Legs(masses, rate, moment, muscles, push, broken, np.vstack([pulls / work, inertia, recoil]))


def _by_driven(of_legs: dict[Leg, PerJoint[FloatArray]]) -> FloatArray:
    """Curves of both joints of both legs over the crank angle, in the order of lookup.DRIVEN."""
    return np.array([delayed(curve[joint], leg.lag) for leg, curve in of_legs.items() for joint in JOINTS])


def _cell_error(curves: FloatArray) -> float:
    """Error of the integrals over a turn by straight lines between the rows: a third of what every other row adds."""
    first, middle, last = curves[:, ::2], curves[:, 1::2], np.roll(curves[:, ::2], -1, axis=1)
    return float(np.abs(first - 2 * middle + last).sum(axis=1).max() * np.pi / curves.shape[1] / 3)


def _steps(legs: _Legs) -> IntArray:
    """Longest step forward from each row, in cells: Simpson's rule against the cells' straight lines."""
    curves, count, room = legs.curves, len(legs.breaks), legs.room
    cell, rows = 2 * np.pi / count, np.arange(count)
    twice = np.concatenate([curves, curves, curves[:, :1]], axis=1)
    integral = np.zeros(twice.shape)
    np.cumsum((twice[:, :-1] + twice[:, 1:]) * (cell / 2), axis=1, out=integral[:, 1:])
    steps, good, size = np.ones(count, int), np.ones(count, bool), 2
    while size * cell <= LONGEST_STEP:
        ahead = np.minimum(size, room)
        end, below, above = rows + ahead, rows + ahead // 2, rows + (ahead + 1) // 2
        simpson = (twice[:, rows] + 2 * (twice[:, below] + twice[:, above]) + twice[:, end]) * (ahead * cell / 6)
        error = np.abs(simpson - (integral[:, end] - integral[:, rows])).max(axis=0)
        good &= error <= STEP_TOLERANCE * ahead / count
        steps[good] = ahead[good]
        size *= 2
    return steps


def _closed(turn: FloatArray) -> FloatArray:
    """A curve over a turn with its first value repeated at its end."""
    closed = np.concatenate([turn, turn[..., :1]], axis=-1)
    closed.setflags(write=False)
    return closed
