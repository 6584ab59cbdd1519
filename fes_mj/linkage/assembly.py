"""A linkage before any force acts: how far from its dead centres, how far do its joints go, how does it transmit?"""

from typing import Any, NamedTuple

import numpy as np

from fes_mj.common.arrays import ComplexArray, FloatArray
from fes_mj.linkage.design import Design
from fes_mj.linkage.kinematics import FULL_TURN, Motion, Points, joint_angles, positions, solve, uniform_turn

# Links of each dyad -> the points they span, and the joint between them.
DYADS = {
    ("rocker", "coupler"): ("rocker_pivot", "crank_pin", "rocker_joint"),
    ("thigh", "shank"): ("hip", "pedal", "knee"),
}
# m: closer to a dead centre the motion is not determined. Lengths are not made more exactly, and nearer than this the
# time step runs into rounding at high speed; results/time_step.md has what agrees from 0.15 mm on.
LEAST_CLEARANCE = 1e-4
# Angles between which the extremes of the leg's span are sought. A rocker LEAST_CLEARANCE from its dead centre passes
# it within 2 deg, in which the pedal moves by a few millimetres: less than NEAR, within which extremes are exact.
SCAN = uniform_turn(120)
NEAR = 0.01  # m
_ITERATIONS = 20  # halving the steps of SCAN, where Newton does not help, leaves 5e-8 rad


class Clearance(NamedTuple):
    """How far a dyad stays from its dead centres, stretched and folded, over a turn; arrays of shape (designs,).

    margin: m, negative if the links cannot close, NaN where the dyad before it does not. span: of the dyad's ends at
    the least margin, m, at crank_angle, rad.
    """

    links: tuple[str, str]
    margin: FloatArray
    span: FloatArray
    crank_angle: FloatArray


def clearances(design: Design, points: Points | None = None) -> list[Clearance]:
    """Clearance of every dyad, from the extremes of the distance it spans. points: `positions` at SCAN, if known.

    A circle's extremes are known, those of the coupler curve (and the rocker's arc) are zeros of the radial velocity.
    """
    linkage = design.linkage
    if "coupler" not in linkage.architecture.bodies:
        return [_clearance(design, ("thigh", "shank"), *_of_circle(linkage.crank_centre, linkage.crank))]
    pedal = np.atleast_2d((points or positions(design, SCAN))["pedal"])
    return [rocker_clearance(design), _clearance(design, ("thigh", "shank"), *_of_pedal(design, pedal))]


def rocker_clearance(design: Design) -> Clearance:
    """Clearance of the rocker and the coupler of a six-bar."""
    circle = _of_circle(design.linkage.pivot_to_crank, design.linkage.crank)
    return _clearance(design, ("rocker", "coupler"), *circle)


def _of_circle(centre: Any, radius: Any) -> tuple[FloatArray, FloatArray]:
    """Smallest and largest distance of a circle from the origin, m, and where, rad; shape (2, designs)."""
    distance, angle = np.ravel(np.abs(centre)), np.ravel(np.angle(centre))
    radius = np.ravel(radius)
    return np.stack([np.abs(distance - radius), distance + radius]), np.stack([angle + np.pi, angle])


def _of_pedal(design: Design, pedal: ComplexArray) -> tuple[FloatArray, FloatArray]:
    """The same for hip and pedal; pedal: at SCAN, shape (designs, angles)."""
    distance = np.broadcast_to(np.abs(pedal), (design.size, len(SCAN)))
    ends = np.stack([distance.argmin(axis=1), distance.argmax(axis=1)])
    spans, angles = np.take_along_axis(distance, ends.T, axis=1).T, SCAN[ends]
    shortest, longest = span_limits(design, ("thigh", "shank"))
    margins = np.stack([spans[0] - shortest, longest - spans[1]])
    for end, sign in enumerate((-1, 1)):  # every local extreme that could be the one
        height = sign * distance
        peak = (height >= np.roll(height, 1, axis=1)) & (height > np.roll(height, -1, axis=1))
        peak &= (margins[end][:, None] < NEAR) & (height > sign * spans[end][:, None] - NEAR)
        rows, columns = np.nonzero(peak)
        if rows.size:
            exact_angle = pedal_extreme(design.taken(rows), SCAN[columns], sign)
            exact = np.abs(positions(design.taken(rows), exact_angle)["pedal"])[:, 0]
            for row, value, angle in zip(rows, exact, exact_angle[:, 0], strict=True):
                if not sign * value < sign * spans[end, row]:
                    spans[end, row], angles[end, row] = value, angle
    return spans, angles


