"""The one table of design variables: symbol in files, attribute, unit, bounds, and the kinds of linkage that have it.

Design files, studies, problem files, identification and optimiser all read it. The vectors R1 and R7 are two
components there, R1x and R1y.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.common.errors import InputError
from fes_mj.common.units import RPM
from fes_mj.linkage.design import Design

ALL, SIX_BAR = ("trt", "crt", "cdt"), ("crt", "cdt")
# No length of a pedalling linkage or leg comes near the longest; a larger one is in centimetres. A link shorter than
# the shortest has no inertia that a simulation could use.
SHORTEST, LONGEST = 1e-3, 2.0  # m
_PHRASES = {
    "m": "a length in metres from {low:g} to {high:g}",
    "deg": "an angle in degrees between {low:g} and {high:g}",
    "": "a ratio from {low:g} to {high:g}",
    "kg": "a mass in kg from {low:g} to {high:g}",
    "rpm": "a cadence in rpm from {low:g} to {high:g}",
}


@dataclass(frozen=True)
class Variable:
    """A number or vector of a design: symbol in files, table and attribute, unit, bounds of each component."""

    symbol: str
    owner: str  # table of the design file: "linkage" or "rider"; "" for what belongs to a run
    attribute: str
    unit: str
    low: float
    high: float
    kinds: tuple[str, ...] = ALL
    needed: bool = False  # in a design file
    vector: bool = False
    implied: bool = False  # not written into a design file while it has its default

    @property
    def allowed(self) -> str:
        """What a file may say, in words."""
        if self.vector:
            return f"[x, y] in metres, each between {self.low:g} and {self.high:g}"
        return _PHRASES[self.unit].format(low=self.low, high=self.high)

    def accepts(self, value: float) -> bool:
        """Whether a number, in the unit of files, is within the bounds."""
        return self.low <= value <= self.high


VARIABLES = {
    variable.symbol: variable
    for variable in (
        Variable("R1", "linkage", "ground", "m", -LONGEST, LONGEST, needed=True, vector=True),
        Variable("R2", "linkage", "crank", "m", SHORTEST, LONGEST, needed=True),
        Variable("R6", "linkage", "foot", "m", -LONGEST, LONGEST, needed=True),
        Variable("R7", "linkage", "pivot_to_crank", "m", -LONGEST, LONGEST, SIX_BAR, needed=True, vector=True),
        Variable("R8", "linkage", "pedal_arm", "m", 0.0, LONGEST, SIX_BAR, needed=True),
        Variable("R9", "linkage", "coupler", "m", SHORTEST, LONGEST, SIX_BAR, needed=True),
        Variable("R10", "linkage", "rocker", "m", SHORTEST, LONGEST, SIX_BAR, needed=True),
        Variable("gamma", "linkage", "coupler_angle", "deg", -360, 360, ("cdt",)),
        Variable("gear_ratio", "linkage", "gear_ratio", "", 0.01, 20, needed=True),
        Variable("seat_angle", "linkage", "seat_angle", "deg", -360, 360, needed=True),
        Variable("thigh", "rider", "thigh", "m", SHORTEST, LONGEST),
        Variable("shank", "rider", "shank", "m", SHORTEST, LONGEST),
        Variable("mass", "rider", "mass", "kg", 1, 500),
        Variable("leg_mass_factor", "rider", "leg_mass_factor", "", 0.1, 2, implied=True),
        Variable("cadence_rpm", "", "cadence", "rpm", 1, 200),
    )
}


def runnable(cadence: Any) -> Any:
    """Whether crank speeds, rad/s, are within the bounds of cadence_rpm, the ends included however computed."""
    allowed, rpm = VARIABLES["cadence_rpm"], np.round(cadence / RPM, 9)
    return (allowed.low <= rpm) & (rpm <= allowed.high)


def crank_speed(design: Design, cadence: float | None = None) -> float:
    """Crank speed of a run, rad/s: `cadence` or, if it is None, that of Eq. 16.

    Raises InputError unless it is a cadence that can be run, and for a batch.
    """
    design.require_single()
    allowed, speed = VARIABLES["cadence_rpm"].allowed, design.linkage.cadence if cadence is None else cadence
    if runnable(speed):
        return speed
    if cadence is not None:
        raise InputError(f"{design.name}: cadence is {speed / RPM:.4g} rpm; it must be {allowed}")
    raise InputError(
        f"{design.name}: linkage.gear_ratio is {design.linkage.gear_ratio:g}, which makes {speed / RPM:.3g} rpm at the "
        f"tricycle's speed; it must be {allowed}: change the ratio or give a cadence"
    )


class Component(NamedTuple):
    """A plain number of a variable: itself, or the "real" or "imag" part of a vector."""

    variable: Variable
    part: str = ""


COMPONENTS = {
    symbol + axis: Component(variable, part)
    for symbol, variable in VARIABLES.items()
    for axis, part in ((("x", "real"), ("y", "imag")) if variable.vector else (("", ""),))
}
# What identification and optimiser move: R1x, R1y, R2, R6, R7x, R7y, R8, R9, R10.
LENGTHS = tuple(name for name, (v, _) in COMPONENTS.items() if v.owner == "linkage" and v.unit == "m")


def component(design: Design, name: str) -> float:
    """A component of a design in the unit of files; an angle as nearest_degrees."""
    variable, part = COMPONENTS[name]
    value = getattr(getattr(design, variable.owner), variable.attribute)
    return nearest_degrees(value) if variable.unit == "deg" else float(getattr(value, part) if part else value)


def nearest_degrees(angle: float) -> float:
    """The degrees that are read as the float nearest to an angle in rad: the same one for 11 of 12 angles.

    No degrees are read as the others, and math.degrees misses some that are.
    """
    below = above = middle = math.degrees(angle)
    candidates = [middle]
    for _ in range(2):
        below, above = math.nextafter(below, -math.inf), math.nextafter(above, math.inf)
        candidates += [below, above]
    return min(candidates, key=lambda degrees: abs(math.radians(degrees) - angle))


def replaced(design: Design, values: Mapping[str, Any]) -> Design:
    """The design with components, in the unit of files, replaced by numbers or, for a batch, arrays (designs, 1)."""
    changes: dict[str, dict[str, Any]] = {"linkage": {}, "rider": {}}
    for name, value in values.items():
        variable, part = COMPONENTS[name]
        if not variable.owner:
            continue
        changed = changes[variable.owner]
        if part:
            vector = changed.get(variable.attribute, getattr(design.linkage, variable.attribute))
            value = value + 1j * np.imag(vector) if part == "real" else np.real(vector) + 1j * value
        changed[variable.attribute] = np.radians(value) if variable.unit == "deg" else value
    return design.with_linkage(**changes["linkage"]).with_rider(**changes["rider"])


def lengths(design: Design) -> FloatArray:
    """The nine lengths of a linkage in the order of LENGTHS, m, shape (9,); a TRT has zeros for what it lacks."""
    return np.array([component(design, name) for name in LENGTHS])


def with_lengths(design: Design, values: FloatArray) -> Design:
    """The design with the nine lengths of LENGTHS replaced, m, shape (9,); shape (9, designs, 1) makes a batch."""
    return replaced(design, dict(zip(LENGTHS, values.tolist() if values.ndim == 1 else values, strict=True)))
