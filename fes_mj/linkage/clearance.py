"""How near moving parts come to each other and to what stands still, over the whole turn, seen from the side.

Both legs do the same, half a turn apart: what is said of one holds for the other. The links of a side lie in layers
beside each other, outwards from the frame to the leg: which of them may share a layer follows from how near they come.
"""

import itertools
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any, NamedTuple, TypeAlias

import numpy as np

from fes_mj.common.errors import require_extra
from fes_mj.linkage.design import BODIES, Design
from fes_mj.linkage.kinematics import FULL_TURN, Motion, solve, uniform_turn
from fes_mj.linkage.plates import Plate
from fes_mj.linkage.shapes import bars

CLEARANCE = 0.005  # m, wanted between what passes each other
SHOWN_GAP = 0.1  # m: gaps up to this are shown
WASHER = 0.001  # m between two layers
ROAD_REACH = 10.0  # m: farther than anything reaches
# Links and legs pass beside the tube and the chainring, which are in the middle, and feet beside the wheel.
FIXED = ("seat", "tube", "chainring", "wheel", "ground")


class Shape(NamedTuple):
    """What is within `radius` (m) of a point, line or triangle, whose corners are in the frame of a body ("": none)."""

    name: str
    body: str
    core: tuple[complex, ...]
    radius: float


class Gap(NamedTuple):
    """Least distance of two parts in a turn, m, negative if they overlap; at which crank angle, rad; nearest points."""

    parts: tuple[str, str]
    distance: float
    crank_angle: float
    ends: tuple[complex, complex]

    @property
    def pair(self) -> str:
        """Both names."""
        return " - ".join(part.replace("_", " ") for part in self.parts)


_Core: TypeAlias = tuple[complex, ...]


@lru_cache(maxsize=8)
def _motion(design: Design, points: int) -> Motion:
    return solve(design, uniform_turn(points))


@lru_cache(maxsize=1000)
def _nearest(
    design: Design, points: int, body: str, core: _Core, other_body: str, other_core: _Core
) -> tuple[float, float, tuple[complex, complex]]:
    """Least distance of two cores in a turn, m, the crank angle there, rad, and the nearest points."""
    import shapely

    motion = _motion(design, points)
    placed = (_placed(design, points, *shape) for shape in ((body, core), (other_body, other_core)))
    cores = [np.broadcast_to(shape, motion.crank_angle.shape) for shape in placed]
    apart = shapely.distance(*cores)
    place = int(apart.argmin())
    start, end = shapely.get_coordinates(shapely.shortest_line(cores[0][place], cores[1][place])) @ (1, 1j)
    return float(apart[place]), float(motion.crank_angle[place]), (complex(start), complex(end))


@lru_cache(maxsize=64)
def _placed(design: Design, points: int, body: str, core: _Core) -> Any:
    """A core as shapely's geometry: over the turn, or once if it stands still."""
    import shapely

    corners = np.array(core)
    if body:
        motion = _motion(design, points)
        origin = np.broadcast_to(motion.points[BODIES[body][0]].value, motion.crank_angle.shape)
        corners = origin[:, None] + motion.direction(body)[:, None] * corners
    plane = np.stack([corners.real, corners.imag], axis=-1)
    if len(core) == 1:
        return shapely.points(plane[..., 0, :])
    return (shapely.linestrings if len(core) == 2 else shapely.polygons)(plane)


