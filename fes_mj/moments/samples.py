"""Joint moments drawn from what is known of a rider group: whatever is not linear in them gets its error from these.

A mean power is linear; its error follows from the mean and the covariance that load_moments gives, which are those of
these very curves.
"""

import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.common.reading import DATA
from fes_mj.moments.fourier import fourier
from fes_mj.moments.joint_moments import JointMoments

DEGREES = np.arange(360.0)  # crank angles of a rider group's curves, from top dead centre
_FOLDER = DATA / "moments"


def sampled_coefficients(group: str) -> FloatArray:
    """Fourier coefficients (fes_mj.moments.fourier) of the curves drawn for "p1p2" or "p1p3", knee's then hip's, N m.

    Shape (curves, 98). The curves are independent of each other: any part of them is a sample as well.
    """
    with np.load(_FOLDER / f"{group}-samples.npz") as stored:
        return np.asarray(stored["coefficients"], float)


def sampled_moments(group: str, count: int | None = None) -> list[JointMoments]:
    """The curves drawn for "p1p2" or "p1p3", or so many of them, each as moments of its own, without a covariance."""
    curves = sampled_coefficients(group)
    rows = np.linspace(0, len(curves) - 1, count or len(curves)).astype(int)
    return [moments_of(curves[row], f"{group} {row + 1}") for row in rows]


def moments_of(coefficients: FloatArray, name: str) -> JointMoments:
    """The curves of Fourier coefficients, knee's then hip's, N m, shape (98,), at every degree."""
    angle = np.radians(DEGREES)
    knee, hip = (fourier(angle) @ part for part in np.split(coefficients, 2))
    return JointMoments(name, angle, knee, hip)
