"""Who of a population can ride a design, with the seat as drawn and with the seat moved, and with what power."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from fes_mj.common.arrays import BoolArray, FloatArray
from fes_mj.common.brief import Brief
from fes_mj.common.errors import require_within
from fes_mj.fit.search import best_seats, seat_scores
from fes_mj.fit.seats import OUTSIDE_EQUAL, SEAT_LIMITS, SeatLimits, Seats, losses, outside_range
from fes_mj.linkage.design import Design
from fes_mj.linkage.riders import PEOPLE_PER_SEX, Legs, Population, populations
from fes_mj.linkage.variables import crank_speed
from fes_mj.moments.joint_moments import JointMoments
from fes_mj.statics.cycles import cycles
from fes_mj.statics.validity import obstacles
from fes_mj.statics.work_table import WorkTable

SEATS = ("unmoved", "fitted")
GRADES = ("turns", "share", "inside")
PEOPLE = {"men": "man", "women": "woman"}
# Thighs and shanks for which the best seat is sought; a person in between tries those of the four nearest, and one
# between these; what that and the shorter search at the nodes lose is PopulationFit.map_error.
_NODES, _GENERATIONS = 7, (20, 27, 30)
_PROBES = 5  # people of each sex whose seat is sought as well, for what that loses
_FINE = 61  # thighs and shanks of the map of the seat as drawn
_MARGIN = 1e-6  # m, so that the extreme people are inside the map
_DRAWN = Seats(0.0, 0.0, 0.0)


class PowerMap(NamedTuple):
    """Power over thigh and shank (m), W, shape (thighs, shanks); NaN where nobody can ride."""

    thigh: FloatArray
    shank: FloatArray
    power: FloatArray


class Ridden(NamedTuple):
    """What becomes of riders in their seats, shape (riders,) each.

    turns: whether the linkage turns. power: W of one leg, NaN for who cannot ride: a joint never enters the moments'
    range. outside: deg by which joints leave that range, NaN without a turn.
    """

    turns: BoolArray
    power: FloatArray
    outside: FloatArray

    @property
    def grades(self) -> dict[str, BoolArray]:
        """Who comes how far, by GRADES: the linkage turns, there is power, joints stay inside the moments' range."""
        rides = np.isfinite(self.power)
        inside = rides & (self.outside <= OUTSIDE_EQUAL)
        return dict(zip(GRADES, (self.turns, rides, inside), strict=True))


class FittedPeople(NamedTuple):
    """A sample of people, and what becomes of them with the seat as drawn and with the best seat."""

    people: Population
    legs: Legs
    unmoved: Ridden
    fitted: Ridden


@dataclass(frozen=True, repr=False)
class PopulationFit(Brief):
    """How a design, with the seat as drawn and with the best one for each, suits a sample of "men" and of "women".

    drawn, map: with the seat as drawn and with the best one. map_error: largest difference of a person's power to that
    in a seat sought for the very person, W.
    """

    design: Design
    moments: JointMoments
    drawn: PowerMap
    map: PowerMap
    riders: dict[str, FittedPeople]
    map_error: float

    @property
    def brief(self) -> str:
        shares = (
            f"{100 * np.mean(riders.fitted.grades['share']):.0f} % of {who}" for who, riders in self.riders.items()
        )
        return f"{self.design.name} {self.moments.name}: {', '.join(shares)} can ride"

    def summary(self) -> dict[str, Any]:
        """The result as JSON names and units it."""
        size = len(next(iter(self.riders.values())).legs.thigh)
        content: dict[str, Any] = {"design": self.design.name, "group": self.moments.name, "samples": size}
        for seat in SEATS:
            ridden = {who: getattr(riders, seat) for who, riders in self.riders.items()}
            riding = {who: result.power[result.grades["share"]] for who, result in ridden.items()}
            for grade in GRADES:
                content[f"{grade}_{seat}"] = {who: float(result.grades[grade].mean()) for who, result in ridden.items()}
            for name, statistic in (("mean", np.mean), ("p10", lambda power: np.percentile(power, 10))):
                values = {who: float(statistic(power)) if len(power) else None for who, power in riding.items()}
                content[f"power_{name}_{seat}_W"] = values
        return content | {"map_error_W": self.map_error}


FIT_STEPS = _NODES + len(PEOPLE)  # how often fit_population calls `done`


