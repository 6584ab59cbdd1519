"""Who of a population can ride a design, with the seat as drawn and with the seat moved, and with what power."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from scipy.interpolate import RegularGridInterpolator

from fes_mj.common.arrays import FloatArray
from fes_mj.common.brief import Brief
from fes_mj.fit.seat import SEAT_LIMITS, SeatLimits, best_seats, score
from fes_mj.linkage.design import Design
from fes_mj.linkage.riders import SAMPLES, Legs, Population, populations
from fes_mj.moments.joint_moments import JointMoments
from fes_mj.statics.work_table import WorkTable

SEATS = ("unmoved", "fitted")
PEOPLE = {"men": "man", "women": "woman"}
# Thighs and shanks for which the best seat is sought; in between its power is interpolated (PopulationFit.map_error).
_NODES = 9
_PROBES = 5  # people of each sex whose seat is sought as well, for the error of the map
_FINE = 61  # thighs and shanks of the map of the seat as drawn
_MARGIN = 1e-6  # m, so that the extreme people are inside the map


class PowerMap(NamedTuple):
    """Power over thigh and shank (m), W, shape (thighs, shanks); NaN where nobody can ride."""

    thigh: FloatArray
    shank: FloatArray
    power: FloatArray

    def at(self, thigh: FloatArray, shank: FloatArray) -> FloatArray:
        """Between the nodes, linear; NaN beside a node without power."""
        points = np.column_stack([thigh, shank])
        return np.asarray(RegularGridInterpolator((self.thigh, self.shank), self.power)(points))


class Riders(NamedTuple):
    """A sample of people, and their power with the seat as drawn and with the best seat, W, NaN for who cannot ride."""

    people: Population
    legs: Legs
    unmoved: FloatArray
    fitted: FloatArray


@dataclass(frozen=True, repr=False)
class PopulationFit(Brief):
    """How a design, with the seat as drawn and with the best one for each, suits a sample of "men" and of "women".

    drawn, map: with the seat as drawn and with the best one. map_error: largest difference of the interpolated power to
    that of a seat sought for the very person, W.
    """

    design: Design
    moments: JointMoments
    drawn: PowerMap
    map: PowerMap
    riders: dict[str, Riders]
    map_error: float

    @property
    def brief(self) -> str:
        shares = (f"{100 * np.mean(np.isfinite(riders.fitted)):.0f} % of {who}" for who, riders in self.riders.items())
        return f"{self.design.name} {self.moments.name}: {', '.join(shares)} can ride"

    def summary(self) -> dict[str, Any]:
        """The result as JSON names and units it."""
        size = len(next(iter(self.riders.values())).unmoved)
        content: dict[str, Any] = {"design": self.design.name, "group": self.moments.name, "samples": size}
        for seat in SEATS:
            powers = {who: getattr(riders, seat) for who, riders in self.riders.items()}
            riding = {who: power[np.isfinite(power)] for who, power in powers.items()}
            content[f"share_{seat}"] = {who: len(power) / size for who, power in riding.items()}
            for name, statistic in (("mean", np.mean), ("p10", lambda power: np.percentile(power, 10))):
                values = {who: float(statistic(power)) if len(power) else None for who, power in riding.items()}
                content[f"power_{name}_{seat}_W"] = values
        return content | {"map_error_W": self.map_error}


STEPS = _NODES + len(PEOPLE)  # how often fit_population calls `done`


def fit_population(
    design: Design,
    moments: JointMoments,
    *,
    limits: SeatLimits = SEAT_LIMITS,
    samples: int = SAMPLES,
    seed: int = 0,
    done: Callable[[], None] = lambda: None,
) -> PopulationFit:
    """Sample so many men and women; `done` is called STEPS times.

    Raises AssemblyError for a linkage that cannot turn whoever sits where.

    >>> fes_mj.fit_population(fes_mj.load_design("d1"), fes_mj.load_moments("p1p2"), samples=100)
    <PopulationFit d1 p1p2: 100 % of men, 100 % of women can ride>
    """
    table, random = WorkTable.of(moments), np.random.default_rng(seed)
    legs = {who: populations()[key].sample(samples, random) for who, key in PEOPLE.items()}
    thigh, shank = (
        np.linspace(np.min(lengths) - _MARGIN, np.max(lengths) + _MARGIN, _NODES)
        for lengths in ([people.thigh for people in legs.values()], [people.shank for people in legs.values()])
    )
    rows = []
    for length in thigh:
        rows.append(_fitted(design, np.full(_NODES, length), shank, table, limits))
        done()
    best, riders, errors = PowerMap(thigh, shank, np.array(rows)), {}, []
    fine = [np.linspace(axis[0], axis[-1], _FINE) for axis in (thigh, shank)]
    thighs, shanks = (axis.ravel() for axis in np.meshgrid(*fine, indexing="ij"))
    drawn = PowerMap(fine[0], fine[1], _unmoved(design, thighs, shanks, table).reshape(_FINE, _FINE))
    for who, people in legs.items():
        fitted, unmoved = best.at(people.thigh, people.shank), _unmoved(design, people.thigh, people.shank, table)
        riders[who] = Riders(populations()[PEOPLE[who]], people, unmoved, fitted)
        probes = slice(0, _PROBES)
        errors.append(fitted[probes] - _fitted(design, people.thigh[probes], people.shank[probes], table, limits))
        done()
    differences = np.abs(np.concatenate(errors))
    return PopulationFit(design, moments, drawn, best, riders, float(np.nanmax(differences, initial=0.0)))


def _unmoved(design: Design, thigh: FloatArray, shank: FloatArray, table: WorkTable) -> FloatArray:
    """Power of riders with the seat as drawn, W, NaN for who cannot ride, shape (riders,)."""
    scores = score(design.with_rider(thigh=thigh[:, None], shank=shank[:, None]), table)
    return np.where(scores.fits, scores.power, np.nan)


def _fitted(design: Design, thigh: FloatArray, shank: FloatArray, table: WorkTable, limits: SeatLimits) -> FloatArray:
    """Power of riders with the best seat, W, NaN for whom none suits, shape (riders,)."""
    _, scores = best_seats(design, thigh, shank, table, limits)
    return np.where(scores.fits, scores.power, np.nan)
