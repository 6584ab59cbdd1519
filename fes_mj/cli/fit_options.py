"""Options of `fes_mj fit`: who rides, and how far the seat moves."""

import math
from dataclasses import dataclass, replace
from typing import Annotated, Literal

from cyclopts import Group, Parameter
from cyclopts.validators import Number, all_or_none, mutually_exclusive

from fes_mj.cli.options import bounds
from fes_mj.common.errors import InputError
from fes_mj.fit.seat import SeatLimits
from fes_mj.linkage.design import Design, Rider
from fes_mj.linkage.riders import populations

_RIDER, _SEAT = Group("Rider"), Group("Seat")
_LEG = Group("legs, thigh and shank", show=False, validator=all_or_none)
_WHO = Group("a rider, one of", show=False, validator=mutually_exclusive)
_Metres = Annotated[tuple[float, float], Parameter(group=_SEAT, negative="", validator=Number(gte=-1, lte=1))]
_Degrees = Annotated[tuple[float, float], Parameter(group=_SEAT, negative="", validator=Number(gte=-90, lte=90))]


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

    thigh: Annotated[float | None, Parameter(group=(_RIDER, _LEG, _WHO), validator=bounds("thigh"))] = None
    shank: Annotated[float | None, Parameter(group=(_RIDER, _LEG), validator=bounds("shank"))] = None
    stature: Annotated[float | None, Parameter(group=(_RIDER, _WHO))] = None
    percentile: Annotated[float | None, Parameter(group=(_RIDER, _WHO), validator=Number(gt=0, lt=100))] = None
    sex: Annotated[Literal["male", "female"] | None, Parameter(group=_RIDER)] = None

    def load(self, design: Design) -> Rider:
        """The rider that the options describe. Raises InputError for what contradicts itself and for nobody."""
        if (self.stature is None and self.percentile is None) != (self.sex is None):
            raise InputError("--stature and --percentile need --sex male or --sex female, which needs one of them")
        if self.thigh is not None and self.shank is not None:
            return replace(design.rider, thigh=self.thigh, shank=self.shank)
        if self.sex is None:
            return design.rider
        people = next(people for people in populations().values() if people.sex == self.sex)
        if self.percentile is not None:
            return people.rider(self.percentile)
        low, high = people.statures
        if self.stature is None or not low <= self.stature <= high:
            raise InputError(f"--stature is {self.stature:g}; it must be from {low:.2f} to {high:.2f} in metres")
        return people.of_stature(self.stature)


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

    forward: _Metres = (-0.05, 0.30)
    up: _Metres = (-0.15, 0.15)
    recline: _Degrees = (-20.0, 20.0)

    def load(self) -> SeatLimits:
        """The limits. Raises InputError for a range that is empty."""
        for name, (low, high) in vars(self).items():
            if low > high:
                raise InputError(f"--{name} is {low:g} {high:g}, an empty range; give the smaller number first")
        return SeatLimits(self.forward, self.up, (math.radians(self.recline[0]), math.radians(self.recline[1])))
