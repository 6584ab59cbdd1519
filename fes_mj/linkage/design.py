"""A pedalling linkage and its rider, in SI units and radians.

Planar vectors are complex numbers x + iy: hip at the origin, x backwards (the rider faces -x), y up,
angles counter-clockwise. The symbols R1 ... R10, gamma, lambda and theta_b are those of Lanese et al.,
Robotics 2022, 11(1), 26; outside this module and the design files, words are used instead.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fes_mj.common.brief import Brief
from fes_mj.common.errors import InputError, require_one_of

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


AT_JOINT = 0.005  # m, less than a pin's radius: what is nearer to a joint sits on it
BRANCHES = {"left": 1, "right": -1}
SEXES = ("male", "female")
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

    In a batch of designs any number is an array of shape (designs, 1). Raises InputError for a kind or branch that is
    none.

    >>> trt = fes_mj.Linkage("trt", ground=-0.736 - 0.304j, crank=0.15, foot=0.069)
    >>> trt.architecture.title, round(abs(trt.crank_centre), 3)
    ('traditional recumbent tricycle (four-bar)', 0.796)
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

    def __post_init__(self) -> None:
        require_one_of("kind", self.kind, ARCHITECTURES)
        require_one_of("branch", self.branch, BRANCHES)

    @property
    def architecture(self) -> Architecture:
        return ARCHITECTURES[self.kind]

    @property
    def title(self) -> str:
        """What kind of tricycle it is, in words; with its pedal on the rocker joint one is a crank-rocker."""
        if self.kind == "cdt" and self.pedal_arm < AT_JOINT:
            near = f"its pedal is {1e3 * self.pedal_arm:.3g} mm from the rocker joint"
            return f"{ARCHITECTURES['crt'].title}: coupler-driven in name, {near}"
        return self.architecture.title

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
    """Leg lengths in m, body mass in kg, and whose segment parameters apply (one of SEXES, or InputError).

    >>> fes_mj.load_design("d1").with_rider(mass=62.0).rider
    Rider(thigh=0.52, shank=0.52, mass=62.0, sex='male', leg_mass_factor=1.0)
    """

    thigh: float = 0.52  # R4
    shank: float = 0.52  # R5: knee to the level of the pedal axle, at right angles to the sole (docs/errata.md, E18)
    mass: float = 75.0
    sex: str = "male"
    leg_mass_factor: float = 1.0  # on the masses of thigh, shank and foot; see data/riders.toml

    def __post_init__(self) -> None:
        require_one_of("sex", self.sex, SEXES)


@dataclass(frozen=True)
class Frame:
    """What stands still around a linkage, m, seen from the hip; None is not known."""

    tube: tuple[complex, complex] | None = None  # its middle line
    tube_diameter: float | None = None
    chainring_diameter: float | None = None
    wheel_diameter: float | None = None
    wheel_centre: complex | None = None
    ground_height: float | None = None

    def moved(self, by: complex) -> "Frame":
        """As seen from a hip from which all of it has moved by so much."""
        return replace(
            self,
            tube=self.tube and (self.tube[0] + by, self.tube[1] + by),
            wheel_centre=None if self.wheel_centre is None else self.wheel_centre + by,
            ground_height=None if self.ground_height is None else self.ground_height + by.imag,
        )


@dataclass(frozen=True, repr=False)
class Design(Brief):
    """A named linkage together with the rider who sits on it; or a batch, in which any number may be an array.

    links: names of links that are made, with mass (kg), centre (m) and moment of inertia (kg m^2) of each, as
    inertia.Inertia; the others are bars. The arrays of a batch have the shape (designs, 1), as many designs in each.

    >>> shorter = fes_mj.load_design("r2").with_linkage(crank=0.038)
    >>> fes_mj.quasi_static(shorter, fes_mj.load_moments("p1p2"))
    <QuasiStatic r2 p1p2: 20.67 W at 83.1 rpm>
    """

    name: str
    linkage: Linkage
    rider: Rider = Rider()
    frame: Frame = Frame()
    links: tuple[tuple[str, Any], ...] = ()

    @property
    def brief(self) -> str:
        return f"{self.name}: {self.linkage.kind}{f', a batch of {self.size}' if self.is_batch else ''}"

    def with_linkage(self, **numbers: Any) -> "Design":
        """The design with these attributes of its linkage changed, lengths in m, angles in rad."""
        return replace(self, linkage=replace(self.linkage, **numbers))

    def with_rider(self, **numbers: Any) -> "Design":
        """The design with these attributes of its rider changed, lengths in m, the mass in kg."""
        return replace(self, rider=replace(self.rider, **numbers))

    @property
    def is_batch(self) -> bool:
        """Whether any number of the linkage or the rider is an array."""
        return bool(_arrays(self.linkage) or _arrays(self.rider))

    @property
    def size(self) -> int:
        """Number of designs in a batch; 1 for a single design."""
        arrays = (*_arrays(self.linkage).values(), *_arrays(self.rider).values())
        return max((len(array) for array in arrays), default=1)

    def require_single(self) -> None:
        """Raise InputError for a batch."""
        if self.is_batch:
            raise InputError(
                f"{self.name}: a batch of designs; fes_mj.statics.cycles.cycles turns them all at once, single(row) is "
                "one of them"
            )

    def taken(self, rows: Any) -> "Design":
        """The designs of a batch at `rows` (an index array, a mask or a slice), as a batch; a single one is itself."""
        return self._with_arrays(lambda array: array[rows])

    def single(self, row: int) -> "Design":
        """One design of a batch, with plain numbers."""
        return self._with_arrays(lambda array: array[row, 0].item())

    def _with_arrays(self, change: Callable[[NDArray[Any]], Any]) -> "Design":
        linkage, rider = (
            {name: change(array) for name, array in _arrays(part).items()} for part in (self.linkage, self.rider)
        )
        return self.with_linkage(**linkage).with_rider(**rider)

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
        links = {body: getattr(self.linkage, body) for body in self.linkage.architecture.bodies[2:]}
        return {"thigh": self.rider.thigh, "shank": self.knee_to_pedal, **links}


def _arrays(part: Linkage | Rider) -> dict[str, NDArray[Any]]:
    """The numbers of a linkage or a rider that a batch has by the design."""
    numbers = {field.name: getattr(part, field.name) for field in fields(part)}
    return {name: number for name, number in numbers.items() if isinstance(number, np.ndarray)}
