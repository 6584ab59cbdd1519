"""The front and its objectives."""

from dataclasses import replace

import numpy as np
import pytest

import fes_mj
from fes_mj.optimization.pareto import fluctuation, pareto_front
from fes_mj.statics.turn import quasi_static
from tests.optimization.conftest import problem_of


def test_the_front_is_feasible_and_nobody_on_it_is_dominated() -> None:
    pytest.importorskip("pymoo")
    from fes_mj.statics.cycles import WorkTable

    both = tuple(fes_mj.load_moments(group) for group in ("p1p2", "p1p3"))
    problem = replace(problem_of("d1"), table=WorkTable.of(*both))
    seen: list[list[float]] = []
    front = pareto_front(
        problem, both, budget=5000, seed=1, smooth=True, improved=lambda x, power: seen.append([power, *x])
    )
    assert problem.evaluate(front.x).feasible.all()
    assert front.fluctuation is not None
    goals = np.column_stack([front.power, -front.fluctuation])
    better = np.all(goals[:, None] >= goals, axis=2) & np.any(goals[:, None] > goals, axis=2)
    assert not better.any()
    assert len(front.x) > 10
    powers = [power for power, *_ in seen]
    assert powers == sorted(powers)
    top = int(np.argmax(front.power.mean(axis=1)))
    np.testing.assert_allclose([front.power[top].mean(), *front.x[top]], seen[-1], rtol=1e-12)


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
