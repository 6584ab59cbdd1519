"""Crank moment by methods that share little."""

import numpy as np

import fes_mj
from fes_mj.verification.case import VerificationCase
from fes_mj.verification.references import differences, exact_curves, massless_difference
from fes_mj.verification.suite import servo_rounding


def _case(design: fes_mj.Design, moments: fes_mj.JointMoments) -> VerificationCase:
    return VerificationCase(design, moments)


def test_exact_methods_agree_to_rounding(design: fes_mj.Design, moments: fes_mj.JointMoments) -> None:
    case = _case(design, moments)
    for family, curves in exact_curves(case).items():
        assert len(curves) == (2 if family == "massless" else 3)
        assert max(differences(curves).values()) < 1e-12
    assert massless_difference(case) < 1e-12


def test_massive_methods_see_masses(design: fes_mj.Design, moments: fes_mj.JointMoments) -> None:
    """The families differ by more than 5 N m: their agreement is not that of a model without masses."""
    curves = exact_curves(_case(design, moments))
    assert np.abs(curves["massive"]["mj_inverse"] - curves["massless"]["virtual work"]).max() > 1.0


def test_measured_methods_agree_with_the_exact_ones(design: fes_mj.Design, smooth_moments: fes_mj.JointMoments) -> None:
    case = _case(design, smooth_moments)
    curves = case.curves
    assert set(curves["massive"]) == {"equilibrium", "inverse dynamics", "mj_inverse", "torque sensor", "servo"}
    between = differences(curves["massive"])
    assert between["torque sensor", "servo"] < 2 * servo_rounding(case.cadence)
    scale = np.abs(curves["massive"]["mj_inverse"]).max()
    power = (curves["massive"]["torque sensor"] - curves["massive"]["mj_inverse"]) * case.cadence
    assert np.sqrt(np.mean(power**2)) < 0.01
    assert scale > 5
