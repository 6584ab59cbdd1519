"""The seat for a rider: where the hip must lie against the frame for linkage and joints to go along, with most power.

A seat that slides and reclines moves the hip against the frame: R1 and the seat angle change, the linkage does not.
"""

import math
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

from fes_mj.common.brief import Brief
from fes_mj.common.errors import InputError
from fes_mj.fit.ground import above_ground, underground
from fes_mj.fit.search import best_seats
from fes_mj.fit.seats import SEAT_LIMITS, SeatLimits, Seats
from fes_mj.linkage.design import Design, Rider
from fes_mj.linkage.variables import crank_speed
from fes_mj.moments.joint_moments import JointMoments
from fes_mj.statics.turn import LegTurns
from fes_mj.statics.work_table import WorkTable

_CRANKS = (0.9, 0.8, 0.7, 0.6, 0.5)  # parts of the crank that are tried for a rider whom no seat suits
_AT_END = 1e-6  # m and rad, as near as rounding leaves a seat to the end of a range
_WIDER = 0.30  # m and rad, by which the limits are widened for the same


@dataclass(frozen=True, repr=False)
class SeatFit(Brief):
    """The best seat of a design, as drawn, for a rider within limits.

    design: with the rider and the seat moved. static: its turn, of both legs if each has moments of its own; None if
    the rider does not fit, and then `why` says by how much and at which crank angle.
    """

    drawn: Design
    rider: Rider
    moments: JointMoments
    limits: SeatLimits
    seat: Seats
    design: Design
    static: LegTurns | None
    why: str | None

    @property
    def brief(self) -> str:
        outcome = seat_text(self.seat) if self.fits else "does not fit"
        return f"{self.drawn.name} {self.moments.name}: {outcome}"

    @property
    def fits(self) -> bool:
        return self.static is not None

    @property
    def ends(self) -> list[str]:
        """Of which ranges the seat is at the very end, where a wider one might do better: names as in SeatLimits."""
        return [
            name
            for name, value, (low, high) in zip(Seats._fields, self.seat, self.limits, strict=True)
            if low < high and min(value - low, high - value) < _AT_END
        ]

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
            "seat_shift_m": [round(part, 6) for part in (self.seat.shift.real, self.seat.shift.imag)],
            "seat_angle_deg": math.degrees(self.design.linkage.seat_angle),
            **{key: turn.get(key) for key in keys},
            "at_end_of": self.ends,
            "power_unmoved_W": self._power_as_drawn(self.rider),
            "power_paper_rider_W": self._power_as_drawn(Rider()),
            "why": self.why,
            "helps": [] if self.fits else self.helps,
        }

    def _power_as_drawn(self, rider: Rider) -> float | None:
        """Mean crank power of a rider with the seat as drawn, W; None if the linkage does not turn with him or her."""
        with suppress(InputError):
            return _turn(replace(self.drawn, rider=rider), self.moments).power_mean
        return None


def fit_seat(design: Design, rider: Rider, moments: JointMoments, limits: SeatLimits = SEAT_LIMITS) -> SeatFit:
    """The best seat of a design for a rider: least outside the moments' range, then most mean power, then nearest.

    By seats.losses, in steps of 0.01 mm and 0.001 deg.

    That no seat within the limits suits is a result as well. Raises AssemblyError for a linkage that cannot turn
    whoever sits where, InputError for a cadence that cannot be run and for a batch.

    >>> rider = fes_mj.Rider(thigh=0.45, shank=0.47, mass=62, sex="female")
    >>> fes_mj.fit_seat(fes_mj.load_design("d1"), rider, fes_mj.load_moments("p1p2"))
    <SeatFit d1 p1p2: 9.6 cm towards the crank, 8.3 cm up, seat angle +3.3 deg>
    """
    crank_speed(design)
    limits = above_ground(design, limits)
    seats, _ = best_seats(design, [rider.thigh], [rider.shank], WorkTable.of(moments), limits)
    seat, why = Seats(*(float(move[0]) for move in seats)), None
    seated = replace(design, rider=rider)
    if any(seat):
        seated = replace(_in_workshop_digits(seat.moved(seated)), frame=design.frame.moved(complex(seat.shift)))
    static = None
    try:
        turn = _turn(seated, moments)
        if not (why := underground(seated)):
            static = turn
    except InputError as error:
        why = str(error)
    return SeatFit(design, rider, moments, limits, seat, seated, static, why)


def _turn(design: Design, moments: JointMoments) -> LegTurns:
    return LegTurns.solve(design, moments, crank_speed(design), len(moments.of_legs))


def _in_workshop_digits(design: Design) -> Design:
    """The design without what adding floats leaves of R1 (m) and of the seat angle (deg) behind the sixth digit."""
    ground, seat_angle = design.linkage.ground, math.degrees(design.linkage.seat_angle)
    rounded = complex(round(ground.real, 6), round(ground.imag, 6))
    return design.with_linkage(ground=rounded, seat_angle=math.radians(round(seat_angle, 6)))


def seat_text(seat: Seats) -> str:
    """A seat's move in words."""
    directions = ((seat.forward, "towards the crank", "away from the crank"), (seat.up, "up", "down"))
    moves = [f"{100 * abs(by):.1f} cm {onto if by > 0 else back}" for by, onto, back in directions if abs(by) >= 5e-4]
    if abs(seat.recline) >= math.radians(0.05):
        moves.append(f"seat angle {math.degrees(seat.recline):+.1f} deg")
    return ", ".join(moves) or "stays where it is"
