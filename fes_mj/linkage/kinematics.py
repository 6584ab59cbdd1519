"""Closed-form kinematics of TRT, CRT and CDT, vectorised over crank angles and over designs.

All three are a crank, at most one rocker-coupler dyad, and the leg as a second dyad; only the body that
carries the pedal differs (design.ARCHITECTURES). Rates are with respect to the crank angle (kinematic
coefficients): velocity = coefficient * crank speed; at constant speed, acceleration = second coefficient
* crank speed squared.
"""

from dataclasses import dataclass
from typing import NamedTuple, TypeAlias

import numpy as np

from fes_mj.common.arrays import ComplexArray, FloatArray
from fes_mj.common.brief import Brief
from fes_mj.common.errors import require_within
from fes_mj.linkage.design import BODIES, Design
from fes_mj.linkage.joints import PerJoint

Points: TypeAlias = dict[str, ComplexArray]  # point name -> positions over crank angle, m


def uniform_turn(points: int) -> FloatArray:
    """So many crank angles over a turn, from 0, rad, shape (points,). Raises InputError for none."""
    require_within("points", points, 1)
    return np.linspace(0.0, 2 * np.pi, points, endpoint=False)


FULL_TURN = uniform_turn(720)


class Jet(NamedTuple):
    """A complex position with its first and second derivative by the crank angle, m, m/rad, m/rad^2."""

    value: ComplexArray
    first: ComplexArray
    second: ComplexArray


class Rotation(NamedTuple):
    """First and second derivative of a body's angle by the crank angle, 1 and 1/rad."""

    first: FloatArray
    second: FloatArray

    def __sub__(self, other: "Rotation") -> "Rotation":
        return Rotation(self.first - other.first, self.second - other.second)


def close_dyad(start: ComplexArray, end: ComplexArray, first: float, second: float) -> ComplexArray:
    """Joint of links of length `first` (at `start`) and `second` (at `end`), left of start -> end; NaN if none."""
    span = end - start
    inverse_square = span.real**2
    inverse_square += span.imag**2
    np.reciprocal(inverse_square, out=inverse_square)
    along = inverse_square * ((first**2 - second**2) / 2)
    along += 0.5
    across = inverse_square * first**2 - along**2
    np.sqrt(across, out=across)
    joint = np.empty(across.shape, complex)
    joint.real, joint.imag = along, across
    joint *= span
    joint += start
    return joint


def positions(design: Design, crank_angle: FloatArray) -> Points:
    """Every joint at the given crank angles.

    crank_angle: rad, shape (angles,); with a batch of designs the results have shape (designs, angles).
    Returns complex positions in m by point name; NaN where the links cannot close.
    """
    linkage = design.linkage
    crank_angle = np.asarray(crank_angle, float)
    crank = np.empty(crank_angle.shape, complex)
    half = np.tan(crank_angle / 2)  # one fast tangent instead of a sine and a cosine
    cosine_plus_one = 2 / (1 + half**2)
    crank.real, crank.imag = cosine_plus_one - 1, half * cosine_plus_one
    points: Points = {"hip": np.zeros((), complex), "crank_centre": np.asarray(linkage.crank_centre)}
    points["crank_pin"] = linkage.crank_centre + linkage.crank * crank
    with np.errstate(invalid="ignore", divide="ignore"):
        if "coupler" in linkage.architecture.bodies:
            points["rocker_pivot"] = np.asarray(linkage.ground)
            ends = (points["rocker_pivot"], linkage.rocker), (points["crank_pin"], linkage.coupler)
            (start, first), (end, second) = ends if linkage.branch == "left" else ends[::-1]
            points["rocker_joint"] = close_dyad(start, end, first, second)
        origin, tip = (points[name] for name in BODIES[linkage.architecture.pedal_body])
        points["pedal"] = origin + (tip - origin) * linkage.pedal_offset
        # knee above the hip-pedal line: the pedal lies on the rider's -x side, so that is right of hip -> pedal
        points["knee"] = close_dyad(points["pedal"], points["hip"], design.knee_to_pedal, design.rider.thigh)
    return points


