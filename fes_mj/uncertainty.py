"""Standard deviations of powers that depend on recovered joint moments.

Mean power is linear in the two moment curves, hence in their Fourier coefficients: its variance is a quadratic form
in their covariance. Two designs under the same curves have correlated powers; their ratio is surer than either.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from fes_mj.errors import InputError
from fes_mj.fourier import fourier
from fes_mj.kinematics import Motion
from fes_mj.torque import JointMoments, TorqueMap, joint_angles, source_angle

if TYPE_CHECKING:
    from fes_mj.statics import QuasiStatic


def power_weights(motion: Motion, cadence: Any, moments: JointMoments | None = None) -> NDArray[np.float64]:
    """Mean crank power of one leg per Fourier coefficient of knee, then hip moment, W/(N m), shape (98,).

    motion: over uniform crank angles; of a batch of designs the shape is (designs, 98). cadence: rad/s, a batch's of
    shape (designs, 1). moments: only their torque-velocity relation counts; the sign of the moments, by which it tells
    shortening from lengthening, is kept.
    """
    torque_map = TorqueMap(moments) if moments and moments.torque_velocity else None
    parts = []
    for joint, (angle, rate) in joint_angles(motion).items():
        gain = rate * torque_map.speed_factor(joint, angle, cadence * rate) if torque_map else rate
        features = fourier(source_angle(joint, angle, rate))
        parts.append((gain[..., None, :] @ features)[..., 0, :] / gain.shape[-1])
    return cadence * np.concatenate(parts, axis=-1)


def standard_deviation(weights: NDArray[np.float64], covariance: NDArray[np.float64]) -> float:
    """Of the linear functional with these weights, shape (98,), of coefficients with this covariance."""
    return float(np.sqrt(weights @ covariance @ weights))


def difference_sd(one: QuasiStatic, other: QuasiStatic) -> float | None:
    """Standard deviation of one's mean power minus the other's, W; None where nothing is known of the moments' error.

    Both must have been solved with the same moments (InputError otherwise).
    """
    return _combined_sd(one, other, 1.0)


def ratio_sd(one: QuasiStatic, other: QuasiStatic) -> float | None:
    """Standard deviation of one's mean power per the other's, to first order; otherwise as difference_sd."""
    deviation = _combined_sd(one, other, one.power_mean / other.power_mean)
    return None if deviation is None else deviation / abs(other.power_mean)


def _combined_sd(one: QuasiStatic, other: QuasiStatic, factor: float) -> float | None:
    """Standard deviation of one - factor * other."""
    covariance = one.moments.covariance
    if covariance is None or other.moments.covariance is None:
        return None
    if covariance is not other.moments.covariance and not np.array_equal(covariance, other.moments.covariance):
        raise InputError(f"{one.moments.name} and {other.moments.name} are different moments: nothing correlates them")
    return standard_deviation(one.power_weights - factor * other.power_weights, covariance)
