"""The problem: constraints against independent measures, feasibility of the printed designs."""

import math
from dataclasses import replace
from pathlib import Path
from typing import Any, get_type_hints

import numpy as np
import pytest

import fes_mj
from fes_mj.linkage.design_file import SIX_BARS, design_toml
from fes_mj.linkage.turning import turning
from fes_mj.linkage.variables import crank_speed
from fes_mj.optimization.optimize import run_searches
from fes_mj.optimization.problem import LENGTH_COUNT, Problem, ProblemOptions, make_problem
from fes_mj.statics.cycles import joint_speeds
from tests.optimization.conftest import TABLE, problem_of

POSITIONAL = ("kind", "moments", "return")


def test_what_a_problem_takes_by_name_is_handed_on_whole() -> None:
    """One list is for type checkers, one is the signature."""
    asked = get_type_hints(make_problem)
    assert get_type_hints(ProblemOptions) == {name: asked[name] for name in asked if name not in POSITIONAL}


def population(problem: Problem, count: int = 2000, seed: int = 0, step: float = 0.02) -> np.ndarray:
    random = np.random.default_rng(seed)
    return problem.variables(problem.template) + random.uniform(-step, step, (count, LENGTH_COUNT + 1))


@pytest.mark.parametrize("name", SIX_BARS)
def test_printed_designs_are_feasible_at_their_own_joint_speeds(name: str) -> None:
    problem = problem_of(name)
    evaluation = problem.evaluate(problem.variables(problem.template)[None])
    assert problem.violations(evaluation) == []
    assert evaluation.feasible[0]
    static = fes_mj.quasi_static(problem.template, fes_mj.load_moments("p1p2"))
    assert evaluation.power[0, 0] == pytest.approx(static.power_mean, rel=2e-5)


def test_coupler_driven_designs_break_the_speed_limit_of_the_trt() -> None:
    speeds = joint_speeds(fes_mj.load_design("trt"), TABLE)
    problem = replace(problem_of("d1"), joint_speed=speeds)
    violations = problem.violations(problem.evaluate(problem.variables(problem.template)[None]))
    assert [violation["name"] for violation in violations] == ["knee_speed"]
    assert violations[0]["value"] == pytest.approx(164.6, abs=0.1)
    assert violations[0]["limit"] == pytest.approx(107.1, abs=0.1)
    assert violations[0]["margin"] == pytest.approx(violations[0]["limit"] - violations[0]["value"])


@pytest.mark.parametrize("name", SIX_BARS)
def test_verdicts_agree_with_one_design_at_a_time(name: str) -> None:
    """Feasible designs close over the whole turn inside every limit; infeasible ones violate what they are said to."""
    problem = problem_of(name)
    x = population(problem)
    evaluation = problem.evaluate(x)
    assert 0 < evaluation.feasible.sum() < len(x)
    moments = fes_mj.load_moments("p1p2")
    for row in np.flatnonzero(evaluation.feasible)[:10]:
        design = problem.design(evaluation.x[row], "one")
        static = fes_mj.quasi_static(design, moments)
        assert evaluation.power[row, 0] == pytest.approx(static.power_mean, rel=1e-4)
        assert np.degrees(static.joint_angle.knee.min()) > 68.49
        assert np.degrees(static.joint_angle.knee.max()) < 122.51
        assert np.degrees(static.joint_angle.hip.min()) > 84.49
        assert np.degrees(static.joint_angle.hip.max()) < 120.51
        knee_speed = np.degrees(np.abs(static.motion.joint_rate.knee).mean()) * static.cadence
        assert knee_speed <= problem.joint_speed.knee * (1 + 1e-3)
        lengths = [abs(design.linkage.pivot_to_crank), design.linkage.coupler, design.linkage.rocker]
        assert design.linkage.crank < min(lengths)
    broken = [problem.violations(evaluation, row) for row in np.flatnonzero(~evaluation.feasible)]
    names = {violation["name"] for violations in broken for violation in violations}
    assert len(names) > 3
    unable = [c.name for c in problem.constraints].index("grashof")
    for row in np.flatnonzero(evaluation.margins[:, unable] < 0)[:5]:
        with pytest.raises(fes_mj.AssemblyError):
            turning(problem.design(evaluation.x[row], "one"))


