"""The problem: constraints against independent measures, feasibility of the printed designs, bad input."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import fes_mj
from fes_mj.cycles import WorkTable, joint_speeds
from fes_mj.geometry import require_assembly
from fes_mj.optimization.problem import LENGTH_COUNT, Problem
from fes_mj.optimization.problem_file import DEFAULT, depth_inside, load_limits

TABLE = WorkTable.of(fes_mj.load_moments("p1p2"))
SIX_BARS = ("r1", "r2", "d1", "d2")


def problem_of(name: str, grashof_min: float = 0.0) -> Problem:
    """The paper's problem with the joint speeds of one of its designs."""
    design = fes_mj.load_design(name)
    speeds = joint_speeds(design, TABLE)
    limits = replace(load_limits(), grashof_min=grashof_min)
    return Problem(design, TABLE, limits, speeds.map(lambda speed: speed * (1 + 1e-9)))


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
            require_assembly(problem.design(evaluation.x[row], "one"))


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


def test_depth_inside_a_polygon() -> None:
    square = np.array([0, 1, 1 + 1j, 1j])
    points = np.array([0.5 + 0.5j, 0.1 + 0.4j, -0.2 + 0.5j, 2 + 2j])
    assert depth_inside(square, points) == pytest.approx([0.5, 0.1, -0.2, -np.sqrt(2)])
    notched = np.array([0, 2, 2 + 2j, 1 + 1j, 2j])
    # above the notch's tip: the nearest border is its slope; below it: the tip itself
    assert depth_inside(notched, np.array([1 + 1.5j, 1 + 0.9j])) == pytest.approx([-0.5 / np.sqrt(2), 0.1])
    assert depth_inside(square[::-1], points) == pytest.approx([0.5, 0.1, -0.2, -np.sqrt(2)])


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("knee_deg = [69.0, 122.0]", "knee_deg = [122.0, 69.0]", "limits.knee_deg is [122.0, 69.0]; the bounds"),
        ("crank_min = 0.025", "crank_min = 'short'", "limits.crank_min is 'short'; it must be a number"),
        ("crank_min = 0.025", "", "limits.crank_min is missing"),
        ("crank_min", "crank_mni", "unknown key limits.crank_mni; allowed here: crank_min"),
        ("[-1.25, 0.10], [-0.60, 0.10], ", "", "encloses no area"),
        ("[search]", "[look]", "unknown key look"),
    ],
)
def test_a_bad_problem_file_is_one_message(tmp_path: Path, old: str, new: str, said: str) -> None:
    text = DEFAULT.read_text()
    assert old in text
    path = tmp_path / "mine.toml"
    path.write_text(text.replace(old, new))
    with pytest.raises(fes_mj.InputError) as refused:
        load_limits(path)
    assert str(refused.value).startswith(f"{path}: ")
    assert said in str(refused.value)
