"""The limits of the optimisation problem as a TOML file: design space, limits, search ranges."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from fes_mj.common.arrays import ComplexArray, FloatArray
from fes_mj.common.errors import InputError
from fes_mj.common.reading import DATA, Section, is_number, read_toml
from fes_mj.linkage.variables import LENGTHS

DEFAULT = DATA / "optimization.toml"
VARIED = (*LENGTHS, "gear_ratio")  # the ten variables x of the problem
_PAIRS = ("knee_deg", "hip_deg")
_NOT_NEGATIVE = ("gear_ratio_max", "joint_rounding_deg")
_TABLES = {
    "design_space": ("name", "polygon"),
    "limits": ("crank_min", "rocker_min", "foot_max", "grashof_min", *_PAIRS, *_NOT_NEGATIVE),
    "search": tuple(name for name in VARIED if name[:2] not in ("R1", "R7") or name == "R10"),
}


@dataclass(frozen=True)
class Limits:
    """What a problem file says; lengths in m, angles in deg.

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


def load_limits(path: Path = DEFAULT) -> Limits:
    """Read a problem file. Raises InputError naming file, key and value of what is missing, unknown, contradictory."""
    content = read_toml(path, "problem")
    for section, keys in (
        (content, tuple(_TABLES)),
        *((content.section(name), keys) for name, keys in _TABLES.items()),
    ):
        section.only(keys)
        section.require(keys, f"copy it from the default problem file {DEFAULT.name}")
    space, limits, search = (content.section(name) for name in _TABLES)
    values: dict[str, Any] = {
        key: limits.ascending_pair(key)
        if key in _PAIRS
        else limits.number(key, 0.0, allowed="a number that is not negative")
        if key in _NOT_NEGATIVE
        else limits.number(key)
        for key in _TABLES["limits"]
    }
    polygon, bounds = _polygon(space), {key: search.ascending_pair(key) for key in _TABLES["search"]}
    for axis, part in (("x", polygon.real), ("y", polygon.imag)):
        width = float(np.ptp(part))
        bounds |= {f"R1{axis}": (float(part.min()), float(part.max())), f"R7{axis}": (-width, width)}
    return Limits(str(space.content["name"]), polygon, search=np.array([bounds[name] for name in VARIED]), **values)


def _polygon(space: Section) -> ComplexArray:
    value = space.content["polygon"]
    points = value if isinstance(value, list) else [None]
    if not all(isinstance(point, list) and len(point) == 2 and all(map(is_number, point)) for point in points):
        space.refuse("polygon", value, "a list of vertices [x, y] in metres")
    vertices = np.array([complex(x, y) for x, y in value])
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
    return np.asarray(np.where(crosses.sum(axis=1) % 2 == 1, distance, -distance))
