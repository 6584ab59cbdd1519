"""One call for every method: seeds, budgets and processes."""

import numpy as np
import pytest

from fes_mj.optimization.optimize import METHODS, optimize
from tests.optimization.conftest import problem_of


@pytest.mark.parametrize("method", METHODS)
def test_a_seed_gives_the_same_design_and_the_budget_holds(method: str) -> None:
    if method == "cma-es":
        pytest.importorskip("cma")
    problem = problem_of("r1")
    first, again = (optimize(problem, method, searches=2, budget=9000, seed=7) for _ in range(2))
    assert [result.merit for result in first] == [result.merit for result in again]
    assert np.array_equal(first[0].x, again[0].x)
    assert all(result.evaluations == 9000 for result in first)
    merits = [result.merit for result in first]
    assert merits == sorted(merits, reverse=True)
    assert problem.evaluate(first[0].x[None]).feasible[0]


def test_processes_find_the_same_design() -> None:
    pytest.importorskip("joblib")
    from fes_mj.common.parallel import Workers

    problem = problem_of("d1")
    serial = optimize(problem, "differential-evolution", searches=2, budget=2000, seed=1)
    parallel = optimize(problem, "differential-evolution", searches=2, budget=2000, seed=1, workers=Workers(jobs=2))
    assert [result.merit for result in serial] == [result.merit for result in parallel]
