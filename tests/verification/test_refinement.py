"""Refinement of a simulated turn on two axes."""

import math

import pytest

from fes_mj.verification import refinement
from fes_mj.verification.refinement import observed_order, refine
from tests.verification.conftest import case_of


def test_the_observed_order_is_the_slope() -> None:
    sizes = [0.4, 0.2, 0.1]
    assert observed_order(sizes, [3 * size**2 for size in sizes]) == pytest.approx(2)
    assert observed_order(sizes, [-5 * size for size in sizes]) == pytest.approx(1)
    assert math.isnan(observed_order(sizes, [1, 0, math.inf]))


@pytest.mark.parametrize("name", [pytest.param("trt", marks=pytest.mark.long), "r2", "d1"])
def test_both_axes_converge_to_statics(name: str) -> None:
    """Slope and size: an order alone may converge to the wrong answer."""
    result = refine(case_of(name))
    assert result.gap_order == pytest.approx(2, abs=0.01)
    assert result.power_order == pytest.approx(2, abs=0.01)
    assert result.softness_order > 0.85
    assert abs(result.steps[-1].work_error) < 1e-6
    assert abs(result.extrapolated) < 1e-7
    assert result.steps[-1].gap < 2e-7


@pytest.mark.long
def test_the_uncertainty_covers_the_true_error_of_the_default_step() -> None:
    for name in ("trt", "r1", "d2"):
        result = refine(case_of(name))
        assert abs(result.steps[0].work_error) <= result.uncertainty < 1e-5


def test_soft_loops_converge_to_the_wrong_answer(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(refinement, "LOOP_SOLREF", (0.02, 1.0))
    monkeypatch.setattr("fes_mj.simulation.stepping.LOOP_SOFTNESS", 1.0)
    result = refine(case_of("r2"))
    assert abs(result.extrapolated) > 1e-3  # however fine the step
    assert abs(result.gap_order - 2) > 1
    assert result.softness_floor > 0.5


@pytest.mark.long
def test_the_recommended_loops_lie_on_the_floor() -> None:
    result = refine(case_of("d1"))
    assert abs(result.softness_floor) < 1e-3  # ten times stiffer gains nothing
    assert result.softness[-1].gap > 10 * result.recommended.gap
