"""Does a linkage turn right round? Established once: one design as a `Turning`, a batch as a `BatchTurning`."""

from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import NamedTuple

import numpy as np

from fes_mj.common.arrays import BoolArray, ComplexArray, FloatArray
from fes_mj.common.errors import AssemblyError
from fes_mj.linkage.assembly import (
    DYADS,
    LEAST_CLEARANCE,
    NEAR,
    SCAN,
    Clearance,
    clearances,
    pedal_extreme,
    rocker_clearance,
    span_limits,
)
from fes_mj.linkage.design import Design
from fes_mj.linkage.kinematics import Motion, solve

LARGEST_SWING = np.pi  # rad, of the thigh: more than any hip can do
CRANK_ZERO = "the crank points backwards (+x)"  # where every crank angle that is printed begins
FROM_TOP = "crank_angle_from_tdc_deg"  # the name of such angles in files


@dataclass(frozen=True, eq=False)
class Turning:
    """A design whose linkage turns right round.

    motion: over the crank angles SCAN. clearances: of every dyad from its dead centres.
    """

    design: Design
    motion: Motion
    clearances: tuple[Clearance, ...]

    @cached_property
    def top_dead_centre(self) -> float:
        """Crank angle at which the leg is bent most, the pedal nearest to the hip, rad within [0, 2 pi)."""
        nearest = int(np.abs(self.motion.points["pedal"].value).argmin())
        return float(pedal_extreme(self.design, SCAN[[nearest]], -1)[0, 0]) % (2 * np.pi)

    def degrees_from_top(self, crank_angle: FloatArray) -> FloatArray:
        """Crank angles (rad from the crank pointing backwards) from top dead centre, deg within [0, 360)."""
        return np.asarray(np.degrees(crank_angle - self.top_dead_centre) % 360)


@lru_cache(maxsize=64)
def _established(design: Design) -> Turning:
    motion = solve(design, SCAN)
    margins = clearances(design, {name: jet.value for name, jet in motion.points.items()})
    for clearance in margins:
        _require_clearance(design, clearance)
    swing = float(np.ptp(motion.joint_angle.hip))
    if swing >= LARGEST_SWING:
        raise AssemblyError(
            f"{design.name}: the thigh swings through {np.degrees(swing):.0f} deg; no hip moves by "
            f"{np.degrees(LARGEST_SWING):.0f} deg or more"
        )
    return Turning(design, motion, tuple(margins))


def turning(design: Design) -> Turning:
    """What is established of a design whose linkage turns; asked again, the same object.

    Raises AssemblyError, naming links, crank angle and margin, unless it turns, and InputError for a batch.
    """
    design.require_single()
    return _established(design)


class Obstacle(NamedTuple):
    """A reason why designs of a batch do not turn right round, and those that it hinders, shape (designs,)."""

    reason: str
    hindered: BoolArray


class BatchTurning(NamedTuple):
    """Which designs of a batch turn right round, by the rules of `turning`.

    reach: m, clearance of the leg from being stretched or folded flat, negative if it lacks, shape (designs,).
    obstacles: why designs do not turn; of several that hinder a design the first counts.
    """

    reach: FloatArray
    obstacles: tuple[Obstacle, ...]

    @property
    def turns(self) -> BoolArray:
        """Which designs turn, shape (designs,)."""
        return np.asarray(~np.logical_or.reduce([obstacle.hindered for obstacle in self.obstacles]))


def leg_reach(design: Design, pedal: ComplexArray) -> FloatArray:
    """Clearance of the legs of a batch with the pedal at these positions (m, last axis) over a turn, shape (designs,).

    As a BatchTurning has it, but for what the pedal does between the positions.
    """
    distance = np.atleast_2d(np.abs(pedal))
    shortest, longest = span_limits(design, ("thigh", "shank"))
    reach = np.minimum(longest - distance.max(axis=1), distance.min(axis=1) - shortest)
    return np.broadcast_to(reach, design.size)  # where seat, mass or gear ratio are all that varies


def batch_turning(design: Design, reach: FloatArray, swing: FloatArray) -> BatchTurning:
    """Of a batch whose leg_reach over a turn (m) and swing of the thigh (rad) are known, shape (designs,) each."""
    by_rocker: tuple[Obstacle, ...] = ()
    if "coupler" in design.linkage.architecture.bodies:
        by_rocker = _shortfalls(("rocker", "coupler"), rocker_clearance(design).margin)
    doubtful = (reach > 0) & (reach < NEAR) & (swing < LARGEST_SWING)
    for obstacle in by_rocker:
        doubtful = doubtful & ~obstacle.hindered
    rows = np.flatnonzero(doubtful)
    if rows.size:  # so near to a dead centre the extremes between the angles count
        reach = np.array(reach)
        reach[rows] = clearances(design.taken(rows))[-1].margin
    too_far = Obstacle(f"the thigh swings through {np.degrees(LARGEST_SWING):.0f} deg or more", swing >= LARGEST_SWING)
    obstacles = (*by_rocker, *_shortfalls(("thigh", "shank"), reach), too_far)
    return BatchTurning(
        reach, tuple(Obstacle(reason, np.broadcast_to(hindered, reach.shape)) for reason, hindered in obstacles)
    )


def _shortfalls(links: tuple[str, str], margin: FloatArray) -> tuple[Obstacle, ...]:
    """Why a dyad with such a clearance (m, shape (designs,)) cannot turn."""
    pair = " and ".join(links)
    return (
        Obstacle(f"{pair} cannot close", ~(margin >= 0)),
        Obstacle(
            f"{pair} within {1e3 * LEAST_CLEARANCE:g} mm of a dead centre", (margin >= 0) & (margin < LEAST_CLEARANCE)
        ),
    )


def _require_clearance(design: Design, clearance: Clearance) -> None:
    """Raise AssemblyError, naming links, crank angle and margin, unless a dyad passes clear of its dead centres."""
    links, margin, span, angle = clearance
    reason = next((obstacle.reason for obstacle in _shortfalls(links, margin) if obstacle.hindered[0]), None)
    if reason is None:
        return
    start, end, _ = (name.replace("_", " ") for name in DYADS[links])
    shortest, longest = (float(length[0]) for length in span_limits(design, links))
    apart = (
        f"{design.name}: {reason} at crank angle {np.degrees(angle[0]):.1f} deg: {start} and {end} are {span[0]:.4f} m "
        f"apart there, the two links reach from {shortest:.4f} to {longest:.4f} m; "
    )
    if margin[0] < 0:
        raise AssemblyError(f"{apart}{-1e3 * margin[0]:.4g} mm lack")
    state = "in line" if span[0] > (shortest + longest) / 2 else "folded flat"
    raise AssemblyError(
        f"{apart}{1e3 * margin[0]:.2g} mm from being {state}, where the motion is not determined; "
        f"{1e3 * LEAST_CLEARANCE:g} mm are needed"
    )
