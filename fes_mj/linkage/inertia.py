"""The masses of legs and linkage in motion: as loads on bodies (d'Alembert), and as a crank and a frame feel them."""

from typing import NamedTuple

import numpy as np

from fes_mj.common.arrays import ComplexArray, FloatArray
from fes_mj.linkage.joints import PerJoint
from fes_mj.linkage.kinematics import Jet, Motion
from fes_mj.linkage.segments import GRAVITY, inertias


class BodyLoad(NamedTuple):
    """A force (N, complex) at a point of a body, and a couple (N m) on that body, over crank angle."""

    force: ComplexArray
    point: Jet
    couple: FloatArray


def body_loads(
    motion: Motion, cadence: float, mass_scale: float = 1.0, gravity: float = GRAVITY
) -> dict[str, BodyLoad]:
    """Weight and inertia of every moving body at constant crank speed (rad/s), as loads on it."""
    loads = {}
    for body, inertia in inertias(motion.design).items():
        centre = motion.body_point(body, inertia.centre)
        loads[body] = BodyLoad(
            force=-mass_scale * inertia.mass * (cadence**2 * centre.second + 1j * gravity),
            point=centre,
            couple=-mass_scale * inertia.moment * cadence**2 * motion.rotation[body].second,
        )
    return loads


def leg_moments(motion: Motion, cadence: float, pedal_force: ComplexArray) -> PerJoint[FloatArray]:
    """Knee and hip moment, N m, of a leg that moves so and pushes the pedal with this force (N, complex, on the pedal).

    Moments of all that acts on the shank about the knee, and on the whole leg about the hip, at constant crank speed
    (rad/s): inverse dynamics from the pedal upwards.
    """
    loads = {body: load for body, load in body_loads(motion, cadence).items() if body in ("thigh", "shank")}

    def about(joint: str, *bodies: str) -> FloatArray:
        """Moment about a joint of the pedal's force on the foot and of the loads on these bodies."""
        origin = motion.points[joint].value
        total = -(np.conj(motion.points["pedal"].value - origin) * pedal_force).imag
        for load in (loads[body] for body in bodies):
            total = total + (np.conj(load.point.value - origin) * load.force).imag + load.couple
        return np.asarray(total)

    return PerJoint(about("knee", "shank"), -about("hip", "thigh", "shank"))


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
    of_bodies = []
    for body, part in inertias(motion.design).items():
        (_, first, second), (turning, change) = motion.body_point(body, part.centre), motion.rotation[body]
        inertia = part.mass * np.abs(first) ** 2 + part.moment * turning**2
        rate = 2 * (part.mass * (np.conj(first) * second).real + part.moment * turning * change)
        of_bodies.append((inertia, rate, part.mass * first.real, part.mass * second.real, part.mass * first.imag))
    return CrankInertia(*(np.asarray(sum(column)) for column in zip(*of_bodies, strict=True)))
