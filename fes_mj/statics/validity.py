"""Can a design be computed, and at which cadence? One rule for every command, for a single design and for a batch."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np

from fes_mj.common.errors import AssemblyError, InputError
from fes_mj.linkage.design import BRANCHES, Design
from fes_mj.linkage.legs import LEGS
from fes_mj.linkage.turning import Obstacle, Turning, turning
from fes_mj.linkage.variables import VARIABLES, crank_speed, runnable
from fes_mj.moments.joint_moments import JointMoments
from fes_mj.moments.reference_tricycle import ReferenceTricycle
from fes_mj.statics.extrapolation import beyond, never_inside

if TYPE_CHECKING:
    from fes_mj.common.arrays import FloatArray
    from fes_mj.statics.cycles import Cycles


def valid_speed(design: Design, moments: JointMoments, cadence: float | None = None, legs: int = 1) -> float:
    """Crank speed of a run, rad/s, of a design that can be run: `cadence`, or if it is None that of Eq. 16.

    Raises InputError for a batch of designs, a cadence that is none, and joints that never enter the moments' range,
    AssemblyError, which is one, unless the linkage turns.
    """
    for leg in LEGS[legs]:
        turning_in_range(design, moments.of_leg(leg.prefix).measured_on)
    return crank_speed(design, cadence)


def obstacles(turn: Cycles, cadence: FloatArray) -> tuple[Obstacle, ...]:
    """Why valid_speed refuses designs of a batch; of several that hinder one the first counts. cadence: rad/s."""
    never = (
        Obstacle(f"the {joint} never enters the range of the moments", outside)
        for joint, outside in turn.outside[1].items()
    )
    allowed = VARIABLES["cadence_rpm"]
    too_slow_or_fast = Obstacle(
        f"its cadence is not within {allowed.low:g} to {allowed.high:g} rpm", ~runnable(cadence)
    )
    return (*turn.turning.obstacles, *never, too_slow_or_fast)


def turning_in_range(design: Design, reference: ReferenceTricycle) -> Turning:
    """The turning of a design each of whose joints enters the range of moments measured on `reference`.

    Raises InputError, with the likely cause, unless it does, and AssemblyError, which is one, unless it turns.
    """
    try:
        turn = turning(design)
    except AssemblyError as error:
        raise AssemblyError(f"{error}{_likely_cause(design, reference)}") from None
    never = _joints_without_data(turn, reference)
    if never:
        helps = _likely_cause(design, reference) + _other_seat(design, turn, reference)
        raise InputError(f"{design.name}: {'; '.join(never)}: it never comes into that range{helps}")
    return turn


@lru_cache(maxsize=64)
def _joints_without_data(turn: Turning, reference: ReferenceTricycle) -> list[str]:
    """What to say of each joint that never enters the range."""
    angles = turn.motion.joint_angle
    outside = never_inside(beyond(reference, angles))
    never = []
    for joint, angle in angles.items():
        if outside[joint]:
            ends = (angle.min(), angle.max()), reference.ranges[joint]
            moved, measured = (f"{low:.1f} to {high:.1f} deg" for low, high in np.degrees(ends))
            never.append(f"the {joint} moves from {moved}, the moments are known from {measured}")
    return never


def _likely_cause(design: Design, reference: ReferenceTricycle) -> str:
    """What a sketch in other axes has wrong: of the changes that make a design valid that with the smallest excess."""
    likely = []
    for cause, changes in _causes(design):
        changed = design.with_linkage(**changes)
        with suppress(AssemblyError):
            turn = turning(changed)
            if changed != design and not _joints_without_data(turn, reference):
                likely.append((_worst(turn, reference), cause))
    return f". Likely cause: {min(likely, key=lambda pair: pair[0])[1]}" if likely else ""


def _other_seat(design: Design, turn: Turning, reference: ReferenceTricycle) -> str:
    """The seat angle with which the hip swings in the middle of its range; nothing where the knee is outside too."""
    swing, measured = turn.motion.joint_angle.hip, reference.ranges.hip
    seat = np.round(np.degrees(design.linkage.seat_angle + (swing.min() + swing.max() - sum(measured)) / 2))
    other = turning(design.with_linkage(seat_angle=float(np.radians(seat))))
    return "" if _joints_without_data(other, reference) else f". With another seat it does: seat_angle = {seat:g}"


def _worst(turn: Turning, reference: ReferenceTricycle) -> float:
    """Largest excess of a joint beyond the moments' range, in half ranges."""
    return max(
        float(np.abs(reference.excess(joint, angle)).max()) / reference.half_range(joint)
        for joint, angle in turn.motion.joint_angle.items()
    )


def _causes(design: Design) -> Iterator[tuple[str, dict[str, Any]]]:
    ground, arm, seat = design.linkage.ground, design.linkage.pivot_to_crank, design.linkage.seat_angle
    both = "R1" if design.linkage.kind == "trt" else "R1 and R7"
    other_ground = -ground.conjugate()
    backwards = "x is backwards, so R1's x is usually negative"
    yield f"{backwards}; here it has the wrong sign", {"ground": other_ground}
    mirrored = {"ground": other_ground, "pivot_to_crank": -arm.conjugate()}
    yield f"the rider faces +x in this sketch; {backwards}: change the sign of x in {both}", mirrored
    flipped = {"ground": ground.conjugate(), "pivot_to_crank": arm.conjugate()}
    yield f"y is down in this sketch; here it is up: change the sign of y in {both}", flipped
    turned = {"ground": -ground, "pivot_to_crank": -arm}
    yield f"x is forwards and y down in this sketch; change the signs of both in {both}", turned
    measured = f"the seat angle is measured from the other side; seat_angle = {180 - np.degrees(seat):g}"
    yield measured, {"seat_angle": np.pi - seat}
    if design.linkage.kind != "trt":
        other = next(branch for branch in BRANCHES if branch != design.linkage.branch)
        yield f'the rocker joint lies on the other side; branch = "{other}"', {"branch": other}
