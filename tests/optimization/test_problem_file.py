"""A problem that is printed is read as what was solved."""

from pathlib import Path

import numpy as np
import pytest

import fes_mj
from fes_mj.muscles.riders import load_riders
from fes_mj.optimization.limits import MEANINGS, load_limits
from fes_mj.optimization.problem import make_problem
from fes_mj.optimization.problem_file import problem_text
from fes_mj.optimization.stimulated import MuscleDrive

MOMENTS = fes_mj.load_moments("p1p2")


@pytest.mark.parametrize("build", [None, {}, {"transmission_angle_min": 40.0}])
@pytest.mark.parametrize("kind", ["crt", "cdt"])
def test_limits_read_back(kind: str, build: dict[str, float] | None, tmp_path: Path) -> None:
    problem = make_problem(kind, MOMENTS, build=build)
    path = tmp_path / "problem.toml"
    path.write_text(problem_text(problem))
    again = load_limits(path, None if build is None else {})
    for name, value in vars(problem.limits).items():
        assert np.array_equal(getattr(again, name), value), name


def test_every_limit_says_what_it_is_and_where_it_is_set() -> None:
    by_muscles = {"muscles": MuscleDrive(load_riders("p1p2"))}
    for kind in ("crt", "cdt", "trt"):
        problems = (make_problem(kind, MOMENTS, **options) for options in ({"ripple": 0.1}, by_muscles))
        assert {constraint.name for problem in problems for constraint in problem.constraints} == MEANINGS.keys()


@pytest.mark.parametrize("method", ["cma-es", "random-pursuit", "differential-evolution"])
def test_a_four_bar_stays_one(method: str) -> None:
    """What it lacks stays 0, however a method moves its variables."""
    if method == "cma-es":
        pytest.importorskip("cma")
    found = fes_mj.optimize("trt", MOMENTS, method=method, budget=1000, searches=1, build=None).design
    absent = ("pivot_to_crank", "pedal_arm", "coupler", "rocker")
    assert [getattr(found.linkage, name) for name in absent] == [0, 0, 0, 0]
    assert found.linkage.kind == "trt"


def test_a_design_is_within_the_limits_of_its_own_problem() -> None:
    """The TRT of the paper, in its own place at its own speed, is feasible: the yardstick begins there."""
    problem = make_problem("trt", MOMENTS, like="trt")
    own = problem.variables(problem.template)
    broken = problem.violations_text(own)
    assert {part.split()[0] for part in broken.split(", ") if " is " in part} <= {"extrapolated_share"}, broken
