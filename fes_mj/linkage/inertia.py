"""The masses of legs and linkage: of each body, as loads on it in motion (d'Alembert), and as a crank and a frame feel.

A body's inertia is in its own frame (origin, x axis to the tip).
"""

from typing import Any, NamedTuple

import numpy as np

from fes_mj.common.arrays import ComplexArray, FloatArray
from fes_mj.linkage.design import Design
from fes_mj.linkage.joints import PerJoint
from fes_mj.linkage.kinematics import Jet, Motion

GRAVITY = 9.81  # m/s^2, along -y


class Segment(NamedTuple):
    """Fractions of de Leva (1996): of body mass; CoM from the proximal end and radius of gyration, of the length."""

    mass: float
    centre: float
    gyration: float


class Inertia(NamedTuple):
    """Mass in kg; centre of mass in the body's frame, m, complex; moment of inertia about it (normal axis), kg m^2.

    Of a batch of designs arrays of shape (designs, 1).
    """

    mass: Any
    centre: Any
    moment: Any


# de Leva, J. Biomech. 29 (1996) 1223-1230, Table 4 (transverse radius of gyration; foot from heel to toe tip).
DE_LEVA = {
    "male": {
        "thigh": Segment(0.1416, 0.4095, 0.329),
        "shank": Segment(0.0433, 0.4395, 0.246),
        "foot": Segment(0.0137, 0.4415, 0.245),
    },
    "female": {
        "thigh": Segment(0.1478, 0.3612, 0.364),
        "shank": Segment(0.0481, 0.4352, 0.263),
        "foot": Segment(0.0129, 0.4014, 0.279),
    },
}
# de Leva's mean foot lengths, m; the rider's own is not asked for.
FOOT_LENGTH = {"male": 0.2581, "female": 0.2283}
# Assumption: the ankle axis lies a quarter of the foot's length ahead of the heel.
ANKLE_FROM_HEEL = 0.25
# Assumption: links are slender bars of aluminium profile (about 25 x 15 mm), kg/m.
LINK_MASS_PER_LENGTH = 1.0


def inertias(design: Design) -> dict[str, Inertia]:
    """Inertia by body name; the shank carries the foot in its boot, the pedal's carrier its pedal arm."""
    rider, linkage = design.rider, design.linkage
    table, mass = DE_LEVA[rider.sex], rider.leg_mass_factor * rider.mass
    bodies = {"thigh": _segment(table["thigh"], mass, rider.thigh, 0, 1)}
    ankle, heel, toe = foot_points(design)
    bodies["shank"] = combine(
        _segment(table["shank"], mass, abs(ankle), 0, ankle / abs(ankle)),
        _segment(table["foot"], mass, abs(toe - heel), heel, (toe - heel) / abs(toe - heel)),
    )
    for body in linkage.architecture.bodies[2:]:
        length = design.link_lengths[body]
        bodies[body] = _bar(0, length)
        if body == linkage.architecture.pedal_body and body != "crank":
            joint = 0 if body == "coupler" else length  # the rocker joint in this body's frame
            bodies[body] = combine(bodies[body], _bar(joint, length * linkage.pedal_offset))
    return bodies | dict(design.links)


def foot_points(design: Design) -> tuple[Any, Any, Any]:
    """Ankle, heel and toe tip in the shank's frame, m; the boot holds the foot at 90 deg to the shank."""
    to_ankle = np.exp(1j * design.boot_angle)
    sole, length = -1j * to_ankle, FOOT_LENGTH[design.rider.sex]  # toes towards the pedal
    ankle = design.rider.shank * to_ankle
    heel = ankle - ANKLE_FROM_HEEL * length * sole
    return ankle, heel, heel + length * sole


def _segment(segment: Segment, body_mass: Any, length: Any, start: Any, along: Any) -> Inertia:
    mass = segment.mass * body_mass
    return Inertia(mass, start + segment.centre * length * along, mass * (segment.gyration * length) ** 2)


def _bar(start: Any, end: Any) -> Inertia:
    length = abs(end - start)
    mass = LINK_MASS_PER_LENGTH * length
    return Inertia(mass, (start + end) / 2, mass * length**2 / 12)


def combine(*parts: Inertia) -> Inertia:
    """One rigid body out of several (parallel-axis theorem)."""
    mass = sum(part.mass for part in parts)
    centre = sum(part.mass * part.centre for part in parts) / mass
    moment = sum(part.moment + part.mass * abs(part.centre - centre) ** 2 for part in parts)
    return Inertia(mass, centre, moment)


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
