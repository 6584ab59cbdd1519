"""Methods: random pursuit as the paper describes it, the others beside it, and what is said when nothing fits."""

from contextlib import suppress
from dataclasses import replace

import numpy as np
import pytest

import fes_mj
from fes_mj.optimization.methods import STEP, random_pursuit
from fes_mj.optimization.optimize import METHODS, optimize
from fes_mj.optimization.pareto import fluctuation, pareto_front
from fes_mj.optimization.search import BudgetSpentError, Search, feasible_start
from fes_mj.optimization.tolerance import to_manufacturing, to_rider
from fes_mj.statics import quasi_static
from tests.optimization.test_problem import SIX_BARS, TABLE, problem_of


@pytest.mark.parametrize("name", SIX_BARS)
def test_random_pursuit_never_gets_worse_and_stays_feasible(name: str) -> None:
    problem = problem_of(name)
    start = problem.variables(problem.template)
    own = float(problem.evaluate(start[None]).power[0, 0])
    search = Search(problem, 50_000)
    with suppress(BudgetSpentError):
        random_pursuit(search, start, np.random.default_rng(3), patience=500)
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
    problem, patience = problem_of("d1"), 100
    search = Recorder(problem, 10**6)
    random_pursuit(search, problem.variables(problem.template), np.random.default_rng(5), patience)
    best_x, best = search.seen[0]
    failures, improvements = 0, 0
    for x, merit in search.seen[1:]:
        assert failures < patience, "it should have stopped"
        assert np.abs(x - best_x).max() <= STEP
        if merit > best:
            best_x, best, failures, improvements = x, merit, 0, improvements + 1
        elif problem.evaluate(x[None]).feasible[0]:
            failures += 1
    assert failures == patience
    assert improvements > 5
    assert search.evaluations == len(search.seen)
    assert search.best == best


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
    from fes_mj.parallel import Workers

    problem = problem_of("d1")
    serial = optimize(problem, "differential-evolution", searches=2, budget=2000, seed=1)
    parallel = optimize(problem, "differential-evolution", searches=2, budget=2000, seed=1, workers=Workers(jobs=2))
    assert [result.merit for result in serial] == [result.merit for result in parallel]


def test_evolution_beats_the_printed_design_within_the_same_limits() -> None:
    problem = problem_of("d2", grashof_min=0.005)
    own = float(problem.evaluate(problem.variables(problem.template)[None]).power[0, 0])
    result = optimize(problem, "differential-evolution", budget=20_000, seed=1)[0]
    design = problem.design(result.x, "found")
    static = quasi_static(design, fes_mj.load_moments("p1p2"))
    assert static.power_mean == pytest.approx(result.merit, rel=1e-4)
    assert result.merit > own + 1.0


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


def test_random_starts_are_feasible_and_different() -> None:
    problem, random = problem_of("d2"), np.random.default_rng(0)
    searches = [Search(problem, 10**6) for _ in range(3)]
    starts = np.array([feasible_start(search, random) for search in searches])
    assert all(1 < search.evaluations < 10**6 for search in searches)
    assert problem.evaluate(starts).feasible.all()
    assert np.ptp(starts, axis=0).min() > 0.001


def test_the_front_is_feasible_and_nobody_on_it_is_dominated() -> None:
    pytest.importorskip("pymoo")
    from fes_mj.cycles import WorkTable

    both = tuple(fes_mj.load_moments(group) for group in ("p1p2", "p1p3"))
    problem = replace(problem_of("d1"), table=WorkTable.of(*both))
    front = pareto_front(problem, both, budget=5000, seed=1, smooth=True)
    assert problem.evaluate(front.x).feasible.all()
    assert front.fluctuation is not None
    goals = np.column_stack([front.power, -front.fluctuation])
    better = np.all(goals[:, None] >= goals, axis=2) & np.any(goals[:, None] > goals, axis=2)
    assert not better.any()
    assert len(front.x) > 10


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


def test_tolerance_against_one_design_at_a_time() -> None:
    """R2's links barely close: its share of turning samples, against the assembly condition itself."""
    from fes_mj.geometry import require_assembly
    from fes_mj.variables import lengths, with_lengths

    design = fes_mj.load_design("r2")
    sampled = to_manufacturing(design, TABLE, np.random.default_rng(0))
    random, turning, powers = np.random.default_rng(1), 0, []
    for _ in range(400):
        built = with_lengths(design, lengths(design) + random.uniform(-0.001, 0.001, 9))
        try:
            require_assembly(built)
        except fes_mj.AssemblyError:
            continue
        turning += 1
        powers.append(quasi_static(built, fes_mj.load_moments("p1p2"), points=360).power_mean)
    share = turning / 400
    assert 0.2 < share < 0.98
    # four standard deviations of a share of 400
    assert sampled.turning == pytest.approx(share, abs=4 * np.sqrt(share * (1 - share) / 400))
    assert sampled.power_low == 0.0
    assert max(powers) > sampled.power_median > 0


def test_tolerance_of_a_forgiving_design() -> None:
    design, random = fes_mj.load_design("d1"), np.random.default_rng(0)
    built, ridden = to_manufacturing(design, TABLE, random), to_rider(design, TABLE, random)
    assert built.turning == 1.0
    own = quasi_static(design, fes_mj.load_moments("p1p2")).power_mean
    assert own - 1 < built.power_low < built.power_median < own + 1
    assert ridden.power_low < built.power_low
