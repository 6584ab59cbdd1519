"""Standard deviations of powers that depend on recovered joint moments.

Mean power is linear in the two moment curves, hence in their Fourier coefficients: its variance is a quadratic form
in their covariance. Two designs under the same curves have correlated powers; their ratio is surer than either.
"""

from collections.abc import Iterator
from typing import Any

import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.linkage.joints import JOINTS
from fes_mj.linkage.kinematics import Motion
from fes_mj.moments.fourier import fourier
from fes_mj.moments.reference_tricycle import ReferenceTricycle


def power_weights(motion: Motion, cadence: Any, reference: ReferenceTricycle) -> FloatArray:
    """Mean crank power of one leg per Fourier coefficient of knee, then hip moment, W/(N m), shape (98,).

    motion: over uniform crank angles; of a batch of designs the shape is (designs, 98). cadence: rad/s, a batch's of
    shape (designs, 1). reference: the tricycle of the measurement.
    """
    parts = [
        (gain[..., None, :] @ features)[..., 0, :] / gain.shape[-1] for gain, features in _gains(motion, reference)
    ]
    return np.asarray(cadence * np.concatenate(parts, axis=-1))


def instant_power_weights(motion: Motion, cadence: float, reference: ReferenceTricycle) -> FloatArray:
    """The same of the power at every crank angle of one design, shape (angles, 98): their mean is power_weights."""
    parts = [gain[:, None] * features for gain, features in _gains(motion, reference)]
    return np.asarray(cadence * np.concatenate(parts, axis=-1))


def _gains(motion: Motion, reference: ReferenceTricycle) -> Iterator[tuple[FloatArray, FloatArray]]:
    """Of knee, then hip: power per moment and crank speed, and the terms of the series where its moment is read."""
    angle, rate = motion.joint_angle, motion.joint_rate
    for joint in JOINTS:
        yield rate[joint], fourier(reference.source_angle(joint, angle[joint], rate[joint]))


def with_sd(value: float, deviation: float | None, digits: int = 2) -> str:
    """A value with its standard deviation, where that is known."""
    return f"{value:.{digits}f}" + ("" if deviation is None else f" +- {deviation:.{digits}f}")


def standard_deviation(weights: FloatArray, covariance: FloatArray) -> float:
    """Of the linear functional with these weights, shape (98,), of coefficients with this covariance."""
    return float(np.sqrt(weights @ covariance @ weights))