def fit_population(
    design: Design,
    moments: JointMoments,
    *,
    limits: SeatLimits = SEAT_LIMITS,
    samples: int = PEOPLE_PER_SEX,
    seed: int = 0,
    done: Callable[[], None] = lambda: None,
) -> PopulationFit:
    """Sample so many men and women; `done` is called FIT_STEPS times.

    Raises AssemblyError for a linkage that cannot turn whoever sits where, InputError for a cadence that cannot be run,
    a batch, no samples and a negative seed.

    >>> fes_mj.fit_population(fes_mj.load_design("d1"), fes_mj.load_moments("p1p2"), samples=100)
    <PopulationFit d1 p1p2: 100 % of men, 100 % of women can ride>
    """
    crank_speed(design)
    require_within("samples", samples, 1)
    require_within("seed", seed, 0)
    table, random = WorkTable.of(moments), np.random.default_rng(seed)
    legs = {who: populations()[key].sample(samples, random) for who, key in PEOPLE.items()}
    thigh, shank = (
        np.linspace(np.min(lengths) - _MARGIN, np.max(lengths) + _MARGIN, _NODES)
        for lengths in ([people.thigh for people in legs.values()], [people.shank for people in legs.values()])
    )
    rows = []
    for length in thigh:
        rows.append(np.column_stack(best_seats(design, np.full(_NODES, length), shank, table, limits, _GENERATIONS)[0]))
        done()
    seats, riders, errors = np.stack(rows), {}, []
    for who, people in legs.items():
        offered = _offered(people, thigh, shank, seats)
        offered[:, 0] = [min(max(0.0, low), high) for low, high in limits]
        chosen = _chosen(design, people, offered, table)
        riders[who] = FittedPeople(
            populations()[PEOPLE[who]],
            people,
            _ridden(design, people.thigh, people.shank, _DRAWN, table),
            _ridden(design, people.thigh, people.shank, chosen, table),
        )
        probes = slice(0, _PROBES)
        searched = best_seats(design, people.thigh[probes], people.shank[probes], table, limits)[1].power
        errors.append(riders[who].fitted.power[probes] - searched)
        done()
    fine = [np.linspace(axis[0], axis[-1], _FINE) for axis in (thigh, shank)]
    return PopulationFit(
        design,
        moments,
        _map(design, fine[0], fine[1], _DRAWN, table),
        _map(design, thigh, shank, Seats(*seats.reshape(-1, 3).T), table),
        riders,
        float(np.nanmax(np.abs(errors), initial=0.0)),
    )


def _offered(people: Legs, thigh: FloatArray, shank: FloatArray, seats: FloatArray) -> FloatArray:
    """Seats that people try, shape (people, 6, 3): as drawn, those of the four nearest nodes, and one between these.

    seats: the best at the nodes, shape (thighs, shanks, 3).
    """
    places = [
        (lengths - nodes[0]) / (nodes[1] - nodes[0])
        for lengths, nodes in ((people.thigh, thigh), (people.shank, shank))
    ]
    (row, column), (down, right) = zip(*((place.astype(int), place % 1) for place in places), strict=True)
    corners, weights = [], []
    for below, beside in ((0, 0), (0, 1), (1, 0), (1, 1)):
        corners.append(seats[row + below, column + beside])
        weights.append(np.where(below, down, 1 - down) * np.where(beside, right, 1 - right))
    between = np.einsum("cp,cps->ps", weights, corners)
    return np.stack([np.zeros_like(between), *corners, between], axis=1)


def _chosen(design: Design, people: Legs, offered: FloatArray, table: WorkTable) -> Seats:
    """The best of the seats that people try, the first of which is as drawn; in none do they get farther outside."""
    scores = seat_scores(design, np.column_stack([people.thigh, people.shank]), offered, table)
    more = scores.outside[:, :1] - scores.outside.min(axis=1, keepdims=True)
    best = losses(scores, scores, outside_slack=np.minimum(more, OUTSIDE_EQUAL)).argmin(axis=1)
    return Seats(*offered[np.arange(len(best)), best].T)


def _ridden(design: Design, thigh: FloatArray, shank: FloatArray, seats: Seats, table: WorkTable) -> Ridden:
    """What becomes of riders in these seats, shape (riders,) each."""
    moved = Seats(*(np.broadcast_to(move, thigh.shape)[:, None] for move in seats))
    turn = cycles(moved.moved(design.with_rider(thigh=thigh[:, None], shank=shank[:, None])), table)
    cadence = np.full(thigh.shape, design.linkage.cadence)
    valid = ~np.any([obstacle.hindered for obstacle in obstacles(turn, cadence)], axis=0)
    power = np.where(valid, turn.power(cadence)[:, 0], np.nan)
    return Ridden(turn.turns, power, np.where(turn.turns, outside_range(turn), np.nan))


def _map(design: Design, thigh: FloatArray, shank: FloatArray, seats: Seats, table: WorkTable) -> PowerMap:
    """The power of riders with all these thighs and shanks in their seats, of each pair or of all."""
    thighs, shanks = (axis.ravel() for axis in np.meshgrid(thigh, shank, indexing="ij"))
    power = _ridden(design, thighs, shanks, seats, table).power
    return PowerMap(thigh, shank, power.reshape(len(thigh), len(shank)))
