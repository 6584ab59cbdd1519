"""The limits of the paper's Section 6: as a TOML file, by name, and the numbers that they limit, for populations."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from fes_mj.common.arrays import ComplexArray, FloatArray
from fes_mj.common.errors import InputError, require_one_of
from fes_mj.common.reading import DATA, Section, is_list, is_number, read_toml
from fes_mj.linkage.assembly import LEAST_CLEARANCE, grashof_margin
from fes_mj.linkage.design import Design
from fes_mj.linkage.joints import JOINTS, PerJoint
from fes_mj.linkage.variables import COMPONENTS, LENGTHS
from fes_mj.optimization.buildable import KEYS, BuildLimits, hole_distance, transmission_angle
from fes_mj.statics.cycles import Cycles

DEFAULT = DATA / "optimization.toml"
PIVOTS = ("R1x", "R1y", "R7x", "R7y")
VARIED = (*LENGTHS, "gear_ratio")  # the ten variables x of the problem
_ON_EDGE = 1e-12  # m: a pivot that near to the border of the design space is on it, and inside
_BOUNDS = np.array([(COMPONENTS[name].variable.low, COMPONENTS[name].variable.high) for name in LENGTHS]).T
_OF_FOUR_BAR = [VARIED.index(name) for name in ("R1x", "R1y", "R2", "R6")]
_NUMBERS = ("crank_min", "rocker_min", "foot_max", "grashof_min")
_PAIRS = ("knee_deg", "hip_deg")
_NOT_NEGATIVE = ("gear_ratio_max", "joint_rounding_deg")
_TABLES = {
    "design_space": ("name", "polygon"),
    "limits": (*_NUMBERS, *_PAIRS, *_NOT_NEGATIVE),
    "search": tuple(name for name in VARIED if name not in PIVOTS),
}


@dataclass(frozen=True)
class Limits:
    """What a problem file says; lengths in m, angles in deg. build: limits beside the paper's, if they hold.

    polygon: vertices of the design space as complex numbers, shape (vertices,). search: lower and upper bound of
    each of VARIED, shape (10, 2).
    """

    space: str
    polygon: ComplexArray
    crank_min: float
    rocker_min: float
    foot_max: float
    grashof_min: float
    knee_deg: tuple[float, float]
    hip_deg: tuple[float, float]
    joint_rounding_deg: float
    gear_ratio_max: float
    search: FloatArray
    build: BuildLimits | None = None

    def holding(self, pivots: Sequence[complex], room: float) -> "Limits":
        """With the rectangle around these points, and so much room around them, m, as the design space."""
        low, high = (complex(end(np.real(pivots)), end(np.imag(pivots))) for end in (np.min, np.max))
        low, high = low - room * (1 + 1j), high + room * (1 + 1j)
        corners = np.round([low, complex(high.real, low.imag), high, complex(low.real, high.imag)], 9)
        bounds = dict(zip(VARIED, self.search, strict=True)) | _pivot_bounds(corners)
        name = f"within {100 * room:g} cm of the design's own pivots"
        return replace(self, space=name, polygon=corners, search=np.array([bounds[name] for name in VARIED]))


def load_limits(path: Path = DEFAULT, overrides: Mapping[str, float] | None = None) -> Limits:
    """Read a problem file; overrides: of BuildLimits by key, None for the paper's limits alone.

    Raises InputError naming file, key and value of what is missing, unknown, contradictory.
    """
    for key in overrides or ():
        require_one_of("a limit of what can be built", key, KEYS)
    content = read_toml(path, "problem")
    for section, keys in (
        (content, tuple(_TABLES)),
        *((content.section(name), keys) for name, keys in _TABLES.items()),
    ):
        section.only((*keys, *KEYS) if section.name == "limits" else keys)
        section.require(keys, f"copy it from the default problem file {DEFAULT.name}")
    space, limits, search = (content.section(name) for name in _TABLES)
    values: dict[str, Any] = {key: limits.number(key) for key in _NUMBERS}
    values |= {key: limits.ascending_pair(key) for key in _PAIRS}
    values |= {key: limits.number(key, 0.0, allowed="a number that is not negative") for key in _NOT_NEGATIVE}
    build = {key: limits.number(key, -math.inf) for key in KEYS if key in limits.content}
    polygon, bounds = _polygon(space), {key: search.ascending_pair(key) for key in _TABLES["search"]}
    bounds |= _pivot_bounds(polygon)
    return Limits(
        str(space.content["name"]),
        polygon,
        search=np.array([bounds[name] for name in VARIED]),
        build=None if overrides is None else BuildLimits(**(build | dict(overrides))),
        **values,
    )


def _pivot_bounds(polygon: ComplexArray) -> dict[str, tuple[float, float]]:
    """Search ranges of R1 and R7 in a design space, m."""
    bounds: dict[str, tuple[float, float]] = {}
    for axis, part in (("x", polygon.real), ("y", polygon.imag)):
        width = float(np.ptp(part))
        bounds |= {f"R1{axis}": (float(part.min()), float(part.max())), f"R7{axis}": (-width, width)}
    return bounds


def _polygon(space: Section) -> ComplexArray:
    allowed = "a list of vertices [x, y] in metres"
    points = space.value("polygon", None, lambda value: is_list(value, lambda p: is_list(p, is_number, 2)), allowed)
    vertices = np.array([complex(x, y) for x, y in points])
    area = abs(np.sum((np.conj(vertices) * np.roll(vertices, -1)).imag)) / 2
    if len(vertices) < 3 or not 1e-6 <= area < np.inf:
        raise InputError(
            f"{space.path}: {space.label('polygon')} encloses no area; at least 3 vertices around some are needed"
        )
    return vertices


def depth_inside(polygon: ComplexArray, points: ComplexArray) -> FloatArray:
    """Distance of points, shape (n,), to the border of a simple polygon, m; negative outside."""
    start, end = polygon, np.roll(polygon, -1)
    edge, arm = end - start, points[:, None] - start
    along = np.clip((np.conj(edge) * arm).real / np.abs(edge) ** 2, 0, 1)
    distance = np.abs(arm - along * edge).min(axis=1)
    # a ray to the right crosses the border an odd number of times from inside
    spans = (start.imag > points[:, None].imag) != (end.imag > points[:, None].imag)
    crosses = spans & ((np.conj(edge) * arm).imag * np.sign(edge.imag) > 0)
    inside = (crosses.sum(axis=1) % 2 == 1) | (distance < _ON_EDGE)
    return np.asarray(np.where(inside, distance, -distance))


class Constraint(NamedTuple):
    """A named limit on a number, in `unit`; `scale` makes violations of different units comparable."""

    name: str
    unit: str
    at_least: bool
    limit: float
    scale: float

    def margin(self, value: Any) -> Any:
        """How far inside the limit a value is, in `unit`; negative if it violates it."""
        return value - self.limit if self.at_least else self.limit - value


def length_constraints(limits: Limits) -> tuple[Constraint, ...]:
    """Constraints on the lengths alone."""
    return (
        Constraint("crank_length", "m", True, limits.crank_min, 0.01),
        Constraint("rocker_length", "m", True, limits.rocker_min, 0.01),
        Constraint("ankle_to_pedal", "m", False, limits.foot_max, 0.01),
        Constraint("lengths_inside", "m", True, 0.0, 0.01),
        Constraint("crank_shortest", "m", True, 0.0, 0.01),
        Constraint("grashof", "m", True, max(limits.grashof_min, LEAST_CLEARANCE), 0.01),
        Constraint("rocker_pivot_inside", "m", True, 0.0, 0.01),
        Constraint("crank_centre_inside", "m", True, 0.0, 0.01),
    )


def range_constraints(limits: Limits) -> tuple[Constraint, ...]:
    """Constraints on the smallest and the largest angle of each joint."""
    slack = limits.joint_rounding_deg
    (knee_low, knee_high), (hip_low, hip_high) = limits.knee_deg, limits.hip_deg
    return (
        Constraint("knee_min", "deg", True, knee_low - slack, 5.0),
        Constraint("knee_max", "deg", False, knee_high + slack, 5.0),
        Constraint("hip_min", "deg", True, hip_low - slack, 5.0),
        Constraint("hip_max", "deg", False, hip_high + slack, 5.0),
    )


def motion_constraints(
    limits: Limits,
    joint_speed: PerJoint[float],
    gear_ratios: tuple[float, float],
    ripple: float | None,
    inside_limit: tuple[str, float],
) -> tuple[Constraint, ...]:
    """Constraints on the turn, first those whose values are known at once; joint_speed in deg/s, as of Problem.

    inside_limit: what the joints' angles have to lie in, and how far, deg.
    """
    build = build_constraints(limits.build)
    return (
        Constraint("leg_reach", "m", True, LEAST_CLEARANCE, 0.01),
        *range_constraints(limits),
        *(Constraint(f"{joint}_speed", "deg/s", False, speed, 10.0) for joint, speed in joint_speed.items()),
        *(Constraint(f"{joint}_{inside_limit[0]}", "deg", True, inside_limit[1], 5.0) for joint in JOINTS),
        Constraint("gear_ratio_min", "", True, gear_ratios[0], 0.1),
        Constraint("gear_ratio", "", False, gear_ratios[1], 0.1),
        *build[:-2],
        *([Constraint("speed_ripple", "", False, ripple, 0.05)] if ripple is not None else []),
        *build[-2:],
    )


def build_constraints(build: BuildLimits | None) -> tuple[Constraint, ...]:
    """Constraints of what can be built, if there are any; the last two take long."""
    if build is None:
        return ()
    return (
        Constraint("hole_distance", "m", True, build.hole_distance_min, 0.01),
        Constraint("transmission_angle", "deg", True, build.transmission_angle_min, 5.0),
        Constraint("hip_swing", "deg", True, build.hip_swing_min, 5.0),
        Constraint("extrapolated_share", "", False, build.extrapolated_max, 0.1),
        Constraint("pin_force", "N", False, build.pin_force_max, 500.0),
        Constraint("clearance", "m", True, build.clearance_min, 0.01),
    )


def length_values(design: Design, lengths: FloatArray, polygon: ComplexArray) -> FloatArray:
    """Values of length_constraints for a batch of designs with these lengths, shape (n, 9); returns shape (n, 8)."""
    linkage, room = design.linkage, np.minimum(lengths - _BOUNDS[0], _BOUNDS[1] - lengths)
    pivots = (np.broadcast_to(point, (design.size, 1)).ravel() for point in (linkage.ground, linkage.crank_centre))
    inside = [depth_inside(polygon, points) for points in pivots]
    if linkage.kind == "trt":  # what a four-bar lacks keeps every limit
        none, of_four_bar = np.full(design.size, np.inf), room[:, _OF_FOUR_BAR].min(axis=1)
        columns = [linkage.crank, none, linkage.foot, of_four_bar, none, none, none, inside[1]]
    else:
        others = np.min([np.abs(linkage.pivot_to_crank), linkage.coupler, linkage.rocker], axis=0)
        shortest, grashof = others - linkage.crank, grashof_margin(design)
        columns = [linkage.crank, linkage.rocker, linkage.foot, room.min(axis=1), shortest, grashof, *inside]
    return np.column_stack([np.ravel(column) for column in columns])


def motion_values(
    design: Design, turn: Cycles, speeds: PerJoint[FloatArray], inside: PerJoint[FloatArray], outside: FloatArray | None
) -> FloatArray:
    """Values of motion_constraints that do not take long, in their order, of a batch with its gear ratios.

    speeds: of the joints at gear ratio 1, deg/s. inside, outside: as MomentDrive; None if no limits of build hold.
    """
    ratio, hip = np.ravel(design.linkage.gear_ratio), turn.joints.hip
    ranges = [np.degrees(side) for joint in turn.joints for side in (joint.low, joint.high)]
    columns = [turn.turning.reach, *ranges, *(speeds[joint] * ratio for joint in JOINTS), *inside, ratio, ratio]
    if outside is not None:
        columns += [hole_distance(design), transmission_angle(design, turn), np.degrees(hip.high - hip.low), outside]
    return np.column_stack(columns)


def constraint_margins(constraints: tuple[Constraint, ...], values: FloatArray) -> FloatArray:
    """How far inside their limits the values are, shape (n, constraints)."""
    return np.column_stack([c.margin(values[:, column]) for column, c in enumerate(constraints)])


class Meaning(NamedTuple):
    """What a limit is on, and where it is set: table and key of a problem file, or an option."""

    words: str
    where: str


_SPACE = "design_space.polygon"
MEANINGS = {
    "crank_length": Meaning("length of the crank, R2", "limits.crank_min"),
    "rocker_length": Meaning("length of the rocker, R10", "limits.rocker_min"),
    "ankle_to_pedal": Meaning("distance from ankle to pedal, R6", "limits.foot_max"),
    "lengths_inside": Meaning("how far all lengths are within what a design file may say", "always"),
    "crank_shortest": Meaning("shortest other link less the crank, which only then turns right round", "always"),
    "grashof": Meaning("Grashof's margin: how far rocker and coupler stay from a dead centre", "limits.grashof_min"),
    "rocker_pivot_inside": Meaning("distance of the rocker pivot to the border of the design space", _SPACE),
    "crank_centre_inside": Meaning("distance of the crank centre to the border of the design space", _SPACE),
    "leg_reach": Meaning("how far the leg stays from being stretched or folded flat", "always"),
    **{
        f"{joint}_{end}": Meaning(f"{size} {joint} angle", f"limits.{joint}_deg")
        for joint in JOINTS
        for end, size in (("min", "smallest"), ("max", "largest"))
    },
    **{f"{joint}_speed": Meaning(f"mean {joint} speed", f"the limit on the {joint} speed") for joint in JOINTS},
    **{f"{joint}_overlap": Meaning(f"how far the {joint} comes into the moments' range", "always") for joint in JOINTS},
    **{
        f"{joint}_muscles": Meaning(f"how far the {joint} stays within the known lengths of muscles", "always")
        for joint in JOINTS
    },
    "gear_ratio_min": Meaning("gear ratio, of the slowest cadence that can be run", "always"),
    "gear_ratio": Meaning("gear ratio: crank turns per turn of the wheel", "limits.gear_ratio_max"),
    "speed_ripple": Meaning("ripple of the crank's speed", "the limit on the ripple"),
    "hole_distance": Meaning("least distance of two holes in a link", "limits.hole_distance_min"),
    "transmission_angle": Meaning("smallest transmission angle of any two links", "limits.transmission_angle_min"),
    "hip_swing": Meaning("how far the hip moves", "limits.hip_swing_min"),
    "extrapolated_share": Meaning("share of the turn outside the moments' range", "limits.extrapolated_max"),
    "pin_force": Meaning("largest force on a pin, riding with masses", "limits.pin_force_max"),
    "clearance": Meaning("least clearance of what moves, in the best layers", "limits.clearance_min"),
}
