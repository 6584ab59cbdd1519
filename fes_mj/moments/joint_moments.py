"""Joint moments of riders over the crank angle of the tricycle they were measured on."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.common.brief import Brief
from fes_mj.common.errors import InputError
from fes_mj.linkage.joints import PerJoint
from fes_mj.linkage.kinematics import uniform_turn
from fes_mj.moments.fourier import fit_fourier, fourier
from fes_mj.moments.reference_tricycle import PAPER_TRICYCLE, ReferenceTricycle

RIDER_GROUPS = ("p1p2", "p1p3")
COLUMNS = ("crank_angle_deg", "knee_Nm", "hip_Nm")
_NEGLIGIBLE = 1e-9  # part of the largest variance of moments; directions below it are rounding
MEASURED_POINTS = 720  # of sums over the measured turn: exact for the products of harmonics that matter


class Misreading(NamedTuple):
    """A sign that a file means something else than it says: a word for it, and a sentence."""

    name: str
    text: str


@dataclass(frozen=True, eq=False, repr=False)
class JointMoments(Brief):
    """Net knee and hip moment of one leg over a tricycle's crank angle, periodic, extension positive.

    crank_angle: shape (n,), rad from top dead centre, in any order and by any whole turns.
    knee, hip: shape (n,), N m.
    covariance: of the curves' Fourier coefficients, knee's then hip's (moments.fourier), (N m)^2, shape (98, 98);
    None where their error is not known.
    measured_on: the tricycle, rider and cadence; cadence_known: whether the cadence is said anywhere.
    left: the left leg's, where it has its own. misreadings: what looks wrong in the file they come from.
    Raises InputError for numbers that are not finite.

    >>> angle = np.radians([0, 90, 180, 270])
    >>> fes_mj.JointMoments("mine", angle, np.array([10.0, 20.0, 0.0, -10.0]), np.array([0.0, 0.0, 5.0, 0.0]))
    <JointMoments mine: 4 samples of a turn>
    """

    name: str
    crank_angle: FloatArray
    knee: FloatArray
    hip: FloatArray
    covariance: FloatArray | None = None
    measured_on: ReferenceTricycle = PAPER_TRICYCLE
    cadence_known: bool = True
    left: "JointMoments | None" = None
    misreadings: tuple[Misreading, ...] = ()

    def __post_init__(self) -> None:
        for name in ("crank_angle", "knee", "hip"):
            if not np.isfinite(getattr(self, name)).all():
                raise InputError(f"{self.name}: {name} has a number that is not finite")

    @property
    def brief(self) -> str:
        return f"{self.name}: {len(self.knee)} samples of a turn"

    @cached_property
    def coefficients(self) -> PerJoint[FloatArray]:
        """Of the Fourier series of each moment's smooth curve through the samples (fit_fourier), N m, shape (49,)."""
        fitted = fit_fourier(self.crank_angle, np.column_stack([self.knee, self.hip]))
        return PerJoint(*np.ascontiguousarray(fitted.T))

    @cached_property
    def deviations(self) -> PerJoint[FloatArray]:
        """One standard deviation of the coefficients along each of the directions that vary, shape (49, directions).

        Coefficients are their mean and these, each times a standard normal number of its own. Raises InputError for
        moments whose covariance is not known.
        """
        if self.covariance is None:
            raise InputError(
                f"{self.name}: nothing is known of the error of these moments; only a rider group's have one"
            )
        variance, directions = np.linalg.eigh(self.covariance)
        large = variance > _NEGLIGIBLE * variance[-1]
        return PerJoint(*map(np.ascontiguousarray, np.split(directions[:, large] * np.sqrt(variance[large]), 2)))

    def __getstate__(self) -> dict[str, Any]:
        """With all that linear algebra makes of them: its last bits depend on threads, a worker process has fewer."""
        deviations = {} if self.covariance is None else {"deviations": self.deviations}
        return self.__dict__ | {"coefficients": self.coefficients} | deviations

    def at(self, crank_angle: Any) -> PerJoint[FloatArray]:
        """Moments at crank angles from top dead centre, rad, any shape, N m."""
        return self.along(fourier(crank_angle))

    def along(self, terms: FloatArray) -> PerJoint[FloatArray]:
        """The same where the terms of the series (fourier.fourier) are known."""
        return self.coefficients.map(lambda series: np.asarray(np.einsum("...j,j->...", terms, series)))

    def of_leg(self, name: str) -> "JointMoments":
        """The moments of the leg that a name or its prefix (linkage.legs) belongs to."""
        return self.left if self.left and name.startswith("left_") else self

    @property
    def of_legs(self) -> "tuple[JointMoments, ...]":
        """The moments of each leg that has its own, the right one's first."""
        return (self,) if self.left is None else (self, self.left)

    @cached_property
    def power_mean(self) -> PerJoint[float]:
        """Mean power of each joint in the tricycle of the measurement, at its cadence, W."""
        angle = uniform_turn(MEASURED_POINTS)
        moment, rate = self.at(angle), self.measured_on.joint_rates(angle)
        return PerJoint.of(lambda joint: float(np.mean(moment[joint] * rate[joint])) * self.measured_on.cadence)
