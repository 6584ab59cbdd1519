"""Power as a functional of the moments, and its standard deviation, against the solver and drawn curves."""

from dataclasses import replace

import numpy as np
import pytest

import fes_mj
from fes_mj.linkage import kinematics
from fes_mj.linkage.design_file import SIX_BARS
from fes_mj.linkage.variables import lengths, replaced, with_lengths
from fes_mj.moments.fourier import fourier
from fes_mj.moments.joint_moments import JointMoments
from fes_mj.moments.reference_tricycle import PAPER_TRICYCLE
from fes_mj.moments.uncertainty import instant_power_weights, power_weights
from fes_mj.statics.turn import difference_sd, quasi_static, ratio_sd

_ANGLE = np.radians(np.arange(0.0, 360.0))


def drawn(moments: JointMoments, count: int) -> list[JointMoments]:
    """Curves drawn from the posterior of a group."""
    covariance = moments.covariance
    assert covariance is not None
    draws = np.random.default_rng(3).multivariate_normal(np.zeros(98), covariance, count, method="eigh")
    features = fourier(_ANGLE)
    return [
        replace(moments, knee=moments.knee + features @ draw[:49], hip=moments.hip + features @ draw[49:])
        for draw in draws
    ]


def test_power_is_linear_in_the_coefficients() -> None:
    """The weights against the quasi-static solver, on random curves of few harmonics."""
    random = np.random.default_rng(1)
    few = np.tile(np.r_[1, 1, 1, 1, np.zeros(21), 1, 1, 1, np.zeros(21)], 2)
    coefficients, angle = random.normal(size=98) * few, np.radians(np.arange(0, 360, 0.1))
    curves = [fourier(angle) @ half for half in np.split(coefficients, 2)]
    moments = JointMoments("random", angle, *curves)
    for name in ("trt", "r1", "d1"):
        result = quasi_static(fes_mj.load_design(name), moments)
        assert result.power_weights @ coefficients == pytest.approx(result.power_mean, abs=1e-4)
        at_once = instant_power_weights(result.motion, result.cadence, result.torque.reference)
        np.testing.assert_allclose(at_once @ coefficients, result.power, atol=1e-2)
        np.testing.assert_allclose(at_once.mean(axis=0), result.power_weights, atol=1e-10)


@pytest.mark.parametrize("group", ["p1p2", pytest.param("p1p3", marks=pytest.mark.long)])
def test_sd_of_power_ratio_and_difference_against_drawn_curves(group: str) -> None:
    """400 draws tell a standard deviation within 3.5 %."""
    moments = fes_mj.load_moments(group)
    d1, trt = (fes_mj.load_design(name) for name in ("d1", "trt"))
    powers = [
        [quasi_static(design, draw, points=120).power_mean for design in (d1, trt)] for draw in drawn(moments, 400)
    ]
    one, other = np.transpose(powers)
    result, base = quasi_static(d1, moments), quasi_static(trt, moments)
    assert result.power_sd == pytest.approx(np.std(one), rel=0.12)
    assert difference_sd(result, base) == pytest.approx(np.std(np.subtract(one, other)), rel=0.12)
    assert ratio_sd(result, base) == pytest.approx(np.std(np.divide(one, other)), rel=0.12)


def test_a_design_does_not_differ_from_itself(moments: JointMoments) -> None:
    result = quasi_static(fes_mj.load_design("r2"), moments)
    assert difference_sd(result, result) == 0
    assert ratio_sd(result, result) == 0


def test_own_moments_have_no_sd(smooth_moments: JointMoments) -> None:
    result = quasi_static(fes_mj.load_design("r2"), smooth_moments)
    assert (result.power_sd, difference_sd(result, result), ratio_sd(result, result)) == (None, None, None)


def test_nothing_correlates_different_groups() -> None:
    one, other = (quasi_static(fes_mj.load_design("r1"), fes_mj.load_moments(group)) for group in ("p1p2", "p1p3"))
    with pytest.raises(fes_mj.InputError, match="p1p2 and p1p3"):
        ratio_sd(one, other)


def test_a_batch_of_designs_has_the_weights_of_its_designs() -> None:
    designs = [fes_mj.load_design(name) for name in ("d1", "d2")]
    values = np.array([lengths(design) for design in designs]).T[..., None]
    batch = replaced(with_lengths(designs[0], values), {"gear_ratio": np.array([[2.1], [2.04]])})
    weights = power_weights(kinematics.solve(batch), batch.linkage.cadence, PAPER_TRICYCLE)
    for row, design in zip(weights, designs, strict=True):
        assert row == pytest.approx(
            power_weights(kinematics.solve(design), design.linkage.cadence, PAPER_TRICYCLE), abs=1e-12
        )


def test_power_is_the_linear_functional_it_is_said_to_be() -> None:
    """The weights of the reconstruction against the quasi-static solver, on curves of few harmonics."""
    random = np.random.default_rng(1)
    coefficients = random.normal(size=2 * 49) * np.tile(np.r_[1, 1, 1, 1, np.zeros(21), 1, 1, 1, np.zeros(21)], 2)
    angle = np.radians(np.arange(0, 360, 0.1))
    knee, hip = (fourier(angle) @ half for half in np.split(coefficients, 2))
    for name in SIX_BARS:
        design = fes_mj.load_design(name)
        solved = quasi_static(design, JointMoments("random", angle, knee, hip)).power_mean
        weights = power_weights(kinematics.solve(design), design.linkage.cadence, PAPER_TRICYCLE)
        assert weights @ coefficients == pytest.approx(solved, abs=2e-3)
