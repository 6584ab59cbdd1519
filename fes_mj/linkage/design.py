"""A pedalling linkage and its rider, in SI units and radians.

Planar vectors are complex numbers x + iy: hip at the origin, x backwards (the rider faces -x), y up,
angles counter-clockwise. The symbols R1 ... R10, gamma, lambda and theta_b are those of Lanese et al.,
Robotics 2022, 11(1), 26; outside this module and the design files, words are used instead.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

WHEEL_DIAMETER = 0.66  # m, paper Section 3
TRICYCLE_SPEED = 5.71 / 3.6  # m/s, paper Section 3

# Bodies as (origin point, tip point); a body's frame sits at its origin, its x axis points to its tip.
BODIES = {
    "thigh": ("hip", "knee"),
    "shank": ("knee", "pedal"),
    "crank": ("crank_centre", "crank_pin"),
    "rocker": ("rocker_pivot", "rocker_joint"),
    "coupler": ("rocker_joint", "crank_pin"),
}


@dataclass(frozen=True)
class Architecture:
    """What tells the three tricycles apart: the bodies they have and the one that carries the pedal."""

    title: str
    bodies: tuple[str, ...]
    pedal_body: str

    @property
    def joints(self) -> dict[str, tuple[str, str]]:
        """Revolute joints: point name -> the two bodies it connects ("frame" is the tricycle itself)."""
        joints = {
            "hip": ("frame", "thigh"),
            "knee": ("thigh", "shank"),
            "pedal": ("shank", self.pedal_body),
            "crank_centre": ("frame", "crank"),
            "rocker_pivot": ("frame", "rocker"),
            "rocker_joint": ("rocker", "coupler"),
            "crank_pin": ("crank", "coupler"),
        }
        return {point: pair for point, pair in joints.items() if {*pair} <= {"frame", *self.bodies}}


BRANCHES = {"left": 1, "right": -1}
_FOUR_BAR = ("thigh", "shank", "crank")
_SIX_BAR = (*_FOUR_BAR, "rocker", "coupler")
ARCHITECTURES = {
    "trt": Architecture("traditional recumbent tricycle (four-bar)", _FOUR_BAR, "crank"),
    "crt": Architecture("crank-rocker tricycle (Watt II six-bar)", _SIX_BAR, "rocker"),
    "cdt": Architecture("coupler-driven tricycle (Stephenson III six-bar)", _SIX_BAR, "coupler"),
}


@dataclass(frozen=True)
class Linkage:
    """Dimensions of one linkage, lengths in m and angles in rad; a TRT has no rocker, coupler or pedal arm.

    In a batch of designs each number is an array of shape (designs, 1).
    """

    kind: str  # a key of ARCHITECTURES
    ground: complex  # R1: hip to rocker pivot (CRT, CDT) or to crank centre (TRT)
    crank: float  # R2
    foot: float  # R6: ankle to pedal along the sole; zero and negative are allowed
    pivot_to_crank: complex = 0j  # R7: rocker pivot to crank centre
    pedal_arm: float = 0.0  # R8: rocker joint to pedal
    coupler: float = 0.0  # R9
    rocker: float = 0.0  # R10
    coupler_angle: float = math.pi / 2  # gamma: from the coupler line to the pedal arm (CDT)
    gear_ratio: float = 1.31  # lambda: crank turns per wheel turn
    seat_angle: float = math.pi / 6  # theta_b
    branch: str = "left"  # side of pivot -> crank pin on which the rocker joint lies, one of BRANCHES

    @property
    def architecture(self) -> Architecture:
        return ARCHITECTURES[self.kind]

    @property
    def crank_centre(self) -> complex:
        """Crank centre seen from the hip, m."""
        return self.ground + self.pivot_to_crank

    @property
    def pedal_offset(self) -> Any:
        """Pedal seen from the origin of the body that carries it, in units of that body's origin-to-tip vector."""
        if self.kind == "trt":
            return 1.0
        if self.kind == "crt":
            return 1.0 + self.pedal_arm / self.rocker
        return self.pedal_arm / self.coupler * np.exp(1j * np.asarray(self.coupler_angle))

    @property
    def cadence(self) -> float:
        """Crank speed at the tricycle's nominal speed, rad/s (paper, Eq. 16)."""
        return 2 * self.gear_ratio * TRICYCLE_SPEED / WHEEL_DIAMETER


@dataclass(frozen=True)
class Rider:
    """Leg lengths in m, body mass in kg, and whose segment parameters apply (a key of segments.DE_LEVA)."""

    thigh: float = 0.52  # R4
    shank: float = 0.52  # R5: knee to the level of the pedal axle, at right angles to the sole (docs/errata.md, E18)
    mass: float = 75.0
    sex: str = "male"
    leg_mass_factor: float = 1.0  # on the masses of thigh, shank and foot; see data/riders.toml


@dataclass(frozen=True)
class Design:
    """A named linkage together with the rider who sits on it."""

    name: str
    linkage: Linkage
    rider: Rider = Rider()

    def changed(self, linkage: Mapping[str, Any], rider: Mapping[str, Any]) -> "Design":
        """The design with these attributes of its linkage and its rider."""
        return replace(self, linkage=replace(self.linkage, **linkage), rider=replace(self.rider, **rider))

    @property
    def is_batch(self) -> bool:
        """Whether any number of the linkage or the rider is an array, of shape (designs, 1)."""
        numbers = (*vars(self.linkage).values(), *vars(self.rider).values())
        return any(isinstance(number, np.ndarray) for number in numbers)

    @property
    def knee_to_pedal(self) -> Any:
        """Length R3 of shank and boot as one link, m; of a batch an array."""
        return np.hypot(self.rider.shank, self.linkage.foot)

    @property
    def boot_angle(self) -> Any:
        """Angle at the knee from the pedal to the ankle, atan(R6 / R5), rad."""
        return np.arctan(np.divide(self.linkage.foot, self.rider.shank))

    @property
    def link_lengths(self) -> dict[str, Any]:
        """Origin-to-tip length of each body, m."""
        lengths = {
            "thigh": self.rider.thigh,
            "shank": self.knee_to_pedal,
            "crank": self.linkage.crank,
            "rocker": self.linkage.rocker,
            "coupler": self.linkage.coupler,
        }
        return {body: lengths[body] for body in self.linkage.architecture.bodies}
