"""How sure a gain in power is, given that the joint moments behind it are recovered with error bars.

Powers of two designs under the posterior of the moments are correlated: what counts is the standard deviation
of their difference. An optimiser seeks out what the evidence leaves open, so its gains have wide ones.
"""

from typing import NamedTuple

import numpy as np

from fes_mj.arrays import FloatArray
from fes_mj.cycles import WorkTable
from fes_mj.errors import InputError
from fes_mj.fourier import fourier
from fes_mj.joints import PerJoint
from fes_mj.moments import JointMoments
from fes_mj.torque_map import torque_map

_NEGLIGIBLE = 1e-9  # part of the largest variance; directions below it are rounding


class Gain(NamedTuple):
    """Power gained over another design under the same moments, and its standard deviation, W."""

    mean: float
    deviation: float

    @property
    def beyond_error(self) -> bool:
        """Whether the gain exceeds its error bar of one standard deviation."""
        return self.mean > self.deviation


def uncertain_table(moments: JointMoments) -> WorkTable:
    """Table whose first set of moments is the given one, the others its deviations along independent directions.

    A power p, shape (sets,), has the mean p[0] and the standard deviation |p[1:]|. Raises InputError for moments
    whose covariance is not known.
    """
    if moments.covariance is None:
        raise InputError(
            f"{moments.name}: nothing is known of the error of these moments; only a rider group's have one"
        )
    variance, directions = np.linalg.eigh(moments.covariance)
    large = variance > _NEGLIGIBLE * variance[-1]
    deviations = PerJoint(*np.split(directions[:, large] * np.sqrt(variance[large]), 2))
    torque = torque_map(moments)

    def sets(joint: str, angle: FloatArray) -> FloatArray:
        return np.column_stack([torque.at_source(joint, angle), fourier(angle) @ deviations[joint]])

    return WorkTable(sets, moments.measured_on)


def gain(power: FloatArray, baseline: FloatArray) -> Gain:
    """Gain of one design over another, both powers by the same uncertain_table, shape (sets,)."""
    difference = power - baseline
    return Gain(float(difference[0]), float(np.linalg.norm(difference[1:])))
