"""Mass, centre of mass and inertia of every moving body, each in its own frame (origin, x axis to the tip)."""

from typing import Any, NamedTuple

import numpy as np

from fes_mj.linkage.design import Design

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
    return bodies


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
