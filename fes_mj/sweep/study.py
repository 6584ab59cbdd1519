"""Study files: which designs, riders, cadences and moments a sweep goes through, numbered from 0."""

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fes_mj.arrays import FloatArray
from fes_mj.design import Design
from fes_mj.design_file import load_design
from fes_mj.errors import InputError
from fes_mj.files import Section, is_number, read_toml
from fes_mj.moments import JointMoments, load_moments
from fes_mj.time_step import LONGEST_TIMESTEP
from fes_mj.variables import COMPONENTS

ANALYSES = ("static", "dynamic")
# A chunk is a task and a file: about a second of static, a minute of dynamic work.
DEFAULT_CHUNK = {"static": 20_000, "dynamic": 1000}
MOST_POINTS = 10**9
MOST_VALUES = 10**6  # of one axis, or of the sample: they are held in memory
_TABLES = {
    "study": ("analysis", "chunk", "timestep"),
    "grid": ("design", "moments", *COMPONENTS),
    "sample": ("size", "seed", *COMPONENTS),
}
_EXAMPLES = {"design": '"d1", "mine.toml"', "moments": '"p1p2", "mine.csv"'}


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
    sample: dict[str, FloatArray]
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
    content = read_toml(path, "study")
    content.only(_TABLES)
    settings, grid, sample = (content.section(name) for name in _TABLES)
    for section in (settings, grid, sample):
        section.only(_TABLES[section.name])
    for axis, example in _EXAMPLES.items():
        grid.require([axis], f"give a list, as in {axis} = [{example}]")
    analysis, size = settings.choice("analysis", ANALYSES, "static"), sample.whole("size", 1)
    axes = {axis: _axis(grid, axis) for axis in grid.content}
    study = Study(
        analysis,
        settings.whole("chunk", DEFAULT_CHUNK[analysis]),
        _timestep(settings, analysis),
        axes,
        _sampled(sample, size),
        size,
        {name: load_design(_beside(path, name)) for name in axes["design"]},
        {name: load_moments(_beside(path, name)) for name in axes["moments"]},
    )
    _check(path, study)
    return study


def _check(path: Path, study: Study) -> None:
    for name in study.grid:
        if name in study.sample:
            raise InputError(f"{path}: {name} is both in grid and in sample; keep it in one of them")
    if study.points > MOST_POINTS:
        raise InputError(f"{path}: {study.points} points; a study has at most {MOST_POINTS}")
    for name in {*study.grid, *study.sample} & COMPONENTS.keys():
        for label, design in study.designs.items():
            if design.linkage.kind not in COMPONENTS[name].variable.kinds:
                raise InputError(f"{path}: {name} is varied, but design {label} is a {design.linkage.kind} without it")


def _beside(path: Path, name: str) -> str:
    """A file named in a study is looked for beside it."""
    return str(path.parent / name) if Path(name).suffix else name


def _timestep(settings: Section, analysis: str) -> float | None:
    if "timestep" not in settings.content:
        return None
    allowed = f"for dynamic studies, above 0 and at most {LONGEST_TIMESTEP:g} s"
    if analysis != "dynamic":
        settings.refuse("timestep", settings.content["timestep"], allowed)
    return settings.number("timestep", 1e-9, LONGEST_TIMESTEP, allowed)


def _axis(grid: Section, axis: str) -> list[Any]:
    """The values of a grid axis: a list, or numbers from ... to ... in so many steps."""
    values, example = grid.content[axis], _EXAMPLES.get(axis, "0.50, 0.52")
    if axis in COMPONENTS and isinstance(values, dict) and values.keys() == {"from", "to", "steps"}:
        low, high = _range(Section(grid.path, grid.name, {axis: [values["from"], values["to"]]}), axis)
        span = Section(grid.path, grid.label(axis), values)
        return [*np.linspace(low, high, _few(span, "steps", span.whole("steps", 1))).tolist()]
    if not isinstance(values, list) or not values:
        form = "" if axis in _EXAMPLES else " or { from = ..., to = ..., steps = ... }"
        grid.refuse(axis, values, f"a list like [{example}]{form}")
    _few(grid, axis, len(values))
    if axis in _EXAMPLES:
        if not all(isinstance(value, str) for value in values) or len({*values}) < len(values):
            grid.refuse(axis, values, "a list of different names")
        return values
    variable = COMPONENTS[axis].variable
    for value in values:
        if not (is_number(value) and variable.accepts(value)):
            grid.refuse(axis, value, f"from {variable.low:g} to {variable.high:g}")
    return [float(value) for value in values]


def _few(section: Section, key: str, count: int) -> int:
    """Refuse more values than fit into memory, before they are made."""
    if count > MOST_VALUES:
        section.refuse(key, count, f"at most {MOST_VALUES:,} values; take a coarser step or a sample")
    return count


def _sampled(sample: Section, size: int) -> dict[str, FloatArray]:
    """A Latin hypercube over the sample's ranges."""
    ranges = {name: _range(sample, name) for name in sample.content if name in COMPONENTS}
    seed = sample.content.get("seed", 0)
    if isinstance(seed, bool) or not isinstance(seed, int) or not 0 <= seed < 2**64:
        sample.refuse("seed", seed, "a whole number from 0")
    if not ranges:
        if size > 1:
            sample.refuse("size", size, "1 where no variable has a range; give one, as in R2 = [0.14, 0.18]")
        return {}
    _few(sample, "size", size)
    from scipy.stats.qmc import LatinHypercube

    unit = LatinHypercube(len(ranges), rng=seed).random(size)
    return {name: low + unit[:, i] * (high - low) for i, (name, (low, high)) in enumerate(ranges.items())}


def _range(section: Section, name: str) -> tuple[float, float]:
    variable = COMPONENTS[name].variable
    return section.ascending_pair(name, variable.low, variable.high)
