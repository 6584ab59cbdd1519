"""Error bars of power differences, against the quadratic form in the covariance of the moments."""

import numpy as np
import pytest

import fes_mj
from fes_mj.common.errors import InputError
from fes_mj.optimization.confidence import gain
from fes_mj.optimization.optimize import optimize
from fes_mj.optimization.problem import Problem
from fes_mj.statics.cycles import cycles, uncertain_table
from fes_mj.statics.turn import difference_sd
from tests.optimization.conftest import problem_of

GROUPS = ("p1p2", "p1p3")


def powers(design: fes_mj.Design, group: str) -> np.ndarray:
    """Mean power and its deviations, W, by the table."""
    table = uncertain_table(fes_mj.load_moments(group))
    return cycles(design, table).work[0] * design.linkage.cadence / (2 * np.pi)


@pytest.mark.parametrize("group", GROUPS)
def test_mean_and_deviation_are_those_of_statics(design: fes_mj.Design, group: str) -> None:
    static, power = fes_mj.quasi_static(design, fes_mj.load_moments(group)), powers(design, group)
    assert power[0] == pytest.approx(static.power_mean, rel=1e-4)
    assert np.linalg.norm(power[1:]) == pytest.approx(static.power_sd, rel=1e-3)


@pytest.mark.parametrize("group", GROUPS)
def test_the_error_of_a_gain_knows_that_powers_are_correlated(group: str) -> None:
    better, worse = (fes_mj.quasi_static(fes_mj.load_design(name), fes_mj.load_moments(group)) for name in ("d2", "d1"))
    found = gain(powers(better.design, group), powers(worse.design, group))
    assert found.mean == pytest.approx(better.power_mean - worse.power_mean, rel=1e-3)
    assert found.deviation == pytest.approx(difference_sd(better, worse), rel=1e-2)
    uncorrelated = np.hypot(better.power_sd, worse.power_sd)
    assert abs(found.deviation - uncorrelated) > 0.01 * found.deviation


def test_a_gain_over_oneself_is_certain() -> None:
    power = np.array([30.0, 0.4, -0.2])
    assert gain(power, power) == (0.0, 0.0)


def test_own_moments_have_no_known_error(smooth_moments: fes_mj.JointMoments) -> None:
    with pytest.raises(InputError, match="smooth: nothing is known of the error"):
        uncertain_table(smooth_moments)


def test_caution_trades_gain_for_certainty() -> None:
    pytest.importorskip("cma")
    table, base = uncertain_table(fes_mj.load_moments("p1p3")), problem_of("d2", grashof_min=0.005)
    found = []
    for caution in (0.0, 2.0):
        own = fes_mj.load_design("d2")
        baseline = cycles(own, table).work[0] * own.linkage.cadence / (2 * np.pi)
        problem = Problem(own, table, base.limits, base.joint_speed, caution, baseline)
        x = optimize(problem, "cma-es", budget=6000, seed=4)[0].x
        found.append(gain(problem.evaluate(x[None]).power[0], baseline))
    assert found[1].deviation < found[0].deviation
    assert found[1].mean > 2 * found[1].deviation
