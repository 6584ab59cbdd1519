"""The masses of legs and linkage as a crank and a tricycle feel them: what the reduced equation of motion needs."""

from typing import NamedTuple

import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.linkage.kinematics import Motion
from fes_mj.linkage.segments import inertias


class CrankInertia(NamedTuple):
    """Over crank angle a, the last axis; of a batch of designs, shape (designs, angles).

    inertia: I = sum of m abs(dr/da)^2 + J (dtheta/da)^2, kg m^2, the kinetic energy being I w^2 / 2 at a crank speed w.
    inertia_rate: dI/da, kg m^2. recoil: X = sum of m dx/da, kg m, what a sliding frame feels. recoil_rate: dX/da, kg m.
    height_rate: sum of m dy/da, kg m; times gravity the weight's moment on the crank.
    """

    inertia: FloatArray
    inertia_rate: FloatArray
    recoil: FloatArray
    recoil_rate: FloatArray
    height_rate: FloatArray


def crank_inertia(motion: Motion) -> CrankInertia:
    """Of the bodies of one leg and its linkage along a motion."""
    inertia, inertia_rate, recoil, recoil_rate, height_rate = np.zeros((5, *motion.points["pedal"].value.shape))
    for body, part in inertias(motion.design).items():
        centre, (turning, change) = motion.body_point(body, part.centre), motion.rotation[body]
        inertia = inertia + part.mass * np.abs(centre.first) ** 2 + part.moment * turning**2
        along = (np.conj(centre.first) * centre.second).real
        inertia_rate = inertia_rate + 2 * (part.mass * along + part.moment * turning * change)
        recoil = recoil + part.mass * centre.first.real
        recoil_rate = recoil_rate + part.mass * centre.second.real
        height_rate = height_rate + part.mass * centre.first.imag
    return CrankInertia(inertia, inertia_rate, recoil, recoil_rate, height_rate)
