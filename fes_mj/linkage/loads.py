"""Weight and inertia of the moving bodies as loads (d'Alembert), and what they and a pedal force ask of a leg."""

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
