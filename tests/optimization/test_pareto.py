"""The front and its objectives."""

from dataclasses import replace

import numpy as np
import pytest

import fes_mj
from fes_mj.optimization.pareto import pareto_front
from tests.optimization.conftest import problem_of


def test_the_front_is_feasible_and_nobody_on_it_is_dominated() -> None:
    pytest.importorskip("pymoo")
    from fes_mj.statics.work_table import WorkTable

    both = tuple(fes_mj.load_moments(group) for group in ("p1p2", "p1p3"))
    problem = replace(problem_of("d1"), table=WorkTable.of(*both))
    seen: list[list[float]] = []
    front = pareto_front(
        problem, both, budget=3000, seed=1, smooth=True, improved=lambda x, power: seen.append([power, *x])
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
