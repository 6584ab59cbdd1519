"""The mechanism on a sheet: rider, links and frame with the leg bent and stretched most, paths, clearances."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from fes_mj.common.arrays import ComplexArray
from fes_mj.drawing.pen import TEXT_HEIGHT, Pen, seen
from fes_mj.linkage.clearance import Gap
from fes_mj.linkage.design import BODIES
from fes_mj.linkage.kinematics import FULL_TURN
from fes_mj.linkage.plates import Plate
from fes_mj.linkage.shapes import back_to_front
from fes_mj.statics.sizes import Build

SCALES = (1.0, 0.5, 0.2, 0.1, 0.05, 0.02)  # ISO 5455
LINE = 1.8 * TEXT_HEIGHT  # mm from a line of text to the next
FIXED_POINTS = ("crank_centre", "hip", "rocker_pivot")


class Box(NamedTuple):
    """A part of the sheet, mm."""

    left: float
    bottom: float
    right: float
    top: float

    @property
    def size(self) -> complex:
        return complex(self.right - self.left, self.top - self.bottom)

    @property
    def middle(self) -> complex:
        return complex(self.left + self.right, self.bottom + self.top) / 2


def ratio(scale: float) -> str:
    """A scale as drawings name it."""
    return f"1:{round(1 / scale)}"


def largest_scale(size: complex, room: complex) -> float:
    """With which something of this width and height fits, mm."""
    return next(scale for scale in SCALES if scale * size.real <= room.real and scale * size.imag <= room.imag)


def mechanism(pen: Pen, build: Build, gaps: Sequence[Gap], box: Box) -> None:
    """Rider, links and frame with the leg bent most and stretched most, and the paths of pedal and knee."""
    points = build.stack.side.motion.points
    paths = {name: seen(points[name].value) for name in ("pedal", "knee")}
    reach = np.abs(points["pedal"].value)
    bent, stretched = int(reach.argmin()), int(reach.argmax())
    lines = [*_pose(build, stretched, "PHANTOM"), *_pose(build, bent, "OUTLINE")]
    cloud = np.concatenate([*paths.values(), *(line for line, _ in lines)])
    low, high = complex(cloud.real.min(), cloud.imag.min()), complex(cloud.real.max(), cloud.imag.max())
    scale = largest_scale(high - low, box.size - 2j * LINE)
    view = pen.moved(box.middle - 1j * LINE - scale * (low + high) / 2, scale)
    for line, layer in lines:
        view.line(line, layer, close=True)
    returning = {"knee"} | ({"pedal"} if build.design.linkage.architecture.pedal_body == "rocker" else set())
    for name, path in paths.items():
        view.line(_one_way(path) if name in returning else path, "PATH", close=name not in returning)
    crosses = [seen(complex(points[joint].value)) for joint in FIXED_POINTS if joint in points]
    for cross in crosses:
        view.cross(cross, 4.0)
    ends = [[*map(seen, gap.ends)] for gap in gaps]
    middles = [sum(pair) / 2 for pair in ends]
    for number, place in enumerate(_beside(middles, crosses, TEXT_HEIGHT / scale)):
        leader = place - middles[number]
        view.line(ends[number], "DIMENSIONS")
        view.line([middles[number], place - TEXT_HEIGHT / scale * leader / abs(leader)], "DIMENSIONS")
        view.text(str(number + 1), place, align="MIDDLE_CENTER")
    angles = [f"{np.degrees(FULL_TURN[place]):.1f} deg" for place in (bent, stretched)]
    pen.text(
        f"MECHANISM {ratio(scale)}, seen from the rider's right; links thick with the leg bent most (crank at "
        f"{angles[0]}), thin stretched most ({angles[1]})",
        complex(box.left, box.top - LINE),
    )
    pen.text("broken lines: paths of pedal and knee; numbers: clearances", complex(box.left, box.top - 2 * LINE))


def _one_way(path: ComplexArray) -> ComplexArray:
    """Of an arc that is passed there and back: the way there, so that its dashes do not fill each other's gaps."""
    end = int(np.abs(path - path.mean()).argmax())
    path = np.roll(path, -end)
    return path[: int(np.abs(path - path[0]).argmax()) + 1]


def _beside(points: Sequence[complex], others: Sequence[complex], letter: float) -> list[complex]:
    """Where each point's number stands, as near to it as other numbers, points and what else is there let it."""
    around, taken = np.exp(2j * np.pi * (np.arange(16) + 0.5) / 16), [*points, *others]
    for point in points:
        places = (complex(point + radius * letter * direction) for radius in range(2, 20) for direction in around)
        taken.append(next(place for place in places if all(abs(place - other) >= 2 * letter for other in taken)))
    return taken[-len(points) :] if points else []


def _pose(build: Build, place: int, layer: str) -> list[tuple[ComplexArray, str]]:
    """Outlines at a place of the turn: leg and seat thin, links in the layer."""
    motion = build.stack.side.motion

    def frame(body: str) -> tuple[complex, complex]:
        if not body:  # the tricycle's
            return 0j, 1.0 + 0j
        origin = np.broadcast_to(motion.points[BODIES[body][0]].value, FULL_TURN.shape)[place]
        return complex(origin), complex(motion.direction(body)[place])

    thin = [bar for bar in back_to_front(build.design) if bar.body not in build.plates and bar.part != "frame"]
    lines = [(seen(bar.outline(*frame(bar.body))), "PHANTOM") for bar in thin]
    for body, plate in build.plates.items():
        origin, direction = frame(body)
        lines.append((seen(origin + direction * plate_outline(plate)), layer))
    return lines


def plate_outline(plate: Plate) -> ComplexArray:
    """Points along a plate's outline in its body's frame, m."""
    arcs = [
        corner.centre + plate.margin * corner.before * np.exp(1j * np.linspace(0, corner.angle, 24))
        for corner in plate.corners
    ]
    return np.concatenate(arcs)
