"""Links as a workshop cuts them: flat plates, the hull of their holes with an even margin around it.

In a body's own frame (origin, x axis to the tip), m.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from fes_mj.linkage.design import BODIES, Design
from fes_mj.linkage.inertia import Inertia, combine

_FLAT = 1e-9  # m: holes nearer to a line than this lie on it


class Hole(NamedTuple):
    """The hole of a joint: its name, place and diameter, m."""

    joint: str
    place: complex
    diameter: float


class Corner(NamedTuple):
    """A rounded corner: its centre, the outward normals of the edges before and after it (unit vectors), its angle."""

    centre: complex
    before: complex
    after: complex

    @property
    def angle(self) -> float:
        """By which the outline turns, rad, counter-clockwise."""
        return float(np.angle(self.after * np.conj(self.before))) % (2 * math.pi)


@dataclass(frozen=True)
class Plate:
    """A link: its body's name, holes, margin around their centres and thickness, m."""

    body: str
    holes: tuple[Hole, ...]
    margin: float
    thickness: float

    @property
    def width(self) -> float:
        """Of a link with its holes in line, m."""
        return 2 * self.margin

    @cached_property
    def core(self) -> tuple[complex, ...]:
        """Corners of the hull of the holes' centres, counter-clockwise; of holes in line their two ends."""
        places = [hole.place for hole in self.holes]
        first, last = max(((a, b) for a in places for b in places), key=lambda ends: abs(ends[1] - ends[0]))
        third = max(places, key=lambda place: abs(_offset(first, last, place)))
        height = _offset(first, last, third)
        if abs(height) < _FLAT:
            return first, last
        return (first, last, third) if height > 0 else (last, first, third)

    @cached_property
    def corners(self) -> tuple[Corner, ...]:
        """The outline: an arc of radius `margin` at each corner of the core, and straight lines between them."""
        ends = (*self.core[1:], self.core[0])
        normals = [-1j * (end - start) / abs(end - start) for start, end in zip(self.core, ends, strict=True)]
        return tuple(map(Corner, self.core, [normals[-1], *normals[:-1]], normals))

    @property
    def area(self) -> float:
        """Without the holes, m^2."""
        return float(self.inertia(1.0).mass) / self.thickness

    def inertia(self, density: float) -> Inertia:
        """Mass, centre of mass and moment of inertia about it of the plate with its holes; density in kg/m^3."""
        return combine(*(part._replace(mass=sign * part.mass, moment=sign * part.moment)
                         for sign, part in self._parts(density * self.thickness)))  # fmt: skip

    def _parts(self, mass_per_area: float) -> Iterator[tuple[int, Inertia]]:
        """Triangle, rectangles along its sides, sectors at its corners; holes count as less."""
        core, margin = self.core, self.margin
        sides = [(corner.centre, after.centre, corner.after)
                 for corner, after in zip(self.corners, (*self.corners[1:], self.corners[0]), strict=True)]  # fmt: skip
        if len(core) == 3:
            mass = mass_per_area * abs(core[1] - core[0]) * _offset(*core) / 2
            yield 1, Inertia(mass, sum(core) / 3, mass * sum(abs(end - start) ** 2 for start, end, _ in sides) / 36)
        for start, end, normal in sides:
            length = abs(end - start)
            mass = mass_per_area * length * margin
            yield 1, Inertia(mass, (start + end + margin * normal) / 2, mass * (length**2 + margin**2) / 12)
        for corner in self.corners:
            half = corner.angle / 2
            mass, reach = mass_per_area * half * margin**2, 2 * margin * math.sin(half) / (3 * half)
            middle = corner.before * complex(math.cos(half), math.sin(half))
            yield 1, Inertia(mass, corner.centre + reach * middle, mass * (margin**2 / 2 - reach**2))
        for _, place, diameter in self.holes:
            mass = mass_per_area * math.pi * diameter**2 / 4
            yield -1, Inertia(mass, place, mass * diameter**2 / 8)


def _offset(start: complex, end: complex, point: complex) -> float:
    """Distance of a point to the left of start -> end, m."""
    along = end - start
    return float((np.conj(along) * (point - start)).imag) / abs(along)


def hole_places(design: Design) -> dict[str, dict[str, Any]]:
    """Joints of every link (not of the leg) and where they are in its frame, by its name, m; of a batch arrays."""
    architecture, places = design.linkage.architecture, {}
    for body in architecture.bodies[2:]:
        length = design.link_lengths[body] + 0j
        joints = dict(zip(BODIES[body], (0 * length, length), strict=True))
        if body == architecture.pedal_body:
            joints = {joint: place for joint, place in joints.items() if joint in architecture.joints}
            joints["pedal"] = length * design.linkage.pedal_offset
        places[body] = joints
    return places
