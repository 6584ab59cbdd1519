"""A start that does not keep the limits: the nearest that does, or which limit is in the way."""

from dataclasses import replace

import numpy as np
import pytest

import fes_mj
from fes_mj.linkage.design_file import SIX_BARS
from fes_mj.optimization.repair import changes, repaired
from tests.optimization.conftest import problem_of


@pytest.mark.parametrize("name", SIX_BARS)
def test_a_broken_start_is_repaired_and_the_changes_are_said(name: str) -> None:
    problem = problem_of(name)
    start = problem.variables(problem.template)
    start[2] += 0.05  # the crank, which then no longer turns
    assert not problem.evaluate(start[None]).feasible[0]
    after = repaired(problem, start)
    assert problem.evaluate(after[None]).feasible[0]
    assert np.abs(after - start)[:9].max() < 0.2
    assert changes(start, after).startswith("R1x ")


def test_a_kept_length_is_not_a_change() -> None:
    start = np.arange(10.0)
    after = start.copy()
    after[2] = 2.5
    assert changes(start, after) == "R2 2.0000 -> 2.5000 m"


def test_what_nothing_repairs_names_its_keys() -> None:
    problem = problem_of("d1")
    impossible = replace(problem, limits=replace(problem.limits, knee_deg=(69.0, 69.5), crank_min=0.25))
    with pytest.raises(
        fes_mj.InputError, match=r"d1: no design near it .*set by limits\.\w+\).*fes_mj optimize cdt --print-problem"
    ):
        repaired(impossible, problem.variables(problem.template))
