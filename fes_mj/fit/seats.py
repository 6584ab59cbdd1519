"""Seats that move and recline, how well they suit their riders, and which of them is better."""

import math
from typing import Any, NamedTuple

import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.linkage.design import Design
from fes_mj.statics.cycles import Cycles, cycles
from fes_mj.statics.work_table import WorkTable

# A seat is better than another first by the range of the moments, then by power, then by the way: what differs by less
# than 0.1 deg and 0.01 W counts as equal, and here a little less, by which the best that a search knows may be off. A
# degree of which nothing is known is worth no power.
OUTSIDE_EQUAL, POWER_EQUAL = 0.0999, 0.0095  # deg, W
_BACK = 0.5  # m, of a backrest: what a change of its angle counts as
_NO_TURN = 1e4  # deg, more than joints can be outside: where the linkage does not turn
_WORSE = 1e5  # W or deg, more than any power or angle


class Seats(NamedTuple):
    """Where seats have moved to: towards the crank and up, m, and the seat angle's change, rad; numbers or arrays."""

    forward: Any
    up: Any
    recline: Any

    def moved(self, design: Design) -> Design:
        """The design with its seat moved so, a batch for arrays of shape (seats, 1)."""
        angle = design.linkage.seat_angle + self.recline
        return design.with_linkage(ground=design.linkage.ground + self.shift, seat_angle=angle)

    @property
    def shift(self) -> Any:
        """What R1 changes by, m, complex: the crank comes as much nearer as the seat goes towards it."""
        return self.forward - 1j * self.up

    @property
    def distance(self) -> Any:
        """How far the seat has moved, m."""
        return np.sqrt(self.forward**2 + self.up**2 + (_BACK * self.recline) ** 2)


class SeatLimits(NamedTuple):
    """Smallest and largest of each number of Seats."""

    forward: tuple[float, float] = (-0.05, 0.30)
    up: tuple[float, float] = (-0.15, 0.15)
    recline: tuple[float, float] = (-math.radians(20), math.radians(20))


SEAT_LIMITS = SeatLimits()


class Scores(NamedTuple):
    """How well seats suit their riders, shape (riders, seats) each.

    outside: deg by which knee and hip leave the moments' range at either end, added up; where the linkage does not turn
    more than any that does, and the more the leg lacks. power: W, of one leg; less than any without a turn. distance:
    m, of the seat from where it is drawn.
    """

    outside: FloatArray
    power: FloatArray
    distance: FloatArray


def score(design: Design, seats: Seats, table: WorkTable) -> Scores:
    """Of a design, or a batch of riders, with its seats moved, shape (seats, 1) each; the first set of moments counts.

    Shape (seats,) each.
    """
    moved = seats.moved(design)
    turn = cycles(moved, table)
    power = turn.power(moved.linkage.cadence)[:, 0]
    return Scores(
        np.where(turn.turns, outside_range(turn), _NO_TURN - 1e3 * turn.turning.reach),
        np.where(turn.turns, power, -_WORSE),
        np.broadcast_to(np.ravel(seats.distance), turn.turns.shape),
    )


def outside_range(turn: Cycles) -> FloatArray:
    """How far joints leave the moments' range, at either end, added up, deg, shape (designs,)."""
    total = np.zeros(turn.turns.shape)
    for joint, (bottom, top) in turn.reference.ranges.items():
        low, high, *_ = turn.joints[joint]
        shift = turn.reference.turns_to_range(joint, low, high)
        total += np.maximum(bottom - low - shift, 0) + np.maximum(high + shift - top, 0)
    return np.degrees(total)


def losses(
    seats: Scores,
    offered: Scores,
    aims: int = 3,
    power_slack: float = POWER_EQUAL,
    outside_slack: FloatArray | float = OUTSIDE_EQUAL,
) -> FloatArray:
    """What to minimise over the seats of each rider, to find the best of those offered, shape as `seats`.

    aims: 1 for the least outside, 2 for the most power of those, 3 for the shortest way of those. power_slack,
    outside_slack: what counts as equal, W and deg.
    """
    if aims == 1:
        return seats.outside
    outside = offered.outside.min(axis=-1, keepdims=True) + outside_slack
    most = np.where(offered.outside <= outside, offered.power, -_WORSE).max(axis=-1, keepdims=True)
    short = np.maximum(most - power_slack - seats.power, 0)
    in_range = -seats.power if aims == 2 else np.where(short > 0, _WORSE + short, seats.distance)
    return np.where(seats.outside > outside, _WORSE**2 + seats.outside, in_range)
