"""Refinement of a simulated turn on two axes, and its energy audit."""

import math

import numpy as np
import pytest

import fes_mj
from fes_mj.crosscheck import Case
from fes_mj.verification import refinement
from fes_mj.verification.energy import audit
from fes_mj.verification.refinement import observed_order, refine
from fes_mj.verification.suite import servo_rounding


def _case(name: str) -> Case:
    design = fes_mj.load_design(name)
    return Case(design, fes_mj.load_moments("p1p2"), design.linkage.cadence)


def test_the_observed_order_is_the_slope() -> None:
    sizes = [0.4, 0.2, 0.1]
    assert observed_order(sizes, [3 * size**2 for size in sizes]) == pytest.approx(2)
    assert observed_order(sizes, [-5 * size for size in sizes]) == pytest.approx(1)
    assert math.isnan(observed_order(sizes, [1, 0, math.inf]))


@pytest.mark.parametrize("name", ["trt", "r2", "d1"])
def test_both_axes_converge_to_statics(name: str) -> None:
    """Slope and size: an order alone may converge to the wrong answer."""
    result = refine(_case(name))
    assert result.gap_order == pytest.approx(2, abs=0.01)
    assert result.power_order == pytest.approx(2, abs=0.01)
    assert result.softness_order > 0.85
    assert abs(result.steps[-1].work_error) < 1e-6
    assert abs(result.extrapolated) < 1e-7
    assert result.steps[-1].gap < 2e-7


def test_the_uncertainty_covers_the_true_error_of_the_default_step() -> None:
    for name in ("trt", "r1", "d2"):
        result = refine(_case(name))
        assert abs(result.steps[0].work_error) <= result.uncertainty < 1e-5


def test_soft_loops_converge_to_the_wrong_answer(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(refinement, "LOOP_SOLREF", (0.02, 1.0))
    monkeypatch.setattr("fes_mj.simulation.stepping.LOOP_SOFTNESS", 1.0)
    result = refine(_case("r2"))
    assert abs(result.extrapolated) > 1e-3  # however fine the step
    assert abs(result.gap_order - 2) > 1
    assert result.softness_floor > 0.5


def test_the_recommended_loops_lie_on_the_floor() -> None:
    result = refine(_case("d1"))
    assert abs(result.softness_floor) < 1e-3  # ten times stiffer gains nothing
    assert result.softness[-1].gap > 10 * result.recommended.gap


def test_the_energy_audit_accounts_for_everything(design: fes_mj.Design, moments: fes_mj.JointMoments) -> None:
    ledger = audit(Case(design, moments, design.linkage.cadence))
    run = fes_mj.simulate(design, moments)
    assert ledger.joint_work == pytest.approx(run.energy.joint_work, rel=1e-9)
    assert ledger.crank_work == pytest.approx(run.energy.crank_work, rel=1e-9)
    assert ledger.damping == 0
    assert abs(ledger.constraint_work) < 1e-5 * ledger.joint_work
    assert abs(ledger.integration) < 1e-4 * ledger.joint_work
    assert set(ledger.terms) == {
        *("joint work", "crank work", "kinetic energy, change", "potential energy, change"),
        *("damping", "work of the constraints", "integration error"),
    }


def test_the_work_of_soft_loops_shows_in_the_audit(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("fes_mj.simulation.mjcf.LOOP_SOLREF", (0.02, 1.0))
    monkeypatch.setattr("fes_mj.simulation.stepping.LOOP_SOFTNESS", 1.0)
    ledger = audit(_case("r2"))
    assert ledger.constraint_work < -1e-3 * ledger.joint_work  # they take energy


def test_sensor_and_servo_are_action_and_reaction() -> None:
    case = _case("d2")
    ledger = audit(case)
    assert np.abs(ledger.crank_moment - ledger.servo_moment).max() < 2 * servo_rounding(case.cadence)
    shifted = np.abs(ledger.crank_moment[1:] - ledger.servo_moment[:-1]).max()
    assert shifted > 0.01  # a step off is seen
