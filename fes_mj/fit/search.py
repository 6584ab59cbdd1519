"""The best seats of many riders at once, by differential evolution on the range, then the power, then the way."""

from collections.abc import Sequence

import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.fit.seats import POWER_EQUAL, SEAT_LIMITS, Scores, SeatLimits, Seats, losses, score
from fes_mj.linkage.assembly import LEAST_CLEARANCE, grashof_margin
from fes_mj.linkage.design import Design
from fes_mj.linkage.turning import turning
from fes_mj.statics.work_table import WorkTable

# Seats tried for a rider: a grid over the limits, then generations of a population on each of the three aims. On the
# last one powers that count as equal narrow from the first of _SLACK to POWER_EQUAL, so that the population can follow
# the curved ridge on which they lie; tests/fit/test_search.py has what that leaves against every seat of a fine grid.
_GRID, _POPULATION, GENERATIONS = (9, 7, 5), 40, (60, 80, 90)
_SLACK, _NARROWING = 1.0, 0.6  # W, and the share of the generations in which it narrows
_STEP = np.array([1e-5, 1e-5, np.radians(0.001)])  # finer than a seat can be set: m, m, rad
_AT_ONCE = 20_000  # turns in memory


def best_seats(
    design: Design,
    thigh: Sequence[float] | FloatArray,
    shank: Sequence[float] | FloatArray,
    table: WorkTable,
    limits: SeatLimits = SEAT_LIMITS,
    generations: Sequence[int] = GENERATIONS,
) -> tuple[Seats, Scores]:
    """The best seat for each of several riders, with thigh and shank in m; shape (riders,) each.

    The seat as drawn is tried where the limits allow it. generations: of the search on each of the three aims. Raises
    AssemblyError for a linkage that cannot turn whoever sits where.
    """
    if "coupler" in design.linkage.architecture.bodies and grashof_margin(design)[0] < LEAST_CLEARANCE:
        turning(design)
    low, high = (np.array(ends) for ends in zip(*limits, strict=True))
    legs, random = np.column_stack([thigh, shank]), np.random.default_rng(0)

    def scored(seats: FloatArray) -> FloatArray:
        """Seats of each rider, shape (riders, seats, 3), as they can be set within the limits, and their scores below.

        Shape (6, riders, seats).
        """
        settable = np.clip(np.round(seats / _STEP) * _STEP, low, high)
        return np.concatenate([np.moveaxis(settable, -1, 0), seat_scores(design, legs, settable, table)])

    def loss(seats: FloatArray, aim: int = 3, slack: float = POWER_EQUAL) -> FloatArray:
        """Of these beside all that were tried."""
        return losses(Scores(*seats[3:]), Scores(*tried[3:]), aim, slack)

    axes = [np.linspace(*ends, count) for ends, count in zip(limits, _GRID, strict=True)]
    grid = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
    tried = scored(np.broadcast_to(np.vstack([np.zeros((1, 3)), grid]), (len(legs), len(grid) + 1, 3)))
    for aim, count in enumerate(generations if np.any(low < high) else (), 1):  # a fixed seat is found
        order = np.argsort(loss(tried, aim, _SLACK), axis=1, kind="stable")
        population = np.take_along_axis(tried, order[None, :, :_POPULATION], axis=2)
        for generation in range(count):
            slack = _SLACK * (POWER_EQUAL / _SLACK) ** min(1.0, generation / (_NARROWING * count))
            trial = scored(_mutants(np.moveaxis(population[:3], 0, -1), loss(population, aim, slack), random))
            tried = np.concatenate([tried, trial], axis=2)
            population = np.where(loss(trial, aim, slack) <= loss(population, aim, slack), trial, population)
    best = np.take_along_axis(tried, loss(tried).argmin(axis=1)[None, :, None], axis=2)[..., 0]
    return Seats(*best[:3]), Scores(*best[3:])


def _mutants(population: FloatArray, loss: FloatArray, random: np.random.Generator) -> FloatArray:
    """A trial for every member: the best or another, and the scaled difference of two more, crossed with the member."""
    riders, members, _ = population.shape
    everyone = np.broadcast_to(np.arange(members), (riders, members))
    one, other, base = (
        np.take_along_axis(population, random.permuted(everyone, axis=1)[..., None], axis=1) for _ in range(3)
    )
    best = np.take_along_axis(population, loss.argmin(axis=1)[:, None, None], axis=1)
    shape = (riders, members, 1)
    mutant = np.where(random.random(shape) < 0.5, best, base) + random.uniform(0.4, 1.0, shape) * (one - other)
    return np.where(random.random(population.shape) < 0.1, population, mutant)


def seat_scores(design: Design, legs: FloatArray, seats: FloatArray, table: WorkTable) -> Scores:
    """Of each rider's seats, shape (riders, seats, 3); legs: thigh and shank, shape (riders, 2)."""
    count, parts = seats.shape[1], []
    size = max(1, _AT_ONCE // count)
    for start in range(0, len(legs), size):
        rows = slice(start, start + size)
        thigh, shank = np.repeat(legs[rows], count, axis=0).T[..., None]
        tried = Seats(*seats[rows].reshape(-1, 3).T[..., None])
        parts.append(score(design.with_rider(thigh=thigh, shank=shank), tried, table))
    return Scores(*(np.concatenate(column).reshape(-1, count) for column in zip(*parts, strict=True)))
