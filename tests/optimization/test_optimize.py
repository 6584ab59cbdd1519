"""One call for every method: seeds, budgets and processes."""

from contextlib import AbstractContextManager, nullcontext

import numpy as np
import pytest

import fes_mj
from fes_mj.common.parallel import Workers
from fes_mj.optimization.optimize import METHODS, Advance, optimize, run_searches
from fes_mj.optimization.problem import make_problem
from tests.optimization.conftest import problem_of

QUICK = "random-pursuit"


@pytest.mark.parametrize(
    "method", [pytest.param(method, marks=() if method == QUICK else pytest.mark.long) for method in METHODS]
)
def test_a_seed_gives_the_same_design_and_the_budget_holds(method: str) -> None:
    if method == "cma-es":
        pytest.importorskip("cma")
    problem = problem_of("r1")
    first, again = (run_searches(problem, method, searches=2, budget=5000, seed=7) for _ in range(2))
    assert [result.merit for result in first] == [result.merit for result in again]
    assert np.array_equal(first[0].x, again[0].x)
    assert all(result.evaluations == 5000 for result in first)
    merits = [result.merit for result in first]
    assert merits == sorted(merits, reverse=True)
    assert problem.evaluate(first[0].x[None]).feasible[0]


def test_one_call_is_the_search_of_the_problem() -> None:
    moments = fes_mj.load_moments("p1p2")
    optimum = optimize("crt", moments, budget=1000, searches=2, seed=2, knee_speed=100.0)
    problem = make_problem("crt", moments, knee_speed=100.0)
    best = run_searches(problem, "differential-evolution", budget=1000, searches=2, seed=2)[0]
    assert np.array_equal(optimum.x, best.x)
    assert optimum.feasible
    assert optimum.violations == []
    assert optimum.evaluations == 2000
    assert optimum.power == pytest.approx(fes_mj.quasi_static(optimum.design, moments).power_mean, rel=1e-4)
    with pytest.raises(TypeError, match="budgte"):
        optimize("crt", moments, budgte=6000)


@pytest.mark.process
def test_processes_find_the_same_design() -> None:
    pytest.importorskip("joblib")
    from fes_mj.common.parallel import Workers

    problem = problem_of("d1")
    serial = run_searches(problem, "differential-evolution", searches=2, budget=2000, seed=1)
    parallel = run_searches(problem, "differential-evolution", searches=2, budget=2000, seed=1, workers=Workers(jobs=2))
    assert [result.merit for result in serial] == [result.merit for result in parallel]


@pytest.mark.parametrize("jobs", [1, pytest.param(2, marks=pytest.mark.process)])
def test_progress_counts_the_evaluations_of_all_searches(jobs: int) -> None:
    """In this process as they are made, elsewhere when a search is through; at the end all of them."""
    told: list[int] = []

    def opened(total: int) -> AbstractContextManager[Advance]:
        assert total == 2000
        return nullcontext(told.append)

    fes_mj.optimize("crt", fes_mj.load_moments("p1p2"), budget=1000, searches=2, workers=Workers(jobs), progress=opened)
    assert sum(told) == 2000
    assert (max(told) < 1000) == (jobs == 1)
