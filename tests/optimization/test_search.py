"""What all methods share, random pursuit as the paper describes it, and evolution beside it."""

from contextlib import suppress
from dataclasses import replace

import numpy as np
import pytest

import fes_mj
from fes_mj.linkage.design_file import SIX_BARS
from fes_mj.optimization.optimize import run_searches
from fes_mj.optimization.problem import make_problem
from fes_mj.optimization.search import (
    TRIAL_STEP,
    BudgetSpentError,
    Search,
    differential,
    feasible_start,
    random_pursuit,
)
from fes_mj.statics.turn import quasi_static
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
    with pytest.raises(fes_mj.InputError, match=r"crt .*\d+ evaluations.*: "):
        run_searches(impossible, "differential-evolution", budget=2000)


@pytest.mark.parametrize("name", SIX_BARS)
def test_random_pursuit_never_gets_worse_and_stays_feasible(name: str) -> None:
    problem = problem_of(name)
    start = problem.variables(problem.template)
    own = float(problem.evaluate(start[None]).power[0, 0])
    search = Search(problem, 50_000)
    with suppress(BudgetSpentError):
        random_pursuit(search, start, np.random.default_rng(3), patience=200)
    result = search.result()
    assert result.merit >= own
    assert problem.evaluate(result.x[None]).feasible[0]
    assert np.all(np.diff(result.history[:, 1]) > 0)
    assert np.all(np.diff(result.history[:, 0]) > 0)


class Recorder(Search):
    """A search that keeps what was counted."""

    def note(self, x: np.ndarray, merit: np.ndarray) -> None:
        self.seen = [*getattr(self, "seen", []), *zip(x, merit, strict=True)]
        super().note(x, merit)


def test_random_pursuit_is_the_one_at_a_time_method() -> None:
    """Replayed trial by trial: each lies within a step of the best so far, and it stops by the paper's rule."""
    problem, patience = problem_of("d1"), 40
    search = Recorder(problem, 10**6)
    random_pursuit(search, problem.variables(problem.template), np.random.default_rng(5), patience)
    best_x, best = search.seen[0]
    failures, improvements = 0, 0
    for x, merit in search.seen[1:]:
        assert failures < patience, "it should have stopped"
        assert np.abs(x - best_x).max() <= TRIAL_STEP
        if merit > best:
            best_x, best, failures, improvements = x, merit, 0, improvements + 1
        elif problem.evaluate(x[None]).feasible[0]:
            failures += 1
    assert failures == patience
    assert improvements > 5
    assert search.evaluations == len(search.seen)
    assert search.best == best


class Thorough(Search):
    """A search that computes everything of every design."""

    def __call__(self, x: np.ndarray, to_beat: object = None) -> np.ndarray:
        return super().__call__(x)


def test_evolution_finds_the_same_without_what_takes_long_of_designs_that_lose(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of a limit that some keep; a stand-in for the forces and clearances counts the designs."""
    looked_at = [0]

    def crank(designs: fes_mj.Design, within: np.ndarray, *_: object) -> np.ndarray:
        looked_at[0] += int(within.sum())
        values = 1e4 * np.broadcast_to(designs.linkage.crank, (designs.size, 1))
        return np.where(within[:, None], np.hstack([values, np.ones_like(values)]), np.nan)

    monkeypatch.setattr("fes_mj.optimization.problem.slow_values", crank)
    problem = make_problem("trt", fes_mj.load_moments("p1p2"))
    results, counts = [], []
    for kind in (Search, Thorough):
        looked_at[0], search = 0, kind(problem, 2000)
        with suppress(BudgetSpentError):
            differential(search, None, np.random.default_rng(3))
        results.append(search.result())
        counts.append(looked_at[0])
    assert np.array_equal(results[0].x, results[1].x)
    assert np.array_equal(results[0].history, results[1].history)
    assert counts[0] < 0.6 * counts[1]


def test_evolution_beats_the_printed_design_within_the_same_limits() -> None:
    problem = problem_of("d2", grashof_min=0.005)
    own = float(problem.evaluate(problem.variables(problem.template)[None]).power[0, 0])
    result = run_searches(problem, "differential-evolution", budget=8000, seed=1)[0]
    design = problem.design(result.x, "found")
    static = quasi_static(design, fes_mj.load_moments("p1p2"))
    assert static.power_mean == pytest.approx(result.merit, rel=1e-4)
    assert result.merit > own + 1.0
