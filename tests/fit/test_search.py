"""The seats that are found against every seat of a fine grid: none is better by range, then power, then way."""

import numpy as np
import pytest

import fes_mj
from fes_mj.fit.search import best_seats
from fes_mj.fit.seats import SEAT_LIMITS, Scores, Seats, score
from fes_mj.linkage.design_file import DESIGNS
from fes_mj.statics.work_table import WorkTable

TABLES = {group: WorkTable.of(fes_mj.load_moments(group)) for group in ("p1p2", "p1p3")}
OUTSIDE_EQUAL, POWER_EQUAL = 0.1, 0.01  # deg, W: what counts as equal
FINE, CLOUD, ROUNDS, SHRINK = (36, 31, 41), 400, 24, 0.85
SHORTER = 0.002  # m, by which a way may be shorter that the search has not found


@pytest.mark.long
@pytest.mark.parametrize("case", range(17))
def test_no_seat_of_a_fine_grid_is_better(case: int) -> None:
    """51 random riders; designs of the paper, from the sixth case on with another crank and foot."""
    random = np.random.default_rng(100 + case)
    design, table = fes_mj.load_design(DESIGNS[case % 5]), TABLES[str(random.choice([*TABLES]))]
    if case >= 5:
        linkage = design.linkage
        crank, foot = linkage.crank * random.uniform(0.8, 1.05), linkage.foot + random.uniform(-0.02, 0.02)
        design = design.with_linkage(crank=crank, foot=foot)
    thigh, shank = random.uniform(0.36, 0.54, 3), random.uniform(0.44, 0.58, 3)
    seats, found = best_seats(design, thigh, shank, table)
    assert found.distance == pytest.approx(seats.distance)
    for rider, best in enumerate(zip(*found, strict=True)):
        tried = _tried(design.with_rider(thigh=thigh[rider], shank=shank[rider]), table, random)
        known = Scores(*(np.append(column, value) for column, value in zip(tried, best, strict=True)))
        outside, power, distance = best
        within = known.outside <= known.outside.min() + OUTSIDE_EQUAL
        strong = within & (known.power >= known.power[within].max() - POWER_EQUAL)
        assert outside <= known.outside.min() + OUTSIDE_EQUAL
        assert power >= known.power[within].max() - POWER_EQUAL
        assert distance <= known.distance[strong].min() + SHORTER


def _tried(design: fes_mj.Design, table: WorkTable, random: np.random.Generator) -> Scores:
    """Of a grid, and of clouds that close in on its best by each aim and on the shortest ways to nearly its power."""
    low, high = (np.array(ends) for ends in zip(*SEAT_LIMITS, strict=True))
    axes = [np.linspace(*ends, count) for ends, count in zip(SEAT_LIMITS, FINE, strict=True)]
    seats = np.vstack([np.zeros((1, 3)), np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)])
    known, width = _scores(design, seats, table), (high - low) / FINE
    for _ in range(ROUNDS):
        within = known.outside <= known.outside.min() + OUTSIDE_EQUAL
        power = np.where(within, known.power, -1e9)
        ways = [np.where(power >= power.max() - slack, known.distance, 1.0) for slack in (POWER_EQUAL, 0.1)]
        centres = [known.outside.argmin(), *np.argsort(power)[-4:], ways[0].argmin(), *np.argsort(ways[1])[:5]]
        cloud = np.vstack([seats[centre] + width * random.standard_normal((CLOUD, 3)) for centre in centres])
        more = _scores(design, cloud := np.clip(cloud, low, high), table)
        seats, width = np.vstack([seats, cloud]), SHRINK * width
        known = Scores(*(np.concatenate(columns) for columns in zip(known, more, strict=True)))
    return known


def _scores(design: fes_mj.Design, seats: np.ndarray, table: WorkTable) -> Scores:
    blocks = np.array_split(seats, max(1, len(seats) // 10_000))
    parts = [score(design, Seats(*block.T[..., None]), table) for block in blocks]
    return Scores(*(np.concatenate(columns) for columns in zip(*parts, strict=True)))


def test_several_riders_are_fitted_as_well_as_each_alone() -> None:
    design, table = fes_mj.load_design("d1"), TABLES["p1p2"]
    thigh, shank = [0.38, 0.44], [0.50, 0.55]
    together = best_seats(design, thigh, shank, table)[1]
    for rider in (0, 1):
        alone = best_seats(design, thigh[rider : rider + 1], shank[rider : rider + 1], table)[1]
        assert together.power[rider] == pytest.approx(alone.power[0], abs=2 * POWER_EQUAL)
        assert together.distance[rider] == pytest.approx(alone.distance[0], abs=SHORTER)