def pedal_extreme(design: Design, angle: FloatArray, sign: int) -> FloatArray:
    """Crank angles, shape (designs, 1), within a step of `angle` where the pedal's distance stops to grow (sign 1)."""
    angle = angle[:, None]
    low, high = angle - SCAN[1], angle + SCAN[1]
    for _ in range(_ITERATIONS):  # Newton's, kept between the two angles by halves
        value, first, second = solve(design, angle).points["pedal"]
        slope = (np.conj(value) * first).real
        growing = sign * slope > 0
        low, high = np.where(growing, angle, low), np.where(growing, high, angle)
        angle = angle - slope / (np.abs(first) ** 2 + (np.conj(value) * second).real)
        angle = np.where((low < angle) & (angle < high), angle, (low + high) / 2)
    return np.asarray(angle)


def _clearance(design: Design, links: tuple[str, str], spans: FloatArray, angles: FloatArray) -> Clearance:
    shortest, longest = span_limits(design, links)
    margins = np.stack([spans[0] - shortest, longest - spans[1]])
    worst = np.argmin(margins, axis=0)[None]
    margin, span, angle = (
        np.take_along_axis(values, worst, axis=0)[0] for values in np.broadcast_arrays(margins, spans, angles)
    )
    return Clearance(links, margin, span, angle % (2 * np.pi))


def span_limits(design: Design, links: tuple[str, str]) -> tuple[FloatArray, FloatArray]:
    """Shortest and longest distance that two links can span, m, shape (designs,)."""
    first, second = (np.ravel(design.link_lengths[link]) for link in links)
    return np.abs(first - second), first + second


def joint_ranges(design: Design, crank_angle: FloatArray = FULL_TURN) -> FloatArray:
    """Knee minimum and maximum, hip minimum and maximum, deg; NaN if it cannot close.

    Shape (4,), or (designs, 4) for a batch.
    """
    angles = joint_angles(design, positions(design, crank_angle))
    ends = [f(angle, axis=-1) for angle in angles for f in (np.min, np.max)]
    return np.asarray(np.degrees(np.stack(ends, axis=-1)))


def grashof_margin(design: Design) -> FloatArray:
    """Grashof's inequality with the crank as shortest link: sum of the other two less crank and longest link, m.

    The same as the rocker dyad's clearance. Shape (designs,), (1,) for a single design.
    """
    return rocker_clearance(design).margin


def transmission_angles(motion: Motion) -> dict[str, FloatArray]:
    """Smallest transmission angle over the turn, deg, at the joint of each dyad: between its links, at most 90 deg.

    Of a batch an array of shape (designs,).
    """
    angles = {}
    for (one, other), (_, _, joint) in DYADS.items():
        if joint in motion.points:
            cosine = (motion.direction(one) * np.conj(motion.direction(other))).real
            angles[joint] = np.degrees(np.acos(np.clip(np.abs(cosine), 0, 1)).min(axis=-1))
    return angles


def bounding_box(points: Points) -> tuple[complex, complex]:
    """Lower left and upper right corner of the box around all the points, m."""
    cloud = np.concatenate([np.ravel(value) for value in points.values()])
    return complex(cloud.real.min(), cloud.imag.min()), complex(cloud.real.max(), cloud.imag.max())
