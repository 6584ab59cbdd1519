"""Error bars of power differences, against the posterior used directly."""

import numpy as np
import pytest

import fes_mj
from fes_mj.optimization.confidence import gain, posterior, uncertain_table
from fes_mj.optimization.cycles import cycles
from fes_mj.optimization.optimize import optimize
from fes_mj.optimization.problem import Problem
from fes_mj.optimization.winner import gain_over
from fes_mj.paper.evidence import power_weights
from fes_mj.paper.reconstruction import fourier
from tests.optimization.test_problem import problem_of

GROUPS = ("p1p2", "p1p3")


@pytest.mark.parametrize("group", GROUPS)
def test_mean_and_deviation_are_those_of_the_posterior(design: fes_mj.Design, group: str) -> None:
    power = cycles(design, uncertain_table(group)).work[0] * design.linkage.cadence / (2 * np.pi)
    mean, deviation = posterior(group).predict(power_weights(design, fourier))
    assert power[0] == pytest.approx(mean, rel=1e-4)
    assert np.linalg.norm(power[1:]) == pytest.approx(deviation, rel=1e-3)


@pytest.mark.parametrize("group", GROUPS)
def test_the_error_of_a_gain_knows_that_powers_are_correlated(group: str) -> None:
    better, worse = fes_mj.load_design("d2"), fes_mj.load_design("d1")
    found = gain_over(better, worse, group)
    weights = power_weights(better, fourier) - power_weights(worse, fourier)
    mean, deviation = posterior(group).predict(weights)
    assert found.mean == pytest.approx(mean, rel=1e-3)
    assert found.deviation == pytest.approx(deviation, rel=1e-2)
    alone = [posterior(group).predict(power_weights(each, fourier))[1] for each in (better, worse)]
    assert abs(found.deviation - np.hypot(*alone)) > 0.01 * found.deviation


def test_a_gain_over_oneself_is_certain() -> None:
    power = np.array([30.0, 0.4, -0.2])
    assert gain(power, power) == (0.0, 0.0)


def test_caution_trades_gain_for_certainty() -> None:
    pytest.importorskip("cma")
    table, base = uncertain_table("p1p3"), problem_of("d2", grashof_min=0.005)
    found = []
    for caution in (0.0, 2.0):
        own = fes_mj.load_design("d2")
        baseline = cycles(own, table).work[0] * own.linkage.cadence / (2 * np.pi)
        problem = Problem(own, table, base.limits, base.knee_speed, base.hip_speed, caution, baseline)
        x = optimize(problem, "cma-es", budget=6000, seed=4)[0].x
        found.append(gain(problem.evaluate(x[None]).power[0], baseline))
    assert found[1].deviation < found[0].deviation
    assert found[1].mean > 2 * found[1].deviation
