"""The limits of the optimisation problem as a TOML file: design space, limits, search ranges."""

from __future__ import annotations

import math
import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fes_mj.errors import InputError

DEFAULT = Path(__file__).parents[1] / "data" / "optimization.toml"
VARIABLES = ("R1x", "R1y", "R2", "R6", "R7x", "R7y", "R8", "R9", "R10", "gear_ratio")
_PAIRS = ("knee_deg", "hip_deg")
_LIMITS = ("crank_min", "rocker_min", "foot_max", "grashof_min", *_PAIRS, "joint_rounding_deg", "gear_ratio_max")
_SEARCHED = ("R2", "R6", "R8", "R9", "R10", "gear_ratio")


@dataclass(frozen=True)
class Limits:
    """What a problem file says; lengths in m, angles in deg.

    polygon: vertices of the design space as complex numbers, shape (vertices,). search: lower and upper bound of
    each of VARIABLES, shape (10, 2).
    """

    space: str
    polygon: NDArray[np.complex128]
    crank_min: float
    rocker_min: float
    foot_max: float
    grashof_min: float
    knee_deg: tuple[float, float]
    hip_deg: tuple[float, float]
    joint_rounding_deg: float
    gear_ratio_max: float
    search: NDArray[np.float64]


def load_limits(path: Path = DEFAULT) -> Limits:
    """Read a problem file. Raises InputError naming file, key and value of what is missing, unknown, contradictory."""
    try:
        content = tomllib.loads(path.read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise InputError(f"{path}: cannot read the problem: {getattr(error, 'strerror', None) or error}") from None
    tables = {"design_space": ("name", "polygon"), "limits": _LIMITS, "search": _SEARCHED}
    _same_keys(path, "", content, tuple(tables))
    for table, keys in tables.items():
        if not isinstance(content[table], dict):
            raise InputError(f"{path}: {table} is {content[table]!r}; it must be a table [{table}]")
        _same_keys(path, f"{table}.", content[table], keys)
    polygon = _polygon(path, content["design_space"]["polygon"])
    limits: dict[str, Any] = {
        key: _pair(path, f"limits.{key}", value) if key in _PAIRS else _number(path, f"limits.{key}", value)
        for key, value in content["limits"].items()
    }
    for key in ("gear_ratio_max", "joint_rounding_deg"):
        if limits[key] < 0:
            raise InputError(f"{path}: limits.{key} is {limits[key]:g}; it must not be negative")
    search = {key: _pair(path, f"search.{key}", value) for key, value in content["search"].items()}
    for axis, part in (("x", polygon.real), ("y", polygon.imag)):
        width = float(np.ptp(part))
        search |= {f"R1{axis}": (float(part.min()), float(part.max())), f"R7{axis}": (-width, width)}
    bounds = np.array([search[name] for name in VARIABLES])
    return Limits(str(content["design_space"]["name"]), polygon, search=bounds, **limits)


def _same_keys(path: Path, prefix: str, content: dict[str, Any], keys: tuple[str, ...]) -> None:
    for key in content:
        if key not in keys:
            raise InputError(f"{path}: unknown key {prefix}{key}; allowed here: {', '.join(keys)}")
    for key in keys:
        if key not in content:
            raise InputError(f"{path}: {prefix}{key} is missing; copy it from the default problem file {DEFAULT.name}")


def _number(path: Path, name: str, value: Any) -> float:
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value):
        raise InputError(f"{path}: {name} is {value!r}; it must be a number")
    return float(value)


def _pair(path: Path, name: str, value: Any) -> tuple[float, float]:
    if not isinstance(value, list) or len(value) != 2:
        raise InputError(f"{path}: {name} is {value!r}; it must be [lowest, highest]")
    low, high = (_number(path, name, part) for part in value)
    if not low < high:
        raise InputError(
            f"{path}: {name} is {value!r}; the bounds contradict each other, the first must be the smaller"
        )
    return low, high


def _polygon(path: Path, value: Any) -> NDArray[np.complex128]:
    name = "design_space.polygon"
    if not isinstance(value, list) or not all(isinstance(vertex, list) and len(vertex) == 2 for vertex in value):
        raise InputError(f"{path}: {name} is {value!r}; it must be a list of vertices [x, y] in metres")
    vertices = np.array([complex(*(_number(path, name, part) for part in vertex)) for vertex in value])
    area = abs(np.sum((np.conj(vertices) * np.roll(vertices, -1)).imag)) / 2
    if len(vertices) < 3 or area < 1e-6:
        raise InputError(f"{path}: {name} encloses no area; at least 3 vertices around some are needed")
    return vertices


def depth_inside(polygon: NDArray[np.complex128], points: NDArray[np.complex128]) -> NDArray[np.float64]:
    """Distance of points, shape (n,), to the border of a simple polygon, m; negative outside."""
    start, end = polygon, np.roll(polygon, -1)
    edge, arm = end - start, points[:, None] - start
    along = np.clip((np.conj(edge) * arm).real / np.abs(edge) ** 2, 0, 1)
    distance = np.abs(arm - along * edge).min(axis=1)
    # a ray to the right crosses the border an odd number of times from inside
    spans = (start.imag > points[:, None].imag) != (end.imag > points[:, None].imag)
    crosses = spans & ((np.conj(edge) * arm).imag * np.sign(edge.imag) > 0)
    return np.where(crosses.sum(axis=1) % 2 == 1, distance, -distance)
