"""The page and the optimiser find the same limits broken."""

import pytest

import fes_mj
from fes_mj.explore.limits import MARKS, broken
from fes_mj.linkage.variables import replaced
from fes_mj.optimization.problem import make_problem
from fes_mj.statics.turn import quasi_static


def words_broken(name: str, **changes: float) -> set[str]:
    design = replaced(fes_mj.load_design(name), changes)
    return {limit["text"].partition(" is ")[0] for limit in broken(design, quasi_static(design, fes_mj.load_moments()))}


@pytest.mark.parametrize("name", ["r1", "r2", "d1", "d2"])
def test_as_the_optimiser(name: str) -> None:
    design = fes_mj.load_design(name)
    problem = make_problem(design.linkage.kind, fes_mj.load_moments(), start=name)
    theirs = {violation["name"] for violation in problem.violations(problem.evaluate(problem.variables(design)[None]))}
    assert words_broken(name) == {MARKS[constraint].words for constraint in theirs if constraint in MARKS}


def test_a_trt_is_no_subject_of_the_optimisation() -> None:
    assert words_broken("trt") == set()


def test_limits_of_lengths_and_angles() -> None:
    assert "the foot from ankle to pedal" in words_broken("trt", R6=0.36)
    assert words_broken("d1", seat_angle=25.0) == {"the largest hip angle"}


def test_every_mark_is_a_constraint() -> None:
    assert {*MARKS} <= {constraint.name for constraint in make_problem("cdt", fes_mj.load_moments()).constraints}


def test_a_linkage_that_does_not_turn_has_lengths_still() -> None:
    linkage = fes_mj.load_design("d1").linkage
    design = replaced(fes_mj.load_design("d1"), {"R2": 0.25})
    margin = 100 * (linkage.rocker + linkage.coupler - 0.25 - abs(linkage.pivot_to_crank))
    assert f"the Grashof margin is −{-margin:.2f} cm; it must be at least 0.5 cm" in [  # noqa: RUF001
        limit["text"] for limit in broken(design, None)
    ]
