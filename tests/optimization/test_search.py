"""What all methods share: a start that is feasible, and words for what is not."""

from dataclasses import replace

import numpy as np
import pytest

import fes_mj
from fes_mj.optimization.optimize import optimize
from fes_mj.optimization.search import Search, feasible_start
from tests.optimization.conftest import problem_of


def test_random_starts_are_feasible_and_different() -> None:
    problem, random = problem_of("d2"), np.random.default_rng(0)
    searches = [Search(problem, 10**6) for _ in range(3)]
    starts = np.array([feasible_start(search, random) for search in searches])
    assert all(1 < search.evaluations < 10**6 for search in searches)
    assert problem.evaluate(starts).feasible.all()
    assert np.ptp(starts, axis=0).min() > 0.001


def test_an_empty_feasible_set_is_said_to_be_one() -> None:
    problem = problem_of("r1")
    impossible = replace(problem, limits=replace(problem.limits, knee_deg=(69.0, 70.0), crank_min=0.2))
    with pytest.raises(fes_mj.InputError, match=r"no feasible crt found in \d+ evaluations; the closest violates: "):
        optimize(impossible, "differential-evolution", budget=2000)


def test_an_infeasible_start_is_refused_by_name() -> None:
    problem = problem_of("d1")
    start = problem.variables(problem.template)
    start[2] = 0.5
    with pytest.raises(fes_mj.InputError, match=r"the start d1 is not feasible: .*grashof is -0.\d+ m \(limit 0"):
        optimize(problem, "random-pursuit", start=start)