@dataclass(frozen=True)
class Side:
    """Rider, links and frame from the side; plates and pins (diameter, m) by name. points: crank angles of the turn.

    Raises MissingPartError where shapely is not installed.
    """

    design: Design
    plates: Mapping[str, Plate]
    pins: Mapping[str, float]
    points: int = len(FULL_TURN)

    def __post_init__(self) -> None:
        require_extra("build", "shapely")

    @cached_property
    def motion(self) -> Motion:
        return _motion(self.design, self.points)

    @cached_property
    def shapes(self) -> dict[str, list[Shape]]:
        """All parts by name: of the leg, links, pins (by joint), and what of the frame is known."""
        drawn = [Shape(bar.part, bar.body, (bar.start, bar.end), bar.width / 2) for bar in bars(self.design)]
        parts = [shape for shape in drawn if shape.name in ("thigh", "shank", "boot", "seat")]
        parts += [Shape(body, body, plate.core, plate.margin) for body, plate in self.plates.items()]
        for joint, diameter in self.pins.items():
            body = next(body for body in self.design.linkage.architecture.joints[joint][::-1] if body in self.plates)
            place = next(hole.place for hole in self.plates[body].holes if hole.joint == joint)
            parts.append(Shape(joint, body, (place,), diameter / 2))
        parts += _of_frame(self.design)
        return {name: list(group) for name, group in itertools.groupby(parts, key=lambda shape: shape.name)}

    def gap(self, one: str, other: str) -> Gap:
        """Between two parts by name."""
        gaps = itertools.starmap(self._between, itertools.product(self.shapes[one], self.shapes[other]))
        return min(gaps, key=lambda gap: gap.distance)

    def _between(self, one: Shape, other: Shape) -> Gap:
        apart, crank_angle, (start, end) = _nearest(
            self.design, self.points, one.body, one.core, other.body, other.core
        )
        along = (end - start) / apart if apart else 0.0
        ends = start + one.radius * along, end - other.radius * along
        return Gap((one.name, other.name), apart - one.radius - other.radius, crank_angle, ends)

    @property
    def limbs(self) -> tuple[str, ...]:
        return "thigh", "shank", "boot"

    @cached_property
    def pairs(self) -> tuple[tuple[str, str], ...]:
        """Parts that are not joined and could meet."""
        links, moving = tuple(self.plates), (*self.limbs, *self.plates)
        pairs = [*itertools.combinations(links, 2), *itertools.product(links, self.pins)]
        pairs += itertools.product(self.limbs, links)
        pairs += itertools.product(moving, [part for part in FIXED if part in self.shapes])
        joints = self.design.linkage.architecture.joints
        apart = (pair for pair in pairs if not any({*pair} <= {joint, *bodies} for joint, bodies in joints.items()))
        return tuple(pair for pair in apart if pair != ("thigh", "seat"))  # on which it lies

    @cached_property
    def gaps(self) -> tuple[Gap, ...]:
        """Of all pairs."""
        return tuple(self.gap(*pair) for pair in self.pairs)

    @property
    def near(self) -> list[Gap]:
        """Those below SHOWN_GAP, the nearest first."""
        return sorted((gap for gap in self.gaps if gap.distance < SHOWN_GAP), key=lambda gap: gap.distance)

    @property
    def unknown(self) -> list[tuple[str, str]]:
        """Pairs of which nothing is known, as the design has no frame."""
        missing = [part for part in FIXED if part not in self.shapes]
        return list(itertools.product((*self.limbs, *self.plates), missing))

    @property
    def walls(self) -> list[Gap]:
        """To what nothing passes beside: seat and ground, of links also the wheel."""
        return [
            self.gap(part, wall)
            for part, wall in self.pairs
            if wall in ("seat", "ground") or (wall == "wheel" and part in self.plates)
        ]

    @property
    def hindrances(self) -> list[Gap]:
        """Those of the walls that are nearer than CLEARANCE."""
        return [gap for gap in self.walls if gap.distance < CLEARANCE]


def _of_frame(design: Design) -> Iterator[Shape]:
    """What the design file says of the frame."""
    frame, centre = design.frame, complex(design.linkage.crank_centre)
    if frame.tube and frame.tube_diameter:
        yield Shape("tube", "", frame.tube, frame.tube_diameter / 2)
    if frame.chainring_diameter:
        yield Shape("chainring", "", (centre,), frame.chainring_diameter / 2)
    if frame.wheel_centre is not None and frame.wheel_diameter:
        yield Shape("wheel", "", (frame.wheel_centre,), frame.wheel_diameter / 2)
    if frame.ground_height is not None:
        top = 1j * frame.ground_height
        yield Shape("ground", "", (top - ROAD_REACH, top - 2j * ROAD_REACH, top + ROAD_REACH), 0.0)