@pytest.mark.parametrize(
    "changes",
    [
        {},
        {"grashof_min": -0.1, "crank_min": 0.0, "rocker_min": 0.0, "gear_ratio_max": 100.0},
        pytest.param({"knee_deg": (-300.0, 300.0), "hip_deg": (-300.0, 300.0)}, marks=pytest.mark.long),
        pytest.param({"hip_deg": (118.0, 170.0)}, marks=pytest.mark.long),
        pytest.param(
            {"polygon": 3 * np.array([-1 - 1j, 1 - 1j, 1 + 1j, -1 + 1j]), "hip_deg": (-300.0, 300.0)},
            marks=pytest.mark.long,
        ),
    ],
)
@pytest.mark.parametrize("name", ["r1", "d1"])
def test_whatever_is_feasible_is_accepted_by_the_other_commands(
    name: str, changes: dict[str, Any], tmp_path: Path
) -> None:
    """As a file, by statics, as a model and at its own cadence; both random designs and those that a search drives
    to the limits.
    """
    problem, moments, file = problem_of(name), fes_mj.load_moments("p1p2"), tmp_path / "found.toml"
    low, high = problem.limits.search.T.copy()
    if "crank_min" in changes:
        low[[2, 7, 8]] = 0.0
        high[9] = 10.0
    limits = replace(problem.limits, **changes, search=np.column_stack([low, high]))
    problem = replace(problem, limits=limits, joint_speed=problem.joint_speed.map(lambda speed: 4 * speed))
    x = np.random.default_rng(0).uniform(low, high, (10_000, LENGTH_COUNT + 1))
    nine, ten = problem.evaluate(x[:, :LENGTH_COUNT]), problem.evaluate(x)
    driven = [result.x for result in run_searches(problem, "differential-evolution", searches=1, budget=4000)]
    for variables in [*nine.x[nine.feasible][:10], *ten.x[ten.feasible][:10], *driven]:
        file.write_text(design_toml(problem.design(variables, "found")))
        design = fes_mj.load_design(file)
        cadence = crank_speed(design)
        assert math.isfinite(fes_mj.quasi_static(design, moments, points=120).power_mean)
        fes_mj.build_mjcf(design, cadence=cadence, timestep=0.001)


def test_a_joint_that_may_not_move_is_refused() -> None:
    problem = problem_of("d1")
    with pytest.raises(fes_mj.InputError, match=r"knee .* 0 deg/s"):
        replace(problem, joint_speed=problem.joint_speed.map(lambda _: 0.0))


def test_a_population_is_its_members() -> None:
    problem = problem_of("d2")
    x = population(problem, 300)
    together = problem.evaluate(x)
    for row in range(0, 300, 29):
        alone = problem.evaluate(x[row : row + 1])
        np.testing.assert_allclose(alone.values[0], together.values[row], rtol=1e-10)
        np.testing.assert_allclose(alone.power[0], together.power[row], rtol=1e-10)


def test_the_chosen_gear_ratio_is_the_largest_allowed() -> None:
    problem = problem_of("d1")
    nine = problem.evaluate(population(problem, 500)[:, :LENGTH_COUNT])
    rows = nine.feasible
    assert rows.any()
    for factor, feasible in ((0.999, True), (1.001, False)):
        x = nine.x[rows].copy()
        x[:, LENGTH_COUNT] *= factor
        assert np.all(problem.evaluate(x).feasible == feasible)


def test_feasible_designs_rank_above_all_others_and_less_violation_above_more() -> None:
    problem = problem_of("r1")
    evaluation = problem.evaluate(population(problem, 3000, step=0.05))
    merit = problem.merit(evaluation)
    assert evaluation.feasible.any()
    assert merit[evaluation.feasible].min() > merit[~evaluation.feasible].max()
    order = np.argsort(merit[~evaluation.feasible])
    assert np.all(np.diff(evaluation.violation[~evaluation.feasible][order]) <= 0)
