"""Study files: which designs, riders, cadences and moments a sweep goes through, numbered from 0."""

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from fes_mj.common.arrays import FloatArray
from fes_mj.common.brief import Brief
from fes_mj.common.errors import InputError
from fes_mj.common.reading import Section, is_number, read_toml
from fes_mj.linkage.design import Design
from fes_mj.linkage.design_file import load_design
from fes_mj.linkage.variables import COMPONENTS
from fes_mj.moments.files import load_moments
from fes_mj.moments.joint_moments import RIDER_GROUPS, JointMoments
from fes_mj.moments.measurement import measured_files
from fes_mj.muscles.drive import Muscles, load_muscles
from fes_mj.muscles.rules import BEST
from fes_mj.muscles.timing import DUTY, widths_up_to
from fes_mj.simulation.time_step import LONGEST_TIMESTEP

ANALYSES = ("static", "dynamic")
# A chunk is a task and a file: about a second of static, a minute of dynamic work or of muscles.
DEFAULT_CHUNK = {"static": 20_000, "dynamic": 1000, "muscles": 200}
MOST_CHUNK = 10**5  # points, which a process holds in memory with half a gigabyte of what leads to them
MOST_CHUNKS = 10**6  # files of one folder
MOST_POINTS = 10**9
MOST_VALUES = 10**6  # of one axis, or of the sample: they are held in memory
_TABLES = {
    "study": ("analysis", "chunk", "timestep", "characteristics"),
    "grid": ("design", "moments", *COMPONENTS),
    "sample": ("size", "seed", *COMPONENTS),
}
NAMES = ("design", "moments")  # axes whose values are names
_EXAMPLES = {"design": '"d1", "mine.toml"', "moments": '"p1p2", "mine.csv"'}


class MuscleOptions(NamedTuple):
    """How muscles drive a study; riders: a file of an ensemble instead of those of the rider groups."""

    rule: str = BEST
    duty: float = DUTY
    riders: Path | None = None


