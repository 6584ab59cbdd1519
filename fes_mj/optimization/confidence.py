"""How sure a gain in power is, given that the joint moments behind it are recovered with error bars.

Powers of two designs under the posterior of the moments are correlated: what counts is the standard deviation
of their difference. An optimiser seeks out what the evidence leaves open, so its gains have wide ones.
"""

from typing import NamedTuple

import numpy as np

from fes_mj.common.arrays import FloatArray


class Gain(NamedTuple):
    """Power gained over another design under the same moments, and its standard deviation, W."""

    mean: float
    deviation: float

    @property
    def beyond_error(self) -> bool:
        """Whether the gain exceeds its error bar of one standard deviation."""
        return self.mean > self.deviation


def gain(power: FloatArray, baseline: FloatArray) -> Gain:
    """Gain of one design over another, both powers by the same cycles.uncertain_table, shape (sets,)."""
    difference = power - baseline
    return Gain(float(difference[0]), float(np.linalg.norm(difference[1:])))
