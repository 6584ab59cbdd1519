"""The energy audit of a simulated turn."""

import numpy as np
import pytest

import fes_mj
from fes_mj.crosscheck.turn_case import Case
from fes_mj.verification.energy import audit
from fes_mj.verification.suite import servo_rounding
from tests.verification.conftest import case_of


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
    ledger = audit(case_of("r2"))
    assert ledger.constraint_work < -1e-3 * ledger.joint_work  # they take energy


def test_sensor_and_servo_are_action_and_reaction() -> None:
    case = case_of("d2")
    ledger = audit(case)
    assert np.abs(ledger.crank_moment - ledger.servo_moment).max() < 2 * servo_rounding(case.cadence)
    shifted = np.abs(ledger.crank_moment[1:] - ledger.servo_moment[:-1]).max()
    assert shifted > 0.01  # a step off is seen
