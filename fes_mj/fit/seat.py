"""The seat for a rider: where the hip must lie against the frame for linkage and joints to go along, with most power.

A seat that slides and reclines moves the hip against the frame: R1 and the seat angle change, the linkage does not.
"""

import math
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from fes_mj.common.arrays import BoolArray, FloatArray
from fes_mj.common.brief import Brief
from fes_mj.common.errors import InputError
from fes_mj.common.units import turns_per_second
from fes_mj.linkage.assembly import LEAST_CLEARANCE, grashof_margin
from fes_mj.linkage.design import Design, Rider
from fes_mj.linkage.turning import turning
from fes_mj.moments.joint_moments import JointMoments
from fes_mj.statics.cycles import Cycles, cycles
from fes_mj.statics.turn import QuasiStatic, quasi_static
from fes_mj.statics.work_table import WorkTable

# What a degree outside the moments' range counts as, W/deg. A choice: the range comes first, power second. A degree of
# which nothing is known would have to win a third of a design's power.
OUTSIDE_COST = 10.0
# What a seat's move counts as, W/m: of seats that are as good the nearest is taken, and 20 cm are worth 0.1 W.
MOVE_COST = 0.5
_BACK = 0.5  # m, of a backrest: what a change of its angle counts as
# Seats tried for a rider: a grid over the limits, then clouds around the best so far, the first as wide as the grid's
# step. tests/test_fit.py has what that leaves against a search of another kind.
_GRID, _CLOUD, _SHRINK, _ROUNDS = (9, 7, 5), 100, 0.85, 40
_AT_ONCE = 20_000  # turns in memory
_NO_TURN = -1e6  # W: worse than any seat that turns
_CRANKS = (0.9, 0.8, 0.7, 0.6, 0.5)  # parts of the crank that are tried for a rider whom no seat suits
_WIDER = 0.30  # m and rad, by which the limits are widened for the same


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
    """How well seats suit their riders, shape (seats,) each.

    fits: the linkage turns, and each joint enters the moments' range. outside: rad by which knee and hip leave it at
    either end, added up. power: W, of one leg. merit: W, of power and range; without a turn by what the leg lacks.
    """

    fits: BoolArray
    outside: FloatArray
    power: FloatArray
    merit: FloatArray


def score(design: Design, table: WorkTable) -> Scores:
    """Of a batch of designs; the first set of moments counts."""
    turn = cycles(design, table)
    outside, inside = _outside(turn)
    power = turn.work[:, 0] * turns_per_second(np.ravel(design.linkage.cadence))
    merit = np.where(turn.turns, power - OUTSIDE_COST * np.degrees(outside), _NO_TURN + turn.turning.reach)
    return Scores(turn.turns & inside, outside, power, merit)


def _outside(turn: Cycles) -> tuple[FloatArray, BoolArray]:
    """How far joints leave the moments' range, added up, rad, and whether both enter it; shape (designs,)."""
    total, inside = np.zeros(turn.turns.shape), np.ones(turn.turns.shape, bool)
    for joint, (bottom, top) in turn.reference.ranges.items():
        low, high, *_ = turn.joints[joint]
        shift = turn.reference.turns_to_range(joint, low, high)
        low, high = low + shift, high + shift
        total += np.maximum(bottom - low, 0) + np.maximum(high - top, 0)
        inside &= (high > bottom) & (low < top)
    return total, inside


def best_seats(
    design: Design,
    thigh: Sequence[float] | FloatArray,
    shank: Sequence[float] | FloatArray,
    table: WorkTable,
    limits: SeatLimits = SEAT_LIMITS,
) -> tuple[Seats, Scores]:
    """The best seat for each of several riders, with thigh and shank in m, shape (riders,).

    Raises AssemblyError for a linkage that cannot turn whoever sits where.
    """
    if "coupler" in design.linkage.architecture.bodies and grashof_margin(design)[0] < LEAST_CLEARANCE:
        turning(design)
    low, high = (np.array(ends) for ends in zip(*limits, strict=True))
    axes = [np.linspace(*ends, count) for ends, count in zip(limits, _GRID, strict=True)]
    grid = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
    drawn, random = np.clip(np.zeros((1, 3)), low, high), np.random.default_rng(0)
    legs = np.column_stack([thigh, shank])
    best = _best(design, legs, np.broadcast_to(np.vstack([drawn, grid]), (len(legs), len(grid) + 1, 3)), table)
    width = (high - low) / (np.array(_GRID) - 1)
    for _ in range(_ROUNDS):
        cloud = np.vstack([np.zeros((1, 3)), width * random.standard_normal((_CLOUD, 3))])
        best = _best(design, legs, np.clip(np.stack(best[0], axis=-1)[:, None] + cloud, low, high), table)
        width = width * _SHRINK
    return best


