"""What of measured joint moments is no muscle of the model: smooth moments that do no net work but a loss.

Without them the gluteus and the hamstrings would have to work against the rider to explain a hip moment. They are never
re-timed and never counted as muscle.
"""

from dataclasses import dataclass

import numpy as np
from scipy.special import ive

from fes_mj.common.arrays import FloatArray
from fes_mj.moments.fourier import HARMONICS

LENGTH = 1.0  # of the kernel exp(-2 sin^2(d / 2) / LENGTH^2) on the circle: as smooth as the moments themselves


@dataclass(frozen=True, eq=False)
class Residual:
    """A periodic Gaussian process of both joints, conditioned on its work.

    loss: Fourier coefficients of knee, then hip (moments.fourier) that cost 1 W, N m, shape (98,). covariance: of the
    rest for a standard deviation of 1 N m, shape (98, 98).
    """

    loss: FloatArray
    covariance: FloatArray

    @classmethod
    def on(cls, power_weights: FloatArray) -> "Residual":
        """On the tricycle of a measurement, whose mean power per coefficient this is, W/(N m), shape (98,)."""
        order = np.arange(HARMONICS + 1)
        spectrum = ive(order, LENGTH**-2) * np.where(order == 0, 1, 2)
        variance = np.tile(np.concatenate([spectrum, spectrum[1:]]), 2)
        follows = variance * power_weights
        work = float(power_weights @ follows)
        return cls(-follows / work, np.diag(variance) - np.outer(follows, follows) / work)
