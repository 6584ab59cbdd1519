"""Closed-form kinematics of TRT, CRT and CDT, vectorised over crank angles and over designs.

All three are a crank, at most one rocker-coupler dyad, and the leg as a second dyad; only the body that
carries the pedal differs (design.ARCHITECTURES). Rates are with respect to the crank angle (kinematic
coefficients): velocity = coefficient * crank speed; at constant speed, acceleration = second coefficient
* crank speed squared.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from fes_mj.design import BODIES, Design
from fes_mj.errors import AssemblyError

Points = dict[str, Any]  # point name -> complex array over crank angle, m

FULL_TURN = np.linspace(0.0, 2 * np.pi, 720, endpoint=False)


class Jet(NamedTuple):
    """A complex position with its first and second derivative by the crank angle, m, m/rad, m/rad^2."""

    value: Any
    first: Any
    second: Any


def _close_dyad(start: Any, end: Any, first: Any, second: Any) -> Any:
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


def positions(design: Design, crank_angle: Any) -> Points:
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
    points: Points = {"hip": np.zeros((), complex), "crank_centre": linkage.crank_centre}
    points["crank_pin"] = linkage.crank_centre + linkage.crank * crank
    with np.errstate(invalid="ignore", divide="ignore"):
        if "coupler" in linkage.architecture.bodies:
            points["rocker_pivot"] = linkage.ground
            points["rocker_joint"] = _close_dyad(linkage.ground, points["crank_pin"], linkage.rocker, linkage.coupler)
        origin, tip = (points[name] for name in BODIES[linkage.architecture.pedal_body])
        points["pedal"] = origin + (tip - origin) * linkage.pedal_offset
        # knee above the hip-pedal line: the pedal lies on the rider's -x side, so that is right of hip -> pedal
        points["knee"] = _close_dyad(points["pedal"], points["hip"], design.knee_to_pedal, design.rider.thigh)
    return points


@dataclass(frozen=True)
class Motion:
    """Kinematics of a design over crank angles; arrays have the shape of `positions`.

    points: Jet by point name. turning: (first, second) derivative of a body's angle by the crank angle.
    """

    design: Design
    crank_angle: Any  # rad
    points: dict[str, Jet]
    turning: dict[str, tuple[Any, Any]]

    def direction(self, body: str) -> Any:
        """Unit vector of a body's x axis, from its origin to its tip."""
        origin, tip = (self.points[name].value for name in BODIES[body])
        return (tip - origin) / np.abs(tip - origin)

    def body_point(self, body: str, offset: complex) -> Jet:
        """Jet of the point at `offset` (m, complex, in the body's own frame)."""
        return _carried(self.points[BODIES[body][0]], offset * self.direction(body), *self.turning[body])

    @property
    def hip_angle(self) -> Any:
        """phi_h, thigh against seat, growing in extension, rad in [0, 2 pi)."""
        return hip_angle(self.design, {name: jet.value for name, jet in self.points.items()})

    @property
    def knee_angle(self) -> Any:
        """phi_k, shank against thigh, growing in extension, rad."""
        return knee_angle(self.design, {name: jet.value for name, jet in self.points.items()})

    @property
    def hip_rate(self) -> Any:
        """D phi_h / d crank angle."""
        return self.turning["thigh"][0]

    @property
    def knee_rate(self) -> Any:
        """D phi_k / d crank angle."""
        return self.turning["thigh"][0] - self.turning["shank"][0]


def hip_angle(design: Design, points: Points) -> Any:
    """phi_h = theta_4 - theta_b of given positions, rad in [0, 2 pi)."""
    return np.mod(np.angle(points["knee"]) - design.linkage.seat_angle, 2 * np.pi)


def knee_angle(design: Design, points: Points) -> Any:
    """phi_k = pi - theta_3 + theta_4 - atan(R6 / R5) of given positions, rad."""
    knee = points["knee"]
    return np.angle((points["hip"] - knee) * np.conj(points["pedal"] - knee)) - design.boot_angle


def solve(design: Design, crank_angle: Any = FULL_TURN) -> Motion:
    """Positions and the first two kinematic coefficients of every joint and body (arguments as `positions`)."""
    values = positions(design, crank_angle)
    still = 0j * values["pedal"]
    points = {name: Jet(value, still, still) for name, value in values.items()}
    turning = {"crank": (1.0 + 0 * still.real, 0 * still.real)}
    points["crank_pin"] = _carried(
        points["crank_centre"], values["crank_pin"] - values["crank_centre"], *turning["crank"]
    )
    with np.errstate(invalid="ignore", divide="ignore"):
        if "coupler" in design.linkage.architecture.bodies:
            joint, turning["rocker"], turning["coupler"] = _dyad_rates(
                points["rocker_pivot"], points["crank_pin"], values["rocker_joint"]
            )
            points["rocker_joint"] = joint
        carrier = design.linkage.architecture.pedal_body
        origin = points[BODIES[carrier][0]]
        points["pedal"] = _carried(origin, values["pedal"] - origin.value, *turning[carrier])
        points["knee"], turning["thigh"], turning["shank"] = _dyad_rates(points["hip"], points["pedal"], values["knee"])
    return Motion(design, crank_angle, points, turning)


def _carried(origin: Jet, arm: Any, first: Any, second: Any) -> Jet:
    """Jet of origin + arm, the arm fixed in a body that turns with the given coefficients."""
    return Jet(origin.value + arm, origin.first + 1j * first * arm, origin.second + (1j * second - first**2) * arm)


def _dyad_rates(start: Jet, end: Jet, joint: Any) -> tuple[Jet, tuple[Any, Any], tuple[Any, Any]]:
    """Jet of a dyad's joint, and the coefficients of its links at `start` and at `end`."""
    arm1, arm2 = joint - start.value, joint - end.value
    cross = _cross(arm1, arm2)
    relative = end.first - start.first
    first1, first2 = _dot(relative, arm2) / cross, _dot(relative, arm1) / cross
    relative = end.second - start.second + first1**2 * arm1 - first2**2 * arm2
    second1, second2 = _dot(relative, arm2) / cross, _dot(relative, arm1) / cross
    return _carried(start, arm1, first1, second1), (first1, second1), (first2, second2)


def _dot(a: Any, b: Any) -> Any:
    return (np.conj(a) * b).real


def _cross(a: Any, b: Any) -> Any:
    return (np.conj(a) * b).imag


def require_assembly(design: Design) -> None:
    """Raise AssemblyError, naming the links and the crank angle, unless the linkage closes over the whole turn."""
    points = positions(design, FULL_TURN)
    lengths = design.link_lengths
    dyads = [("thigh", "shank", "hip", "pedal")]
    if "coupler" in lengths:
        dyads.insert(0, ("rocker", "coupler", "rocker_pivot", "crank_pin"))
    for first, second, start, end in dyads:
        span = np.broadcast_to(np.abs(points[end] - points[start]), FULL_TURN.shape)
        shortest, longest = abs(lengths[first] - lengths[second]), lengths[first] + lengths[second]
        excess = np.maximum(span - longest, shortest - span)
        worst = int(np.argmax(excess))
        if excess[worst] >= 0:
            raise AssemblyError(
                f"{design.name}: {first} and {second} cannot close at crank angle "
                f"{np.degrees(FULL_TURN[worst]):.1f} deg: {start.replace('_', ' ')} and {end.replace('_', ' ')} are "
                f"{span[worst]:.4f} m apart there, the two links reach from {shortest:.4f} to {longest:.4f} m"
            )
