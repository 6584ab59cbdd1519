"""A linkage before any force acts: does it close, how far do its joints go, how well does it transmit?"""

import numpy as np

from fes_mj.arrays import FloatArray
from fes_mj.design import Design
from fes_mj.errors import AssemblyError
from fes_mj.kinematics import FULL_TURN, Motion, Points, joint_angles, positions

# Links of each dyad -> the points they span, and the joint between them.
DYADS = {
    ("rocker", "coupler"): ("rocker_pivot", "crank_pin", "rocker_joint"),
    ("thigh", "shank"): ("hip", "pedal", "knee"),
}


def require_assembly(design: Design) -> None:
    """Raise AssemblyError, naming the links and the crank angle, unless the linkage closes over the whole turn."""
    points, link_lengths = positions(design, FULL_TURN), design.link_lengths
    for (first, second), (start, end, joint) in DYADS.items():
        if joint not in points:
            continue
        span = np.broadcast_to(np.abs(points[end] - points[start]), FULL_TURN.shape)
        shortest = abs(link_lengths[first] - link_lengths[second])
        longest = link_lengths[first] + link_lengths[second]
        excess = np.maximum(span - longest, shortest - span)
        worst = int(np.argmax(excess))
        if excess[worst] >= 0:
            raise AssemblyError(
                f"{design.name}: {first} and {second} cannot close at crank angle "
                f"{np.degrees(FULL_TURN[worst]):.1f} deg: {start.replace('_', ' ')} and {end.replace('_', ' ')} are "
                f"{span[worst]:.4f} m apart there, the two links reach from {shortest:.4f} to {longest:.4f} m"
            )


def joint_ranges(design: Design, crank_angle: FloatArray = FULL_TURN) -> FloatArray:
    """Knee minimum and maximum, hip minimum and maximum, deg; NaN if it cannot close.

    Shape (4,), or (designs, 4) for a batch.
    """
    angles = joint_angles(design, positions(design, crank_angle))
    ends = [f(angle, axis=-1) for angle in angles for f in (np.min, np.max)]
    return np.asarray(np.degrees(np.stack(ends, axis=-1)))


def grashof_margin(design: Design) -> FloatArray:
    """Grashof's inequality with the crank as shortest link: sum of the other two less crank and longest link, m.

    Shape (), or (designs, 1) for a batch.
    """
    linkage = design.linkage
    others = np.sort(np.stack([np.abs(linkage.pivot_to_crank), linkage.coupler, linkage.rocker]), axis=0)
    return np.asarray(others[0] + others[1] - others[2] - linkage.crank)


def transmission_angles(motion: Motion) -> dict[str, float]:
    """Smallest transmission angle over the turn, deg, at the joint of each dyad: between its links, at most 90 deg."""
    angles = {}
    for (one, other), (_, _, joint) in DYADS.items():
        if joint in motion.points:
            cosine = (motion.direction(one) * np.conj(motion.direction(other))).real
            angles[joint] = float(np.degrees(np.acos(np.clip(np.abs(cosine), 0, 1)).min()))
    return angles


def bounding_box(points: Points) -> tuple[complex, complex]:
    """Lower left and upper right corner of the box around all the points, m."""
    cloud = np.concatenate([np.ravel(value) for value in points.values()])
    return complex(cloud.real.min(), cloud.imag.min()), complex(cloud.real.max(), cloud.imag.max())
