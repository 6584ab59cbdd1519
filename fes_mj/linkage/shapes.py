"""What a rider and a tricycle look like from the side: leg, linkage and seat as bars with round ends."""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from fes_mj.common.arrays import ComplexArray
from fes_mj.common.style import COLOURS, LINKS, hex_colour, rgb
from fes_mj.linkage import kinematics
from fes_mj.linkage.design import Design
from fes_mj.linkage.inertia import foot_points


class Part(NamedTuple):
    """How thick a kind of part is, and its colour."""

    size: float  # m: radius of what is round, half the thickness of a pad
    colour: tuple[float, float, float]  # RGB, each 0 to 1


PARTS = {
    "thigh": Part(0.065, rgb(LINKS["thigh"])),
    "shank": Part(0.048, rgb(LINKS["shank"])),
    "boot": Part(0.052, (0.27, 0.30, 0.35)),
    "hip": Part(0.028, rgb(COLOURS["hip"])),
    "knee": Part(0.028, rgb(COLOURS["knee"])),
    "crank": Part(0.011, rgb(LINKS["crank"])),
    "rocker": Part(0.011, rgb(LINKS["rocker"])),
    "coupler": Part(0.011, rgb(LINKS["coupler"])),
    "pin": Part(0.011, (0.22, 0.23, 0.26)),
    "chainring": Part(0.075, (0.36, 0.38, 0.42)),
    "frame": Part(0.018, (0.64, 0.67, 0.70)),
    "seat": Part(0.02, (0.45, 0.48, 0.53)),
}
BACKREST = 0.45  # m
SEAT_LENGTH = 0.25  # m
SEAT_DEPTH = 0.12  # m from the hip down to the seat

_CAP = np.exp(1j * np.linspace(-np.pi / 2, np.pi / 2, 17))  # half of a circle
_BACK_TO_FRONT = ("frame", "seat", "thigh", "shank", "boot", "coupler", "crank", "rocker")


class Bar(NamedTuple):
    """A part of PARTS between two points of a body ("" is the tricycle), m."""

    name: str
    body: str
    part: str
    start: complex
    end: complex

    @property
    def width(self) -> float:
        """Thickness, m."""
        return 2 * PARTS[self.part].size

    @property
    def colour(self) -> str:
        """As CSS writes it."""
        return hex_colour(PARTS[self.part].colour)

    def outline(self, origin: complex, direction: complex) -> ComplexArray:
        """With its round ends, m, for a body whose frame has this origin and x axis."""
        along, radius = (self.end - self.start) / abs(self.end - self.start), self.width / 2
        shape = np.concatenate([self.end + radius * along * _CAP, self.start - radius * along * _CAP])
        return np.asarray(origin + direction * shape)


def back_to_front(design: Design) -> list[Bar]:
    """The bars of a flat picture in the order in which they hide each other, as in the video."""
    return sorted(bars(design), key=lambda bar: _BACK_TO_FRONT.index(bar.part))


def bars(design: Design) -> Iterator[Bar]:
    """The leg, the linkage beside it, the tricycle."""
    yield from _limb(design)
    yield from _links(design)
    linkage, corner = design.linkage, SEAT_DEPTH * (0.5 - 1j)
    yield Bar("seat", "", "seat", corner, corner - SEAT_LENGTH)
    yield Bar("backrest", "", "seat", corner, corner + BACKREST * complex(np.exp(1j * linkage.seat_angle)))
    yield Bar("seat_tube", "", "frame", corner, complex(linkage.ground))
    if linkage.pivot_to_crank:  # a TRT's ground link ends at the crank
        yield Bar("boom", "", "frame", complex(linkage.ground), complex(linkage.crank_centre))


def _limb(design: Design) -> Iterator[Bar]:
    ankle, heel, toe = foot_points(design)
    sole, radius = (toe - heel) / abs(toe - heel), PARTS["boot"].size
    yield Bar("thigh", "thigh", "thigh", 0j, complex(design.rider.thigh))
    yield Bar("shank", "shank", "shank", 0j, ankle)
    yield Bar("boot", "shank", "boot", heel + radius * sole, toe - radius * sole)
    yield Bar("boot_shaft", "shank", "boot", 0.6 * ankle, ankle)


def _links(design: Design) -> Iterator[Bar]:
    linkage = design.linkage
    for body in linkage.architecture.bodies[2:]:
        tip = complex(design.link_lengths[body])
        pedal = tip * complex(linkage.pedal_offset)
        carries = body == linkage.architecture.pedal_body != "crank"
        # the rocker's pedal arm lies in line with it
        yield Bar(f"{body}_bar", body, body, 0j, pedal if carries and body == "rocker" else tip)
        if carries and body == "coupler":  # its pedal arm stands off it, so a third bar makes it a triangle
            yield Bar(f"{body}_pedal_arm_bar", body, body, 0j, pedal)
            yield Bar(f"{body}_brace_bar", body, body, pedal, tip)


def lowest_point(design: Design) -> float:
    """How far above (below, if negative) the hip the lowest point of boot, linkage and seat comes in a turn, m."""
    motion = kinematics.solve(design, kinematics.FULL_TURN)
    foot = [motion.body_point("shank", point).value for point in foot_points(design)[1:]]
    lowest = min(float(np.min(np.imag(point))) for point in (*foot, *(jet.value for jet in motion.points.values())))
    return min(lowest - PARTS["boot"].size, -SEAT_DEPTH - PARTS["seat"].size)
