"""What the reduced equation of motion must know of both legs at each crank angle, in tables over a turn."""

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from fes_mj.common.arrays import BoolArray, FloatArray
from fes_mj.linkage.design import Design
from fes_mj.linkage.inertia import CrankInertia, crank_inertia
from fes_mj.linkage.joints import JOINTS
from fes_mj.linkage.legs import TWO_LEGS, delayed
from fes_mj.moments.drive import POINTS, drive
from fes_mj.moments.joint_moments import JointMoments


class LegTable(NamedTuple):
    """Over uniform crank angles of a turn, the last axis, the first repeated at its end: POINTS + 1.

    masses: of both legs together, each of shape (POINTS + 1,). joint_rate: per crank speed, and command: N m
    (Drive.command), by muscle_response.MUSCLES, shape (4, POINTS + 1). ahead, behind: the next crank angles at which
    the moments break, rad.
    """

    masses: CrankInertia
    joint_rate: FloatArray
    command: FloatArray
    ahead: FloatArray
    behind: FloatArray


@lru_cache(maxsize=32)
def leg_table(design: Design, moments: JointMoments, lag: float = 0.0) -> LegTable:
    """The table of a design. lag: time constant of the muscles' answer, s."""
    drives = {leg: drive(design, moments.of_leg(leg.prefix), lag) for leg in TWO_LEGS}
    masses = [
        sum(delayed(curve, leg.lag) for leg, curve in zip(drives, curves, strict=True))
        for curves in zip(*(crank_inertia(own.motion) for own in drives.values()), strict=True)
    ]
    rates = [delayed(own.motion.joint_rate[joint], leg.lag) for leg, own in drives.items() for joint in JOINTS]
    commands = [delayed(own.command[joint], leg.lag) for leg, own in drives.items() for joint in JOINTS]
    breaks = np.logical_or.reduce([delayed(own.breaks, leg.lag) for leg, own in drives.items()])
    ahead, behind = map(_closed, _next_breaks(breaks))
    return LegTable(CrankInertia(*map(_closed, masses)), _closed(rates), _closed(commands), ahead, behind)


def _closed(curve: object) -> FloatArray:
    """A curve over a turn with its first value repeated at its end."""
    turn = np.asarray(curve, float)
    closed = np.concatenate([turn, turn[..., :1]], axis=-1)
    closed.setflags(write=False)
    return closed


def _next_breaks(breaks: BoolArray) -> tuple[FloatArray, FloatArray]:
    """Crank angles of the first break beyond the cells beside each row, ahead and behind, rad."""
    cells = np.flatnonzero(breaks)
    around = np.concatenate([cells - POINTS, cells, cells + POINTS])
    rows, cell = np.arange(POINTS), 2 * np.pi / POINTS
    ahead, behind = np.searchsorted(around, rows, "right"), np.searchsorted(around, rows, "left") - 1
    return cell * (around[ahead] + 0.5), cell * (around[behind] + 0.5)
