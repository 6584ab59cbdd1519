"""Designs for people: the few who stand for the sample, their seats, and limits that hold for each of them."""

import itertools
from dataclasses import replace

import numpy as np
import pytest

import fes_mj
from fes_mj.fit.search import best_seats
from fes_mj.fit.seat import fit_seat
from fes_mj.fit.seats import SEAT_LIMITS
from fes_mj.linkage.design_file import SIX_BARS
from fes_mj.linkage.riders import populations
from fes_mj.optimization.optimize import run_searches
from fes_mj.optimization.people import ONE_RIDER, STATISTICS, sampled
from fes_mj.optimization.problem import LENGTH_COUNT, Problem
from fes_mj.optimization.search import Search, feasible_start
from tests.optimization.conftest import TABLE, problem_of

MOMENTS = fes_mj.load_moments("p1p2")


def of_people(name: str, statistic: str = "population") -> Problem:
    problem = problem_of(name, grashof_min=0.005)
    speeds = problem.joint_speed.map(lambda speed: 1.5 * speed)
    return replace(problem, joint_speed=speeds, people=sampled(statistic, 200, 0))


def feasible(problem: Problem) -> np.ndarray:
    """Designs that suit everybody, with seats a little off, shape (n, variables)."""
    random = np.random.default_rng(1)
    starts = np.array([feasible_start(Search(problem, 10**6), random) for _ in range(3)])
    x = np.repeat(starts, 200, axis=0)
    x[:, LENGTH_COUNT:-1] += random.uniform(-0.02, 0.02, x[:, LENGTH_COUNT:-1].shape)
    return x


@pytest.mark.long
@pytest.mark.parametrize("name", SIX_BARS)
def test_few_riders_stand_for_a_sample(name: str) -> None:
    """Mean and 10th percentile of the power in best seats, against a seat sought for every other of 80 people.

    A sample of 80 of them is off by chance: by the sample's deviation over the root of 80, for which there is a factor
    of three; the rest is what a plane over the legs can be off.
    """
    design, random = fes_mj.load_design(name), np.random.default_rng(5)
    thigh, shank, _ = np.hstack([people.sample(40, random) for people in populations().values()])
    power = best_seats(design, thigh, shank, TABLE)[1].power
    people = sampled("population", 1000, 0)
    few = np.insert(best_seats(design, *people.others.T, TABLE)[1].power, 0, 0.0)[:, None]
    chance = 3 * power.std() / np.sqrt(len(power))
    assert people.power(few)[0, 0] == pytest.approx(power.mean(), abs=chance + 0.1)
    low = replace(people, statistic="population-p10").power(few)[0, 0]
    assert low == pytest.approx(np.percentile(power, 10), abs=2 * chance + 0.2)


@pytest.mark.parametrize("statistic", STATISTICS)
def test_a_power_that_is_linear_in_the_legs_is_exact(statistic: str) -> None:
    people, random = sampled(statistic, 300, 3), np.random.default_rng(3)
    own = [1.0, 1.0]  # whoever that is: his power does not count
    legs = np.vstack([own, people.others])
    sample = np.hstack([people.sample(300, random) for people in populations().values()])[:2].T
    slope = np.array([7.0, -30.0])
    expected = {"population": np.mean, "population-p10": lambda power: np.percentile(power, 10)}[statistic]
    assert people.power((20 + legs @ slope)[:, None])[0, 0] == pytest.approx(expected(20 + sample @ slope), rel=1e-9)


def test_each_rider_is_within_the_limits_one_at_a_time() -> None:
    """What is feasible for people is what a problem for one finds feasible for each of them, in his seat."""
    problem = of_people("r1")
    evaluation = problem.evaluate(feasible(problem))
    assert 0 < evaluation.feasible.sum() < len(evaluation.x)
    motion = len(problem.geometry)
    # seats that move take the pivots, seen from the hip, out of the space in which they may be drawn
    everywhere = replace(problem.limits, polygon=5 * np.array([-1 - 1j, 1 - 1j, 1 + 1j, -1 + 1j]))
    for row in [*np.flatnonzero(evaluation.feasible)[:5], *np.flatnonzero(~evaluation.feasible)[:5]]:
        designs = problem.riders(evaluation.x[row])
        alone = []
        for design in designs:
            one = replace(problem, template=design, limits=everywhere, people=ONE_RIDER)
            alone.append(one.evaluate(one.variables(design)[None]))
        margins = np.array([own.margins[0, motion:] for own in alone])
        np.testing.assert_allclose(margins.min(axis=0), evaluation.margins[row, motion:], rtol=1e-9, atol=1e-9)
        if evaluation.feasible[row]:
            powers = [fes_mj.quasi_static(design, MOMENTS).power_mean for design in designs]
            expected = problem.people.power(np.array(powers)[:, None])[0, 0]
            assert evaluation.power[row, 0] == pytest.approx(expected, rel=1e-4)


def test_seats_stay_within_the_limits_of_fit_and_the_linkage_stays() -> None:
    problem = of_people("d1")
    x = problem.variables(problem.template)
    x[LENGTH_COUNT:-1] = np.random.default_rng(0).uniform(-1, 1, len(x) - LENGTH_COUNT - 1)
    drawn, *others = problem.riders(x)
    assert drawn == replace(problem.template, name=drawn.name)
    for moved in others:
        shift = moved.linkage.ground - drawn.linkage.ground
        moves = (shift.real, -shift.imag, moved.linkage.seat_angle - drawn.linkage.seat_angle)
        for move, (low, high) in zip(moves, SEAT_LIMITS, strict=True):
            assert low - 1e-12 <= move <= high + 1e-12
        back = replace(moved.linkage, ground=drawn.linkage.ground, seat_angle=drawn.linkage.seat_angle)
        assert back == drawn.linkage


@pytest.mark.long
def test_a_search_finds_a_design_that_suits_people_better() -> None:
    """Within the joint speeds that the printed design gives its own rider; by the seats that `fit` finds afterwards."""
    pytest.importorskip("cma")
    printed = fes_mj.load_design("r1")
    problem = of_people("r1")
    best = run_searches(problem, "cma-es", budget=12_000, seed=1)[0]
    evaluation = problem.evaluate(best.x[None])
    assert evaluation.feasible[0]
    assert evaluation.power[0, 0] == pytest.approx(best.merit)
    winner = problem.design(best.x, "found")
    seated = [fit_seat(winner, person.rider, MOMENTS).static for person in problem.riders(best.x)]
    drawn = [fes_mj.quasi_static(person, MOMENTS) for person in problem.riders(best.x)]
    for fitted, own in itertools.zip_longest(seated, drawn):
        assert fitted
        assert fitted.power_mean > own.power_mean - 0.05
    power = best_seats(printed, *problem.people.others.T, TABLE)[1].power
    assert best.merit > problem.people.power(np.insert(power, 0, 0.0)[:, None])[0, 0]
