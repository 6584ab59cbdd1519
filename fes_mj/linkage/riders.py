"""Riders as people measured them: percentiles, presets and correlated samples of thigh, shank and mass."""

import math
import re
from dataclasses import dataclass, replace
from functools import cache
from typing import Any, NamedTuple

import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.common.reading import DATA, read_toml
from fes_mj.linkage.design import Rider

PRESETS = (
    "ansur-man-pN or ansur-woman-pN, N a percentile from 1 to 99, with -sci after it for the leg masses after a spinal "
    "cord injury"
)
_PRESET = re.compile(r"ansur-(man|woman)-p([1-9][0-9]?)(-sci)?", re.ASCII)
PEOPLE_PER_SEX = 1000  # people of each sex: a share is right to 1.6 % of the sample, one standard deviation
_FILE = DATA / "riders.toml"
_SCORE_95 = 1.6448536269514722  # of the standard normal distribution, percentile 95
# Of the median stature: from below the smallest to above the tallest of 6,068 adults.
_STATURE_PARTS = (0.75, 1.35)


class Measure(NamedTuple):
    """One measure of a population by its percentiles 5, 50 and 95, m or kg."""

    low: float
    middle: float
    high: float

    def at(self, score: Any) -> Any:
        """The value at normal scores, any shape: lognormal on either side of the median, through all three."""
        below, above = (abs(math.log(end / self.middle)) / _SCORE_95 for end in (self.low, self.high))
        return self.middle * np.exp(np.where(np.less(score, 0), below, above) * score)

    @property
    def sd(self) -> float:
        """Standard deviation of a normal distribution with these outer percentiles."""
        return (self.high - self.low) / (2 * _SCORE_95)


class Legs(NamedTuple):
    """Thigh and shank (as of a Rider, m) and body mass (kg) of several people, shape (people,) each."""

    thigh: FloatArray
    shank: FloatArray
    mass: FloatArray


@dataclass(frozen=True)
class Population:
    """Measured people of one sex; shank is their knee to malleolus, a Rider's reaches to the pedal axle's level."""

    sex: str
    thigh: Measure
    shank: Measure
    leg: Measure  # the two together
    mass: Measure
    stature: Measure

    @property
    def correlation(self) -> float:
        """Of thigh and shank, by the spread of their sum."""
        one, other = self.thigh.sd, self.shank.sd
        return (self.leg.sd**2 - one**2 - other**2) / (2 * one * other)

    def rider(self, percentile: float) -> Rider:
        """The rider whose thigh, shank and mass are each at this percentile, above 0 and below 100."""
        from statistics import NormalDist  # whose import takes longer than all of this module

        score = NormalDist().inv_cdf(percentile / 100)
        thigh, shank, mass = (float(value) for value in self._legs(score, score, score))
        return Rider(thigh, shank, mass, self.sex)

    @property
    def statures(self) -> tuple[float, float]:
        """Smallest and largest stature that of_stature scales to, m."""
        low, high = _STATURE_PARTS
        return low * self.stature.middle, high * self.stature.middle

    def of_stature(self, stature: float) -> Rider:
        """The rider of this stature, m, with the proportions and the body mass index of the median."""
        part = stature / self.stature.middle
        shank = part * self.shank.middle + boot_height()
        return Rider(part * self.thigh.middle, shank, part**2 * self.mass.middle, self.sex)

    def sample(self, size: int, random: "np.random.Generator") -> Legs:
        """So many people, with thigh, shank and mass as correlated as measured."""
        correlation = np.full((3, 3), _number("mass", "correlation"))
        correlation[0, 1] = correlation[1, 0] = self.correlation
        np.fill_diagonal(correlation, 1.0)
        return self._legs(*np.linalg.cholesky(correlation) @ random.standard_normal((3, size)))

    def _legs(self, thigh: Any, shank: Any, mass: Any) -> Legs:
        """The people with these normal scores."""
        return Legs(self.thigh.at(thigh), self.shank.at(shank) + boot_height(), self.mass.at(mass))


def preset(name: object) -> Rider | None:
    """The rider that a design file may name, as PRESETS says; None for what is no such name."""
    match = _PRESET.fullmatch(name) if isinstance(name, str) else None
    if not match:
        return None
    who, percentile, injured = match.groups()
    rider = populations()[who].rider(float(percentile))
    return replace(rider, leg_mass_factor=leg_mass_after_injury()[0]) if injured else rider


@cache
def populations() -> dict[str, Population]:
    """The measured people: "man" and "woman"."""
    rows = read_toml(_FILE, "riders").section("ansur").content
    return {
        who: Population(row["sex"], *(Measure(*row[key]) for key in ("thigh", "shank", "leg", "mass", "stature")))
        for who, row in rows.items()
    }


def leg_mass_after_injury() -> tuple[float, float]:
    """Factor on leg masses after a spinal cord injury, and its standard deviation."""
    return _number("sci", "leg_mass_factor"), _number("sci", "leg_mass_factor_sd")


def boot_height() -> float:
    """From the ankle's middle to the level of the pedal axle, m: what a Rider's shank has beyond the measured one."""
    return _number("boot", "malleolus_to_pedal")


@cache
def _number(table: str, key: str) -> float:
    return read_toml(_FILE, "riders").section(table).number(key)