@dataclass(frozen=True, repr=False)
class Study(Brief):
    """Every combination of the grid's values with every point of the sample.

    Point i takes sample point i % size; the grid's last axis is the next to turn. grid: by axis, values as in the file.
    sample: by variable, shape (size,). characteristics: whether those of the turn are
    computed as well. files: what was read, the study file first. legs: that pedal together. muscles: what drives
    instead of the moments, by their names.
    """

    files: list[Path]
    analysis: str
    chunk: int
    timestep: float | None
    characteristics: bool
    grid: dict[str, list[Any]]
    sample: dict[str, FloatArray]
    size: int
    designs: dict[str, Design]
    moments: dict[str, JointMoments]
    legs: int = 1
    muscles: dict[str, Muscles] | None = None

    @property
    def brief(self) -> str:
        return f"{self.files[0].name}: {self.points:,} points, {self.analysis}"

    @property
    def points(self) -> int:
        return self.size * math.prod(len(values) for values in self.grid.values())

    @property
    def chunks(self) -> int:
        return -(-self.points // self.chunk)

    @property
    def varied(self) -> list[str]:
        """Axes with more than one value."""
        return [axis for axis, values in (self.grid | self.sample).items() if len(values) > 1]

    @property
    def varied_numbers(self) -> list[str]:
        """Those of them that are no names."""
        return [axis for axis in self.varied if axis not in NAMES]

    def numbers(self, chunk: int) -> NDArray[np.int64]:
        """Numbers of the points of a chunk, shape (points of the chunk,)."""
        return np.arange(chunk * self.chunk, min((chunk + 1) * self.chunk, self.points))

    def rows(self, chunk: int) -> dict[str, NDArray[Any]]:
        """Number ("point") and value of every axis for the points of a chunk, shape (points of the chunk,)."""
        number = self.numbers(chunk)
        rows: dict[str, NDArray[Any]] = {"point": number}
        rest = number // self.size
        for axis, values in reversed(self.grid.items()):
            rest, index = np.divmod(rest, len(values))
            rows[axis] = np.array(values)[index]
        return rows | {name: values[number % self.size] for name, values in self.sample.items()}


def label(axis: str) -> str:
    """An axis with its unit, as in a heading."""
    unit = COMPONENTS[axis].variable.unit if axis in COMPONENTS else ""
    return ", ".join(part for part in (axis.removesuffix("_rpm"), unit) if part)


def load_study(path: Path, cadence: float | None = None, muscles: MuscleOptions | None = None, legs: int = 1) -> Study:
    """Read a study file; cadence: of all points, rpm, for a file that says nothing of it.

    legs: one, or two half a turn apart on the same crank, which do the same. muscles: drive, those of the ensembles of
    the moments that the file names.
    Raises InputError naming file, key and value, and what is allowed.
    """
    content = read_toml(path, "study")
    content.only(_TABLES)
    settings, grid, sample = (content.section(name) for name in _TABLES)
    for section in (settings, grid, sample):
        section.only(_TABLES[section.name])
    grid.require(["design"], f"give a list, as in design = [{_EXAMPLES['design']}]")
    grid.content.setdefault("moments", [RIDER_GROUPS[0]])
    if cadence is not None:
        if "cadence_rpm" in grid.content or "cadence_rpm" in sample.content:
            raise InputError(f"{path}: cadence_rpm is given here; leave out the one beside the study")
        grid.content["cadence_rpm"] = [cadence]
    analysis, size = settings.choice("analysis", ANALYSES, "static"), _few(sample, "size", sample.whole("size", 1))
    points = size * math.prod(_count(grid, axis) for axis in grid.content)
    chunk = _chunk(settings, "muscles" if muscles else analysis, points)
    axes = {axis: _axis(grid, axis) for axis in grid.content}
    designs, moments = ([_beside(path, name) for name in axes[axis]] for axis in NAMES)
    files = [Path(name) for name in designs if Path(name).suffix]
    files += [file for name in moments if Path(name).suffix for file in measured_files(Path(name))]
    study = Study(
        [path, *files],
        analysis,
        chunk,
        _timestep(settings, analysis),
        settings.switch("characteristics"),
        axes,
        _sampled(sample, size),
        size,
        {name: load_design(file) for name, file in zip(axes["design"], designs, strict=True)},
        {name: load_moments(file) for name, file in zip(axes["moments"], moments, strict=True)},
        legs,
        _stimulated(settings, muscles, axes["moments"]) if muscles else None,
    )
    _check(path, study)
    return study


def _stimulated(settings: Section, muscles: MuscleOptions, names: list[str]) -> dict[str, Muscles]:
    """Muscles that drive by the names of the moments. Refuses names of which no muscles are known."""
    widths_up_to(muscles.duty)
    if muscles.riders and len(names) > 1:
        raise InputError(
            f"{settings.path}: grid.moments has {len(names)} names; an ensemble of riders is for one alone"
        )
    unknown = [name for name in names if name not in RIDER_GROUPS]
    if unknown and not muscles.riders:
        raise InputError(
            f"{settings.path}: grid.moments has {unknown[0]}, of which no muscles are known; keep to "
            f"{', '.join(RIDER_GROUPS)}, or give an ensemble of riders"
        )
    return {name: load_muscles(muscles.riders or name, muscles.rule, muscles.duty) for name in names}


def _chunk(settings: Section, analysis: str, points: int) -> int:
    """Points of a chunk. Refuses chunks that no memory holds, and more points or files than anybody waits for."""
    chunk = settings.whole("chunk", DEFAULT_CHUNK[analysis])
    if chunk > MOST_CHUNK:
        settings.refuse("chunk", chunk, f"at most {MOST_CHUNK:,} points")
    if points > MOST_POINTS:
        raise InputError(
            f"{settings.path}: {points:,} points; a study has at most {MOST_POINTS:,}: take fewer values or "
            "a smaller sample"
        )
    if points > MOST_CHUNKS * chunk:
        settings.refuse("chunk", chunk, f"at least {-(-points // MOST_CHUNKS):,} for {points:,} points")
    return chunk


def _check(path: Path, study: Study) -> None:
    for name in study.grid:
        if name in study.sample:
            raise InputError(f"{path}: {name} is both in grid and in sample; keep it in one of them")
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


def _count(grid: Section, axis: str) -> int:
    """How many values a grid axis has, before they are made: a list, or numbers from ... to ... in so many steps."""
    values, example = grid.content[axis], _EXAMPLES.get(axis, "0.50, 0.52")
    if axis in COMPONENTS and isinstance(values, dict) and values.keys() == {"from", "to", "steps"}:
        span = Section(grid.path, grid.label(axis), values)
        return _few(span, "steps", span.whole("steps", 1))
    if not isinstance(values, list) or not values:
        form = "" if axis in NAMES else " or { from = ..., to = ..., steps = ... }"
        grid.refuse(axis, values, f"a list like [{example}]{form}")
    return _few(grid, axis, len(values))


def _axis(grid: Section, axis: str) -> list[Any]:
    """The values of a grid axis."""
    values: Any = grid.content[axis]
    if isinstance(values, dict):
        low, high = _range(Section(grid.path, grid.name, {axis: [values["from"], values["to"]]}), axis)
        return [*np.linspace(low, high, values["steps"]).tolist()]
    if axis in NAMES:
        if not all(isinstance(value, str) for value in values) or len({*values}) < len(values):
            grid.refuse(axis, values, "a list of different names")
        return [*values]
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
    allowed = "a whole number from 0, below 2^64"
    seed = sample.value("seed", 0, lambda value: type(value) is int and 0 <= value < 2**64, allowed)
    if not ranges:
        if size > 1:
            sample.refuse("size", size, "1 where no variable has a range; give one, as in R2 = [0.14, 0.18]")
        return {}
    from scipy.stats.qmc import LatinHypercube

    unit = LatinHypercube(len(ranges), rng=seed).random(size)
    return {name: low + unit[:, i] * (high - low) for i, (name, (low, high)) in enumerate(ranges.items())}


def _range(section: Section, name: str) -> tuple[float, float]:
    variable = COMPONENTS[name].variable
    return section.ascending_pair(name, variable.low, variable.high)
