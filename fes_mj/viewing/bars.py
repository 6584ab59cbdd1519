"""Leg, linkage and tricycle as flat bars: what drawings and the designer's page show, in the colours of the video."""

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

from fes_mj.common.arrays import ComplexArray
from fes_mj.common.style import hex_colour
from fes_mj.linkage.design import Design
from fes_mj.linkage.segments import foot_points
from fes_mj.simulation.appearance import BACKREST, PARTS, SEAT_DEPTH, SEAT_LENGTH

_CAP = np.exp(1j * np.linspace(-np.pi / 2, np.pi / 2, 17))  # half of a circle


class Bar(NamedTuple):
    """A thick line that is drawn, in the frame of a body ("" is the tricycle): ends and thickness in m."""

    body: str
    part: str
    start: complex
    end: complex

    def as_json(self) -> dict[str, Any]:
        """As the page reads it."""
        return {
            "body": self.body,
            "line": [self.start.real, self.start.imag, self.end.real, self.end.imag],
            "width": 2 * PARTS[self.part].size,
            "colour": self.colour,
        }

    @property
    def colour(self) -> str:
        """The video's."""
        return hex_colour(PARTS[self.part].colour)

    def outline(self, origin: complex, direction: complex) -> ComplexArray:
        """With its round ends, m, for a body whose frame has this origin and x axis."""
        along, radius = (self.end - self.start) / abs(self.end - self.start), PARTS[self.part].size
        shape = np.concatenate([self.end + radius * along * _CAP, self.start - radius * along * _CAP])
        return np.asarray(origin + direction * shape)


def bars(design: Design) -> Iterator[Bar]:
    """What is drawn, from back to front: the tricycle, the leg, then the linkage beside it, as in the video."""
    linkage, corner = design.linkage, SEAT_DEPTH * (0.5 - 1j)
    yield Bar("", "frame", corner, complex(linkage.ground))
    yield Bar("", "frame", complex(linkage.ground), complex(linkage.crank_centre))
    yield Bar("", "seat", corner, corner - SEAT_LENGTH)
    yield Bar("", "seat", corner, corner + BACKREST * complex(np.exp(1j * linkage.seat_angle)))
    ankle, heel, toe = foot_points(design)
    sole, radius = (toe - heel) / abs(toe - heel), PARTS["boot"].size
    yield Bar("thigh", "thigh", 0j, complex(design.rider.thigh))
    yield Bar("shank", "shank", 0j, ankle)
    yield Bar("shank", "boot", 0.6 * ankle, ankle)
    yield Bar("shank", "boot", heel + radius * sole, toe - radius * sole)
    pedal_body, lengths = linkage.architecture.pedal_body, design.link_lengths
    for body in ("coupler", "crank", "rocker"):
        if body in lengths:
            tip = complex(lengths[body])
            yield Bar(body, body, 0j, tip)
            if body == pedal_body != "crank":
                pedal = tip * complex(linkage.pedal_offset)
                yield Bar(body, body, tip if body == "rocker" else 0j, pedal)
                if body == "coupler":
                    yield Bar(body, body, pedal, tip)
