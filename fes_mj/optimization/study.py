"""Study files: which designs, riders, cadences and moments a sweep goes through, numbered from 0."""

from __future__ import annotations

import math
import tomllib
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from fes_mj.design import Design
from fes_mj.design_file import LONGEST, load_design
from fes_mj.errors import InputError
from fes_mj.torque import JointMoments, load_moments

ANALYSES = ("static", "dynamic")
# A chunk is a task and a file: about a second of static, a minute of dynamic work.
DEFAULT_CHUNK = {"static": 20_000, "dynamic": 1000}
MOST_POINTS = 10**9
_KEYS = {
    "study": ("analysis", "chunk", "timestep"),
    "grid": ("design", "moments"),
    "sample": ("size", "seed"),
}


class Variable(NamedTuple):
    """A number of a design that a study may vary: where it is, its range, the unit of the study file."""

    owner: str  # "linkage", "rider" or "" for the cadence
    attribute: str
    least: float
    most: float
    part: str = ""  # "real" or "imag" of a vector
    degrees: bool = False
    kinds: tuple[str, ...] = ("trt", "crt", "cdt")


_SIX_BAR, _SHORTEST = ("crt", "cdt"), 1e-3
VARIABLES = {
    "R1x": Variable("linkage", "ground", -LONGEST, LONGEST, "real"),
    "R1y": Variable("linkage", "ground", -LONGEST, LONGEST, "imag"),
    "R2": Variable("linkage", "crank", _SHORTEST, LONGEST),
    "R6": Variable("linkage", "foot", -LONGEST, LONGEST),
    "R7x": Variable("linkage", "pivot_to_crank", -LONGEST, LONGEST, "real", kinds=_SIX_BAR),
    "R7y": Variable("linkage", "pivot_to_crank", -LONGEST, LONGEST, "imag", kinds=_SIX_BAR),
    "R8": Variable("linkage", "pedal_arm", 0.0, LONGEST, kinds=_SIX_BAR),
    "R9": Variable("linkage", "coupler", _SHORTEST, LONGEST, kinds=_SIX_BAR),
    "R10": Variable("linkage", "rocker", _SHORTEST, LONGEST, kinds=_SIX_BAR),
    "gamma": Variable("linkage", "coupler_angle", -360, 360, degrees=True, kinds=("cdt",)),
    "gear_ratio": Variable("linkage", "gear_ratio", 0.01, 20),
    "seat_angle": Variable("linkage", "seat_angle", -360, 360, degrees=True),
    "thigh": Variable("rider", "thigh", _SHORTEST, LONGEST),
    "shank": Variable("rider", "shank", _SHORTEST, LONGEST),
    "mass": Variable("rider", "mass", 1.0, 500),
    "cadence_rpm": Variable("", "cadence", 1.0, 300),
}


