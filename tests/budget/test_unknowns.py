"""Realisations: within their priors, shared where designs share them, the same every time."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import fes_mj
from fes_mj.budget.unknowns import MASSES, Realisations, budget_priors, realisations
from fes_mj.linkage.assembly import joint_ranges
from fes_mj.linkage.design_file import SIX_BARS
from fes_mj.linkage.variables import LENGTHS, component, replaced
from fes_mj.moments.files import sampled_coefficients
from fes_mj.paper.identification import LENGTH_ROUNDING
from fes_mj.paper.printed import table1
from tests.linkage.test_design_file import written

COUNT = 1000


def of(design: fes_mj.Design, count: int = COUNT) -> Realisations:
    return realisations(design, fes_mj.load_moments(), count)


def test_every_prior_has_its_source_or_the_word_assumption() -> None:
    assert [*budget_priors()][-1] == MASSES
    for prior in budget_priors().values():
        assert prior["prior"]
        assert any(word in prior["source"].lower() for word in ("assumption", "results/", "data/", "exact"))


def test_what_designs_share_is_the_same_in_both() -> None:
    d1, trt = of(fes_mj.load_design("d1")), of(fes_mj.load_design("trt"))
    for name in ("coefficients", "drifts"):
        assert np.array_equal(getattr(d1, name), getattr(trt, name))
    assert np.array_equal(d1.legs["thigh"], trt.legs["thigh"])
    assert abs(np.corrcoef(d1.dimensions["R1x"], trt.dimensions["R1x"])[0, 1]) < 0.1  # each its own


def test_independent_unknowns_are_independent() -> None:
    drawn = of(fes_mj.load_design("d1"))
    columns = [drawn.legs["thigh"], drawn.legs["shank"], *drawn.drifts.T, *drawn.dimensions.values()]
    columns.append(drawn.coefficients[:, 0])
    correlation = np.corrcoef(columns)
    legs = slice(0, 10)  # dimensions that must close depend on each other
    assert np.abs(correlation[legs, :] - np.eye(len(columns))[legs, :]).max() < 0.15


def test_legs_are_as_the_data_say() -> None:
    for length in of(fes_mj.load_design("r1")).legs.values():
        assert length.mean() == pytest.approx(0.52, abs=0.001)
        assert length.std() == pytest.approx(0.01, rel=0.06)


def test_shipped_curves_and_those_of_own_moments() -> None:
    """A thousand shipped ones are all of them; Gaussian ones have the covariance, to 2 % of a variance's error."""
    moments = fes_mj.load_moments("p1p3")
    design = fes_mj.load_design("trt")
    assert np.array_equal(realisations(design, moments, 1000).coefficients, sampled_coefficients("p1p3"))
    own = realisations(design, replace(moments, name="own"), 4000).coefficients
    assert moments.covariance is not None
    assert own.mean(axis=0) == pytest.approx(np.concatenate([*moments.coefficients]), abs=0.5)
    assert own.std(axis=0)[:10] == pytest.approx(np.sqrt(np.diag(moments.covariance))[:10], rel=0.06)
    renamed = replace(moments, name="p1p2")  # whose name is a group's, and whose error is not
    assert not np.array_equal(realisations(design, renamed, 1000).coefficients, sampled_coefficients("p1p2"))


@pytest.mark.parametrize("name", SIX_BARS)
def test_identified_linkages_are_inside_the_rounding_and_move_as_table_1_says(name: str) -> None:
    printed, drawn = fes_mj.load_design(name, "printed"), of(fes_mj.load_design(name)).dimensions
    for length in LENGTHS:
        assert np.abs(drawn[length] - component(printed, length)).max() <= LENGTH_ROUNDING + 1e-6
    ranges = joint_ranges(replaced(printed, {key: values[:, None] for key, values in drawn.items()}))
    target = table1()[name]
    assert np.abs(ranges - [*target.knee_range, *target.hip_range]).max() < 0.5 + 1e-3  # their rounding in the file


def test_another_design_is_known_to_the_last_digit_of_its_lengths(tmp_path: Path) -> None:
    printed = fes_mj.load_design("d1", "printed")
    for design, half in ((printed, 0.005), (fes_mj.load_design(written(tmp_path, R2="0.1503")), 0.00005)):
        drawn = of(design).dimensions
        assert {*drawn} == {name for name in LENGTHS if component(design, name)}
        for name, values in drawn.items():
            away = values - component(design, name)
            assert 0.99 * half < np.abs(away).max() <= half
            assert away.std() == pytest.approx(half / np.sqrt(3), rel=0.06)
    changed = fes_mj.load_design("d1").with_linkage(crank=0.1612345)  # no longer the identified one
    assert np.abs(of(changed).dimensions["R9"] - component(changed, "R9")).max() <= 0.5e-7
