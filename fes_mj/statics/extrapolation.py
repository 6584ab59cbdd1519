"""Where joints leave the range of their moments, and what it costs in certainty."""

from dataclasses import dataclass

import numpy as np

from fes_mj.common.arrays import BoolArray, FloatArray
from fes_mj.linkage.joints import JOINTS, PerJoint
from fes_mj.linkage.kinematics import Motion
from fes_mj.moments.reference_tricycle import ReferenceTricycle
from fes_mj.moments.torque_map import TorqueMap

NO_MORE = np.radians(0.01)  # an excess of rounded dimensions


@dataclass(frozen=True)
class Extrapolation:
    """What of a turn has no data, because a joint is outside the range of the moments.

    share: of the turn in which any joint is. work_share: of the work done by the joints, counted without sign. sd: W,
    of the mean power, by not knowing the moment there. excess: by joint, how far it goes beyond, rad.
    """

    share: float
    work_share: float
    sd: float
    excess: PerJoint[float]

    @property
    def verdict(self) -> str | None:
        """What it means for the result, in words; None where nothing is extrapolated."""
        if not self.share:
            return None
        return (
            f"for {100 * self.share:.1f} % of the turn, in which {100 * self.work_share:.1f} % of the work is done, no "
            f"moments are known, which makes the mean power unsure by another {self.sd:.2g} W"
        )


def extrapolation(
    motion: Motion, torque: TorqueMap, joint_moment: PerJoint[FloatArray], cadence: float
) -> Extrapolation:
    """Of one turn over uniform crank angles; cadence: rad/s.

    The map keeps the moment of the range's end. The true one is taken to drift from it as the moments vary inside: by
    their standard deviation over half the range, independently at each end, in extension and in flexion.
    """
    reference, angle, rate = torque.reference, motion.joint_angle, motion.joint_rate
    excess = PerJoint.of(lambda joint: reference.excess(joint, angle[joint]))
    outside = PerJoint.of(lambda joint: np.abs(excess[joint]) > NO_MORE)
    work = PerJoint.of(lambda joint: np.abs(joint_moment[joint] * rate[joint]))
    lost = sum(float(work[joint][outside[joint]].sum()) for joint in JOINTS)
    zones = zone_powers(motion, torque)
    return Extrapolation(
        share=float(np.mean(outside.knee | outside.hip)),
        work_share=lost / max(float(work.knee.sum() + work.hip.sum()), np.finfo(float).tiny),
        sd=cadence * float(np.sqrt(np.einsum("...z,...z->...", zones, zones))),
        excess=excess.map(lambda angles: float(np.abs(angles).max())),
    )


def zone_powers(motion: Motion, torque: TorqueMap) -> FloatArray:
    """Mean power per crank speed by which a turn is unsure in each zone without data, N m, shape (8,), (designs, 8).

    The zones, independent of each other: of knee, then hip, at either end of the range, in flexion and in extension.
    """
    reference, zones = torque.reference, []
    for joint, angle in motion.joint_angle.items():
        excess, rate = reference.excess(joint, angle), motion.joint_rate[joint]
        drift = np.clip(excess / reference.half_range(joint), -1, 1) * (np.abs(excess) > NO_MORE)
        for end in (-1, 1):
            for direction in (-1, 1):
                zone = np.maximum(end * drift, 0) * np.maximum(direction * rate, 0)
                zones.append(torque.table[joint].std() * zone.mean(axis=-1))
    return np.stack(zones, axis=-1)


def beyond(reference: ReferenceTricycle, angle: PerJoint[FloatArray]) -> PerJoint[FloatArray]:
    """How far joint angles over a turn (rad, last axis) lie beyond what counts as the moments' range; negative inside.

    A path is taken by whole turns to where its middle is nearest to the range's.
    """

    def of_joint(joint: str) -> FloatArray:
        path = angle[joint]
        low, high = (end(axis=-1, keepdims=True) for end in (path.min, path.max))
        distance = path + (reference.turns_to_range(joint, low, high) - sum(reference.ranges[joint]) / 2)
        np.abs(distance, out=distance)
        distance -= reference.half_range(joint) + NO_MORE
        return np.asarray(distance)

    return PerJoint.of(of_joint)


def outside_share(beyond: PerJoint[FloatArray]) -> FloatArray:
    """Share of the turn in which any joint is beyond the range, which it passes on straight lines between the angles.

    beyond: as `beyond` gives it over uniform crank angles of one turn, shape (designs, angles). Shape (designs,).
    """
    farther = np.maximum(*beyond)
    outside, (designs, angles) = farther > 0, farther.shape
    rows, columns = np.nonzero(outside != np.roll(outside, -1, axis=1))
    here, there = farther[rows, columns], farther[rows, (columns + 1) % angles]
    part = np.maximum(here, there) / np.abs(here - there)  # of the way to the next angle, for which `here` stands
    correction = np.bincount(rows, part - outside[rows, columns], designs)
    return np.asarray((outside.sum(axis=1) + correction) / angles)


def never_inside(beyond: PerJoint[FloatArray]) -> PerJoint[BoolArray]:
    """Whether each joint is beyond the range at every one of the angles (last axis)."""
    return beyond.map(lambda distance: distance.min(axis=-1) > 0)


def drift_area(excess: FloatArray, half_range: float) -> FloatArray:
    """Integral over the angle of the drift (see extrapolation), rad, from an end of the range to `excess` beyond it."""
    part = np.clip(excess, 0, half_range)
    return np.asarray(part**2 / (2 * half_range) + np.maximum(excess - half_range, 0))