def _best(design: Design, legs: FloatArray, seats: FloatArray, table: WorkTable) -> tuple[Seats, Scores]:
    """Of the seats of each rider, shape (riders, seats, 3), the best; legs: thigh and shank, shape (riders, 2)."""
    count, chosen = seats.shape[1], []
    size = max(1, _AT_ONCE // count)
    for start in range(0, len(legs), size):
        rows = slice(start, start + size)
        thigh, shank = np.repeat(legs[rows], count, axis=0).T[..., None]
        tried = Seats(*seats[rows].reshape(-1, 3).T)
        batch = Seats(*(move[:, None] for move in tried)).moved(design.with_rider(thigh=thigh, shank=shank))
        scores = score(batch, table)
        merit = (scores.merit - MOVE_COST * tried.distance).reshape(-1, count)
        top = np.argmax(merit, axis=1) + count * np.arange(len(merit))
        chosen.append([values[top] for values in (*tried, *scores)])
    whole = [np.concatenate(parts) for parts in zip(*chosen, strict=True)]
    return Seats(*whole[:3]), Scores(*whole[3:])


@dataclass(frozen=True, repr=False)
class SeatFit(Brief):
    """The best seat of a design, as drawn, for a rider within limits.

    design: with the rider and the seat moved. static: its turn; None if the rider does not fit, and then `why` says by
    how much and at which crank angle.
    """

    drawn: Design
    rider: Rider
    moments: JointMoments
    limits: SeatLimits
    seat: Seats
    design: Design
    static: QuasiStatic | None
    why: str | None

    @property
    def brief(self) -> str:
        outcome = seat_text(self.seat) if self.fits else "does not fit"
        return f"{self.drawn.name} {self.moments.name}: {outcome}"

    @property
    def fits(self) -> bool:
        return self.static is not None

    @cached_property
    def helps(self) -> list[str]:
        """What would let a rider ride whom no seat within the limits suits."""
        texts = []
        wider = SeatLimits(*((low - _WIDER, high + _WIDER) for low, high in self.limits))
        other = fit_seat(self.drawn, self.rider, self.moments, wider)
        if other.fits:
            texts.append(f"a seat that moves farther: {seat_text(other.seat)}")
        for part in _CRANKS:
            crank = part * self.drawn.linkage.crank
            if fit_seat(self.drawn.with_linkage(crank=crank), self.rider, self.moments, self.limits).fits:
                return [*texts, f"a crank (R2) of {100 * crank:.1f} instead of {100 * crank / part:.1f} cm"]
        return texts

    def summary(self) -> dict[str, Any]:
        """The result as JSON names and units it; the keys of a turn only where there is one."""
        keys = ("power_mean_W", "power_sd_W", "knee_range_deg", "hip_range_deg", "extrapolated_share", "notes")
        turn = self.static.summary() if self.static else {}
        return {
            "design": self.drawn.name,
            "group": self.moments.name,
            "fits": self.fits,
            "rider": {key: getattr(self.rider, key) for key in ("thigh", "shank", "mass", "sex", "leg_mass_factor")},
            "seat_shift_m": [self.seat.shift.real, self.seat.shift.imag],
            "seat_angle_deg": math.degrees(self.design.linkage.seat_angle),
            **{key: turn.get(key) for key in keys},
            "power_unmoved_W": self._power_as_drawn(self.rider),
            "power_paper_rider_W": self._power_as_drawn(Rider()),
            "why": self.why,
            "helps": [] if self.fits else self.helps,
        }

    def _power_as_drawn(self, rider: Rider) -> float | None:
        """Mean crank power of a rider with the seat as drawn, W; None if the linkage does not turn with him or her."""
        with suppress(InputError):
            return quasi_static(replace(self.drawn, rider=rider), self.moments).power_mean
        return None


def fit_seat(design: Design, rider: Rider, moments: JointMoments, limits: SeatLimits = SEAT_LIMITS) -> SeatFit:
    """The best seat of a design for a rider: least outside the moments' range, then most mean power, then nearest.

    That no seat within the limits suits is a result as well. Raises AssemblyError for a linkage that cannot turn
    whoever sits where.

    >>> rider = fes_mj.Rider(thigh=0.45, shank=0.47, mass=62, sex="female")
    >>> fes_mj.fit_seat(fes_mj.load_design("d1"), rider, fes_mj.load_moments("p1p2"))
    <SeatFit d1 p1p2: 9.6 cm towards the crank, 8.9 cm up, seat angle +3.6 deg>
    """
    seats, _ = best_seats(design, [rider.thigh], [rider.shank], WorkTable.of(moments), limits)
    seat = Seats(*(float(move[0]) for move in seats))
    seated, why = seat.moved(replace(design, rider=rider)), None
    try:
        static = quasi_static(seated, moments)
    except InputError as error:
        static, why = None, str(error)
    return SeatFit(design, rider, moments, limits, seat, seated, static, why)


def seat_text(seat: Seats) -> str:
    """A seat's move in words."""
    directions = ((seat.forward, "towards the crank", "away from the crank"), (seat.up, "up", "down"))
    moves = [f"{100 * abs(by):.1f} cm {onto if by > 0 else back}" for by, onto, back in directions if abs(by) >= 5e-4]
    if abs(seat.recline) >= math.radians(0.05):
        moves.append(f"seat angle {math.degrees(seat.recline):+.1f} deg")
    return ", ".join(moves) or "stays where it is"
