"""Options of `fes_mj fit`: who rides, and how far the seat moves."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Annotated, Literal

from cyclopts import Parameter

from fes_mj.common.errors import InputError
from fes_mj.fit.seat import SeatLimits
from fes_mj.linkage.design import Design, Rider
from fes_mj.linkage.riders import SAMPLES, Population, populations
from fes_mj.linkage.variables import VARIABLES

_Range = Annotated[tuple[float, float], Parameter(negative="")]
FEWEST, MOST = 10, 100_000  # people of each sex in a sample
_FARTHEST = {"forward": (1.0, "m"), "up": (1.0, "m"), "recline": (90.0, "deg")}


def sample_size(samples: int | None) -> int:
    """People of each sex. Raises InputError for a sample that says nothing, or takes too long."""
    size = SAMPLES if samples is None else samples
    if not FEWEST <= size <= MOST:
        raise InputError(f"--samples is {size}; it must be from {FEWEST} to {MOST:,} people of each sex")
    return size


@Parameter(name="*")
@dataclass
class RiderOptions:
    """Who rides: by default the design's own rider.

    Parameters
    ----------
    thigh
        Thigh in m, from hip to knee; with --shank.
    shank
        Shank in m as in design files, from the knee to the level of the pedal axle: to the ankle and 10.5 cm more.
    stature
        Stature in m instead, for legs of the median's proportions; with --sex.
    percentile
        Percentile of thigh, shank and mass instead, above 0 and below 100; with --sex.
    sex
        Whose statures or percentiles.
    """

    thigh: float | None = None
    shank: float | None = None
    stature: float | None = None
    percentile: float | None = None
    sex: Literal["male", "female"] | None = None

    def load(self, design: Design) -> Rider:
        """The rider that the options describe. Raises InputError for what contradicts itself and for nobody."""
        named = {key: getattr(self, key) is not None for key in ("thigh", "shank", "stature", "percentile", "sex")}
        if (named["thigh"] or named["shank"]) + named["stature"] + named["percentile"] > 1:
            raise InputError("--thigh and --shank, --stature and --percentile exclude each other; give one of them")
        if named["thigh"] != named["shank"]:
            raise InputError("--thigh and --shank need each other; give both")
        if (named["stature"] or named["percentile"]) != named["sex"]:
            raise InputError("--stature and --percentile need --sex male or --sex female, which needs one of them")
        if self.thigh is not None and self.shank is not None:
            return replace(design.rider, thigh=_length("thigh", self.thigh), shank=_length("shank", self.shank))
        if self.stature is not None:
            people = self._people()
            low, high = people.statures
            if not low <= self.stature <= high:
                hint = _in_metres(self.stature)
                raise InputError(f"--stature is {self.stature:g}; it must be from {low:.2f} to {high:.2f} m{hint}")
            return people.of_stature(self.stature)
        if self.percentile is not None:
            if not 0 < self.percentile < 100:
                raise InputError(f"--percentile is {self.percentile:g}; it must be above 0 and below 100")
            return self._people().rider(self.percentile)
        return design.rider

    def _people(self) -> Population:
        return next(people for people in populations().values() if people.sex == self.sex)


def _length(name: str, value: float) -> float:
    variable = VARIABLES[name]
    if not variable.accepts(value):
        raise InputError(f"--{name} is {value:g}; it must be {variable.allowed}{_in_metres(value)}")
    return value


def _in_metres(value: float) -> str:
    return " (centimetres? lengths are in metres)" if value > 10 else ""


@Parameter(name="*")
@dataclass
class SeatOptions:
    """How far the seat moves from where it is drawn: least and most of each.

    Parameters
    ----------
    forward
        Towards the crank, m.
    up
        In height, m.
    recline
        Change of the seat angle, deg.
    """

    forward: _Range = (-0.05, 0.30)
    up: _Range = (-0.15, 0.15)
    recline: _Range = (-20.0, 20.0)

    def load(self) -> SeatLimits:
        """The limits. Raises InputError for a range that is empty, or farther than any seat goes."""
        for name, (most, unit) in _FARTHEST.items():
            low, high = getattr(self, name)
            if not (-most <= low <= most and -most <= high <= most):
                raise InputError(f"--{name} is {low:g} {high:g}; both must be from {-most:g} to {most:g} {unit}")
            if low > high:
                raise InputError(f"--{name} is {low:g} {high:g}, an empty range; give the smaller number first")
        return SeatLimits(self.forward, self.up, _radians(self.recline))


def _radians(degrees: Sequence[float]) -> tuple[float, float]:
    low, high = map(math.radians, degrees)
    return low, high
