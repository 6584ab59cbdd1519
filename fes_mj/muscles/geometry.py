"""Smooth functions of hip and knee flexion: muscle lengths, and the potential of the passive moments.

Each is one polynomial; whatever is a derivative is that of the same polynomial, so that work over joints and along
muscles is the same to rounding.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.linkage.joints import PerJoint
from fes_mj.linkage.kinematics import Motion

_BLOCK = 1024  # angles at once: more leave the processor's cache
CENTRE = np.radians((70.0, 67.5))  # of hip and knee flexion, from which the polynomials count


class Flexion(NamedTuple):
    """Hip and knee flexion, rad, any shapes that broadcast: 0 with a straight leg in line with the trunk."""

    hip: FloatArray
    knee: FloatArray

    @classmethod
    def along(cls, motion: Motion, hip_offset: FloatArray | float = 0.0) -> "Flexion":
        """Of a motion, shape (designs, angles); hip_offset: by which the pelvis adds to hip flexion, rad."""
        knee, hip = (np.atleast_2d(np.pi - angle) for angle in motion.joint_angle)
        return cls(hip + hip_offset, knee)

    @classmethod
    def of_each(cls, motion: Motion, hip_offset: FloatArray) -> "Flexion":
        """Of every member along the motion of a design of its own, shape (members, 1, angles)."""
        knee, hip = (np.pi - angle[:, None] for angle in motion.joint_angle)
        return cls(hip + hip_offset, knee)


class Values(NamedTuple):
    """Of each surface, and its derivatives by hip and knee flexion (rad), shape (surfaces, ...)."""

    value: FloatArray
    by_hip: FloatArray
    by_knee: FloatArray


def exponents(degree: int) -> list[tuple[int, int]]:
    """Of hip and knee flexion in every term of a polynomial, low orders first."""
    return [(order - knee, knee) for order in range(degree + 1) for knee in range(order + 1)]


def terms(flexion: Flexion, degree: int) -> FloatArray:
    """Every term of a polynomial of this degree at these angles, shape (terms, ...)."""
    hip, knee = np.broadcast_arrays(flexion.hip - CENTRE[0], flexion.knee - CENTRE[1])
    result = np.ones((len(exponents(degree)), *hip.shape))
    row = 1
    for order in range(1, degree + 1):
        before = result[row - order : row]
        np.multiply(before, hip, out=result[row : row + order])
        np.multiply(before[-1], knee, out=result[row + order])
        row += order + 1
    return result


def derivatives(coefficients: FloatArray, degree: int) -> PerJoint[FloatArray]:
    """Coefficients of the derivatives by knee and hip flexion, in the order of the polynomials' own terms."""
    places = {pair: place for place, pair in enumerate(exponents(degree))}
    by_hip, by_knee = np.zeros_like(coefficients), np.zeros_like(coefficients)
    for (hip, knee), place in places.items():
        if hip:
            by_hip[:, places[hip - 1, knee]] = hip * coefficients[:, place]
        if knee:
            by_knee[:, places[hip, knee - 1]] = knee * coefficients[:, place]
    return PerJoint(by_knee, by_hip)


@dataclass(frozen=True, eq=False)
class Surfaces:
    """Polynomials of one degree; coefficients: shape (surfaces, terms), per rad from CENTRE."""

    coefficients: FloatArray
    degree: int

    @cached_property
    def _with_derivatives(self) -> FloatArray:
        by_knee, by_hip = derivatives(self.coefficients, self.degree)
        return np.concatenate([self.coefficients, by_hip, by_knee])

    def at(self, flexion: Flexion) -> Values:
        """Values and derivatives at these angles."""
        hip, knee = np.broadcast_arrays(flexion.hip, flexion.knee)
        stacked = np.empty((len(self._with_derivatives), hip.size))
        for start in range(0, hip.size, _BLOCK):
            block = slice(start, start + _BLOCK)
            features = terms(Flexion(hip.reshape(-1)[block], knee.reshape(-1)[block]), self.degree)
            stacked[:, block] = self._with_derivatives @ features
        return Values(*stacked.reshape(3, len(self.coefficients), *hip.shape))
