"""The ripple of a population against that of a ride, designs found within a limit on it, and the crank's energy."""

from dataclasses import replace

import numpy as np
import pytest

import fes_mj
from fes_mj.linkage.design_file import SIX_BARS
from fes_mj.optimization.evenness import RippleLimit, fluctuation
from fes_mj.optimization.optimize import run_searches
from fes_mj.riding.ride import Ride, balancing_slope, steady_ripple
from fes_mj.riding.trace import ride
from fes_mj.statics.turn import quasi_static
from tests.optimization.conftest import problem_of

MOMENTS = fes_mj.load_moments("p1p2")
LIMIT = RippleLimit(0.08, MOMENTS)


@pytest.mark.parametrize("name", SIX_BARS)
def test_the_ripple_of_a_population_is_that_of_each_design(name: str) -> None:
    """From 120 angles instead of 5,400: by trapezoids, each of which is off where the moments jump by at most half a
    step of 3 deg: a hundredth of the swing of a leg's energy, whose thrust lasts a third of a turn.
    """
    problem = replace(problem_of(name), ripple=LIMIT)
    x = problem.variables(problem.template) + np.random.default_rng(0).uniform(-0.003, 0.003, (200, 10))
    evaluation = problem.evaluate(x)
    column = [constraint.name for constraint in problem.constraints].index("speed_ripple")
    rows = np.flatnonzero(np.isfinite(evaluation.values[:, column]))[:8]
    assert len(rows)
    for row in rows:
        own = steady_ripple(Ride(problem.design(evaluation.x[row], "one"), MOMENTS, transmission="fixed"))
        assert evaluation.values[row, column] == pytest.approx(own, rel=0.01)


def test_a_limit_on_the_ripple_takes_nothing_away_but_what_is_above_it() -> None:
    problem = problem_of("d1")
    limited = replace(problem, ripple=replace(LIMIT, limit=0.16))
    x = problem.variables(problem.template) + np.random.default_rng(0).uniform(-0.003, 0.003, (300, 10))
    without, within = problem.evaluate(x), limited.evaluate(x)
    np.testing.assert_array_equal(without.power, within.power)
    ripple = within.values[:, -1]
    assert np.isfinite(ripple[without.feasible]).all()
    np.testing.assert_array_equal(within.feasible, without.feasible & (ripple <= 0.16))
    assert 0 < within.feasible.sum() < without.feasible.sum()


@pytest.mark.long
def test_what_is_found_within_the_limit_rides_as_evenly_on_a_road() -> None:
    """By the equation of motion, on the slope that takes the mean power; air and friction vary a little with speed."""
    pytest.importorskip("cma")
    problem = replace(problem_of("d1", grashof_min=0.005), ripple=LIMIT)
    design = problem.design(run_searches(problem, "cma-es", budget=8000, seed=1)[0].x, "even")
    level = Ride(design, MOMENTS, transmission="fixed", duration=10.0)
    assert steady_ripple(level) < 1.01 * LIMIT.limit
    slope = balancing_slope(level)
    trace = ride(replace(level, road=replace(level.road, slope=slope)))
    speed = trace.crank_speed[trace.last_turns]
    assert np.ptp(speed) / speed.mean() == pytest.approx(steady_ripple(level), rel=0.05)


def test_fluctuation_of_a_known_curve(moments: fes_mj.JointMoments) -> None:
    """Against the surplus of two legs summed the slow way."""
    design = fes_mj.load_design("d1")
    curve = quasi_static(design, moments, points=360).crank_moment
    crank = [curve[i] + curve[(i + 180) % 360] for i in range(360)]
    mean, surplus, low, high = sum(crank) / 360, 0.0, 0.0, 0.0
    for value in crank:
        surplus += value - mean
        low, high = min(low, surplus), max(high, surplus)
    assert fluctuation(design, moments)[0] == pytest.approx((high - low) / (360 * mean), rel=1e-9)