@dataclass(frozen=True, repr=False)
class Motion(Brief):
    """Kinematics of a design over crank angles; arrays have the shape of `positions`.

    crank_angle: rad. points: Jet by point name. rotation: of each body by name.
    """

    design: Design
    crank_angle: FloatArray
    points: dict[str, Jet]
    rotation: dict[str, Rotation]

    @property
    def brief(self) -> str:
        return f"{self.design.brief}, at {np.size(self.crank_angle)} crank angles"

    def direction(self, body: str) -> ComplexArray:
        """Unit vector of a body's x axis, from its origin to its tip."""
        origin, tip = (self.points[name].value for name in BODIES[body])
        return (tip - origin) / np.abs(tip - origin)

    def body_point(self, body: str, offset: complex) -> Jet:
        """Jet of the point at `offset` (m, complex, in the body's own frame)."""
        return _carried(self.points[BODIES[body][0]], offset * self.direction(body), self.rotation[body])

    @property
    def joint_angle(self) -> PerJoint[FloatArray]:
        """phi_k and phi_h, rad; see joint_angles."""
        return joint_angles(self.design, {name: jet.value for name, jet in self.points.items()})

    @property
    def joint_rotation(self) -> PerJoint[Rotation]:
        """Derivatives of phi_k and phi_h by the crank angle."""
        thigh = self.rotation["thigh"]
        return PerJoint(thigh - self.rotation["shank"], thigh)

    @property
    def joint_rate(self) -> PerJoint[FloatArray]:
        """First derivatives of phi_k and phi_h by the crank angle: joint speed per crank speed."""
        return self.joint_rotation.map(lambda rotation: rotation.first)


def joint_angles(design: Design, points: Points) -> PerJoint[FloatArray]:
    """Joint angles of given positions, rad, growing in extension.

    Knee: phi_k = pi - theta_3 + theta_4 - atan(R6 / R5). Hip: phi_h = theta_4 - theta_b, at the first crank angle in
    [-pi/2, 3 pi/2), from there on without jumps.
    """
    knee = points["knee"]
    bend = np.angle((points["hip"] - knee) * np.conj(points["pedal"] - knee))
    hip = np.mod(np.angle(knee) - design.linkage.seat_angle + np.pi / 2, 2 * np.pi) - np.pi / 2
    if np.fmax.reduce(hip, axis=None) - np.fmin.reduce(hip, axis=None) > np.pi:  # some may pass the cut
        hip = np.unwrap(hip)
    return PerJoint(bend - design.boot_angle, hip)


def solve(design: Design, crank_angle: FloatArray = FULL_TURN) -> Motion:
    """Positions and the first two kinematic coefficients of every joint and body (arguments as `positions`)."""
    values = positions(design, crank_angle)
    still = 0j * values["pedal"]
    points = {name: Jet(value, still, still) for name, value in values.items()}
    rotation = {"crank": Rotation(1.0 + 0 * still.real, 0 * still.real)}
    arm = values["crank_pin"] - values["crank_centre"]
    points["crank_pin"] = _carried(points["crank_centre"], arm, rotation["crank"])
    with np.errstate(invalid="ignore", divide="ignore"):
        if "coupler" in design.linkage.architecture.bodies:
            joint, rotation["rocker"], rotation["coupler"] = _dyad_rates(
                points["rocker_pivot"], points["crank_pin"], values["rocker_joint"]
            )
            points["rocker_joint"] = joint
        carrier = design.linkage.architecture.pedal_body
        origin = points[BODIES[carrier][0]]
        points["pedal"] = _carried(origin, values["pedal"] - origin.value, rotation[carrier])
        points["knee"], rotation["thigh"], rotation["shank"] = _dyad_rates(
            points["hip"], points["pedal"], values["knee"]
        )
    return Motion(design, crank_angle, points, rotation)


def _carried(origin: Jet, arm: ComplexArray, rotation: Rotation) -> Jet:
    """Jet of origin + arm, the arm fixed in a body that rotates so."""
    first, second = rotation
    return Jet(origin.value + arm, origin.first + 1j * first * arm, origin.second + (1j * second - first**2) * arm)


def _dyad_rates(start: Jet, end: Jet, joint: ComplexArray) -> tuple[Jet, Rotation, Rotation]:
    """Jet of a dyad's joint, and the rotation of its links at `start` and at `end`."""
    arm1, arm2 = joint - start.value, joint - end.value
    area = cross(arm1, arm2)
    relative = end.first - start.first
    first1, first2 = _dot(relative, arm2) / area, _dot(relative, arm1) / area
    relative = end.second - start.second + first1**2 * arm1 - first2**2 * arm2
    second1, second2 = _dot(relative, arm2) / area, _dot(relative, arm1) / area
    rotation1, rotation2 = Rotation(first1, second1), Rotation(first2, second2)
    return _carried(start, arm1, rotation1), rotation1, rotation2


def _dot(a: ComplexArray, b: ComplexArray) -> FloatArray:
    return (np.conj(a) * b).real


def cross(a: ComplexArray, b: ComplexArray) -> FloatArray:
    """Z component of the cross product of planar vectors."""
    return (np.conj(a) * b).imag