@dataclass(frozen=True)
class Study:
    """Every combination of the grid's values with every point of the sample.

    Point i takes sample point i % size; the grid's last axis is the next to turn. grid: by axis, values as in the file.
    sample: by variable, shape (size,).
    """

    analysis: str
    chunk: int
    timestep: float | None
    grid: dict[str, list[Any]]
    sample: dict[str, NDArray[np.float64]]
    size: int
    designs: dict[str, Design]
    moments: dict[str, JointMoments]

    @property
    def points(self) -> int:
        return self.size * math.prod(len(values) for values in self.grid.values())

    @property
    def chunks(self) -> int:
        return -(-self.points // self.chunk)

    def rows(self, chunk: int) -> dict[str, NDArray[Any]]:
        """Number ("point") and value of every axis for the points of a chunk, shape (points of the chunk,)."""
        number = np.arange(chunk * self.chunk, min((chunk + 1) * self.chunk, self.points))
        rows: dict[str, NDArray[Any]] = {"point": number}
        rest = number // self.size
        for axis, values in reversed(self.grid.items()):
            rest, index = np.divmod(rest, len(values))
            rows[axis] = np.array(values)[index]
        return rows | {name: values[number % self.size] for name, values in self.sample.items()}


def load_study(path: Path) -> Study:
    """Read a study file. Raises InputError naming file, key and value, and what is allowed."""
    try:
        content = tomllib.loads(path.read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise InputError(f"{path}: cannot read the study: {getattr(error, 'strerror', None) or error}") from None
    for table, keys in content.items():
        if table not in _KEYS or not isinstance(keys, dict):
            raise InputError(f"{path}: unknown key {table}; a study has the tables {', '.join(_KEYS)}")
        allowed = _KEYS[table] + (() if table == "study" else tuple(VARIABLES))
        for key in keys:
            if key not in allowed:
                raise InputError(f"{path}: unknown key or variable {table}.{key}; allowed here: {', '.join(allowed)}")
    settings, sample = content.get("study", {}), content.get("sample", {})
    analysis = settings.get("analysis", "static")
    if analysis not in ANALYSES:
        raise InputError(f"{path}: study.analysis is {analysis!r}; it must be one of {', '.join(ANALYSES)}")
    chunk = _count(path, "study.chunk", settings.get("chunk", DEFAULT_CHUNK[analysis]))
    grid = {axis: _axis(path, axis, values) for axis, values in content.get("grid", {}).items()}
    for axis in ("design", "moments"):
        if axis not in grid:
            raise InputError(f"{path}: grid.{axis} is missing; give a list, as in {axis} = [{_EXAMPLES[axis]}]")
    size = _count(path, "sample.size", sample.get("size", 1))
    study = Study(
        analysis,
        chunk,
        _timestep(path, settings, analysis),
        grid,
        _sampled(path, sample, size),
        size,
        {name: load_design(_beside(path, name)) for name in grid["design"]},
        {name: load_moments(_beside(path, name)) for name in grid["moments"]},
    )
    _check(path, study)
    return study


_EXAMPLES = {"design": '"d1", "mine.toml"', "moments": '"p1p2", "mine.csv"'}


def _check(path: Path, study: Study) -> None:
    for name in study.grid:
        if name in study.sample:
            raise InputError(f"{path}: {name} is both in grid and in sample; keep it in one of them")
    if study.points > MOST_POINTS:
        raise InputError(f"{path}: {study.points} points; a study has at most {MOST_POINTS}")
    for name in (*study.grid, *study.sample):
        for label, design in study.designs.items():
            if name in VARIABLES and design.linkage.kind not in VARIABLES[name].kinds:
                raise InputError(f"{path}: {name} is varied, but design {label} is a {design.linkage.kind} without it")


def _beside(path: Path, name: str) -> str:
    """A file named in a study is looked for beside it."""
    return str(path.parent / name) if Path(name).suffix else name


def _count(path: Path, key: str, value: Any) -> int:
    if isinstance(value, bool) or not isinstance(value, int) or value < 1:
        raise InputError(f"{path}: {key} is {value!r}; it must be a whole number from 1")
    return value


def _timestep(path: Path, settings: dict[str, Any], analysis: str) -> float | None:
    value = settings.get("timestep")
    if value is None:
        return None
    if analysis != "dynamic" or not isinstance(value, (int, float)) or not 0 < value <= 0.02:
        raise InputError(f"{path}: study.timestep is {value!r}; it is for dynamic studies, above 0 and at most 0.02 s")
    return float(value)


def _axis(path: Path, axis: str, values: Any) -> list[Any]:
    """The values of a grid axis: a list, or numbers from ... to ... in so many steps."""
    if axis in VARIABLES and isinstance(values, dict) and set(values) == {"from", "to", "steps"}:
        low, high = _range(path, f"grid.{axis}", axis, [values["from"], values["to"]])
        return np.linspace(low, high, _count(path, f"grid.{axis}.steps", values["steps"])).tolist()
    if not isinstance(values, list) or not values:
        example = _EXAMPLES.get(axis, "0.50, 0.52")
        form = "" if axis in _EXAMPLES else " or { from = ..., to = ..., steps = ... }"
        raise InputError(f"{path}: grid.{axis} is {values!r}; it must be a list like [{example}]{form}")
    if axis in _EXAMPLES:
        if not all(isinstance(value, str) for value in values) or len({*values}) < len(values):
            raise InputError(f"{path}: grid.{axis} is {values!r}; it must be a list of different names")
        return values
    return [_value(path, f"grid.{axis}", axis, value) for value in values]


def _sampled(path: Path, sample: dict[str, Any], size: int) -> dict[str, NDArray[np.float64]]:
    """A Latin hypercube over the sample's ranges."""
    ranges = {name: _range(path, f"sample.{name}", name, value) for name, value in sample.items() if name in VARIABLES}
    seed = sample.get("seed", 0)
    if isinstance(seed, bool) or not isinstance(seed, int) or seed < 0:
        raise InputError(f"{path}: sample.seed is {seed!r}; it must be a whole number from 0")
    if not ranges:
        if size > 1:
            raise InputError(
                f"{path}: sample.size is {size}, but no variable has a range; give one, as in R2 = [0.14, 0.18]"
            )
        return {}
    from scipy.stats.qmc import LatinHypercube

    unit = LatinHypercube(len(ranges), rng=seed).random(size)
    return {name: low + unit[:, i] * (high - low) for i, (name, (low, high)) in enumerate(ranges.items())}


def _range(path: Path, key: str, name: str, value: Any) -> tuple[float, float]:
    if not isinstance(value, list) or len(value) != 2:
        raise InputError(f"{path}: {key} is {value!r}; it must be [lowest, highest]")
    low, high = (_value(path, key, name, part) for part in value)
    if not low < high:
        raise InputError(f"{path}: {key} is {value!r}; the bounds contradict each other, the first must be the smaller")
    return low, high


def _value(path: Path, key: str, name: str, value: Any) -> float:
    variable = VARIABLES[name]
    number = isinstance(value, (int, float)) and not isinstance(value, bool)
    if not number or not variable.least <= value <= variable.most:
        raise InputError(f"{path}: {key} is {value!r}; it must be from {variable.least:g} to {variable.most:g}")
    return float(value)


def vary(design: Design, values: dict[str, Any]) -> Design:
    """The design with variables, in units of the file, replaced by numbers or, for a batch, arrays (designs, 1)."""
    changes: dict[str, dict[str, Any]] = {"linkage": {}, "rider": {}}
    for name, value in values.items():
        variable = VARIABLES[name]
        if not variable.owner:
            continue
        changed = changes[variable.owner]
        if variable.part:
            vector = changed.get(variable.attribute, getattr(design.linkage, variable.attribute))
            value = value + 1j * np.imag(vector) if variable.part == "real" else np.real(vector) + 1j * value
        changed[variable.attribute] = np.radians(value) if variable.degrees else value
    return replace(
        design, linkage=replace(design.linkage, **changes["linkage"]), rider=replace(design.rider, **changes["rider"])
    )
