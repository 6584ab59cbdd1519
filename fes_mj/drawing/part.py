"""The drawing of a link: outline, holes with their letters, centre lines, dimensions; and what its holes are for."""

import itertools
import math
from collections.abc import Iterator

import numpy as np

from fes_mj.drawing.pen import Pen
from fes_mj.linkage.plates import Hole, Plate
from fes_mj.statics.sizes import BOUGHT, Build, bush_wall

FIRST = 9.0  # mm on paper from a link to its dimensions
_OVER = 3.0  # mm that centre lines stand out of a hole
_SAME = 1e-3  # mm: no dimension is shorter


def on_paper(place: complex) -> complex:
    """A point of a body's frame, m, as it is drawn, mm: seen from the rider's right."""
    return 1000 * complex(place).conjugate()


def plate_extent(plate: Plate) -> tuple[complex, complex]:
    """Lower left and upper right corner of a link as it is drawn in full size, without dimensions, mm."""
    corners, margin = np.array([on_paper(corner) for corner in plate.core]), 1000 * plate.margin * (1 + 1j)
    low, high = (complex(end(corners.real), end(corners.imag)) for end in (np.min, np.max))
    return low - margin, high + margin


def draw_part(pen: Pen, plate: Plate) -> None:
    """A link in its body's frame; the pen's scale is the drawing's."""
    points, bulges = [], []
    for corner in plate.corners[::-1]:  # seen from the other side they follow each other the other way round
        for normal, bulge in ((corner.after, math.tan(corner.angle / 4)), (corner.before, 0.0)):
            points.append(on_paper(corner.centre + plate.margin * normal))
            bulges.append(bulge)
    pen.outline(points, bulges, "OUTLINE")
    for letter, hole in lettered(plate):
        place, radius = on_paper(hole.place), 500 * hole.diameter
        pen.circle(place, 2 * radius, "HOLES")
        pen.cross(place, pen.scale * radius + _OVER)
        pen.text(letter, place + (0.75 * radius + 0.8 / pen.scale) * (-1 + 1j), align="RIGHT")
    _dimensions(pen, plate)


def lettered(plate: Plate) -> Iterator[tuple[str, Hole]]:
    """Holes and the letters by which the drawing names them."""
    return zip("ABC", plate.holes, strict=False)


def _dimensions(pen: Pen, plate: Plate) -> None:
    """Distances of the holes in line on one side; of one that stands off them on the other side."""
    low, high = plate_extent(plate)
    origin, *others = (on_paper(hole.place) for hole in plate.holes)
    off = [place for place in others if abs(place.imag) > _SAME]
    chain = sorted([origin, *(place for place in others if place not in off)], key=lambda place: place.real)
    below = not off or off[0].imag > 0
    levels = low.imag - FIRST / pen.scale, high.imag + FIRST / pen.scale
    level, other_level = levels if below else levels[::-1]
    for start, end in itertools.pairwise(chain):
        pen.dimension(start, end, 1j * level)
    for place in off:
        pen.dimension(origin, place, low.real - FIRST / pen.scale, angle=90)
        if abs(place.real) > _SAME:
            pen.dimension(origin, place, 1j * other_level)
    pen.radius(chain[-1], 1000 * plate.margin, 30.0 if below else -30.0)


def notes(build: Build, plate: Plate, scale: str) -> list[str]:
    """Title of a link, how it is made, and what each of its holes is for."""
    thick, margin, layer = 1e3 * plate.thickness, 1e3 * plate.margin, build.stack.layers[plate.body]
    made = f"{thick:g} mm {build.material.name}, R{margin:g} about the outer holes, {build.mass[plate.body]:.3f} kg"
    lines = [f"{plate.body.upper()} {scale}, 2 off: {made}, layer {layer}"]
    return lines + [f"{letter}  {purpose(build, plate, hole)}" for letter, hole in lettered(plate)]


def purpose(build: Build, plate: Plate, hole: Hole) -> str:
    """What a hole is for, with its fit (ISO 286)."""
    joint, pin = hole.joint, build.pins[hole.joint]
    wall = bush_wall(build.design, joint, plate.body, pin)
    name, size = joint.replace("_", " "), f"dia {1e3 * hole.diameter:g}"
    if joint == BOUGHT:
        return f"{name}: thread 9/16 in x 20 UNF, in the left leg's link left-hand"
    if joint == "crank_centre":
        return f"{name}: {size} H7, fixed on the axle"
    if wall:
        return f"{name}: {size} H7, bush {1e3 * pin:g}/{1e3 * hole.diameter:g}, pin dia {1e3 * pin:g} h6 turns in it"
    return f"{name}: {size} P7, pin dia {1e3 * pin:g} h6 pressed in"
