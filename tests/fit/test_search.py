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
FINE, CLOUD, ROUNDS, SHRINK = (36, 31, 41), 400, 12, 0.75
SHORTER = 0.002  # m, by which a way may be shorter that the search has not found


@pytest.mark.long
@pytest.mark.parametrize("case", range(50))
def test_no_seat_of_a_fine_grid_is_better(case: int) -> None:
    """Random riders; designs of the paper, from the tenth case on with another crank and foot."""
    random = np.random.default_rng(100 + case)
    design, table = fes_mj.load_design(DESIGNS[case % 5]), TABLES[str(random.choice([*TABLES]))]
    if case >= 10:
        linkage = design.linkage
        crank, foot = linkage.crank * random.uniform(0.8, 1.05), linkage.foot + random.uniform(-0.02, 0.02)
        design = design.with_linkage(crank=crank, foot=foot)
    thigh, shank = random.uniform(0.36, 0.54), random.uniform(0.44, 0.58)
    seats, found = best_seats(design, [thigh], [shank], table)
    known = _tried(design.with_rider(thigh=thigh, shank=shank), table, random)
    known = Scores(*(np.concatenate(columns) for columns in zip(known, found, strict=True)))
    within = known.outside <= known.outside.min() + OUTSIDE_EQUAL
    strong = within & (known.power >= known.power[within].max() - POWER_EQUAL)
    assert found.outside[0] <= known.outside.min() + OUTSIDE_EQUAL
    assert found.power[0] >= known.power[within].max() - POWER_EQUAL
    assert found.distance[0] <= known.distance[strong].min() + SHORTER
    assert found.distance[0] == Seats(*(float(move[0]) for move in seats)).distance


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
        centres = [known.outside.argmin(), power.argmax(), ways[0].argmin(), *np.argsort(ways[1])[:5]]
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
