"""Drawn joint moments: what is linear in them agrees with the mean and the covariance that ship."""

import numpy as np
import pytest

import fes_mj
from fes_mj.linkage.design_file import DESIGNS
from fes_mj.moments.files import moments_of, sampled_coefficients, sampled_moments
from fes_mj.moments.fourier import fourier
from fes_mj.moments.joint_moments import GROUPS
from fes_mj.statics.turn import quasi_static

ROUNDING = 0.5e-4  # N m, of the files


@pytest.mark.parametrize("group", GROUPS)
def test_mean_and_covariance_are_those_of_the_drawn_curves(group: str) -> None:
    curves, shipped = sampled_coefficients(group), fes_mj.load_moments(group)
    assert curves.shape == (1000, 98)
    mean = moments_of(curves.mean(axis=0), group)
    assert np.abs(mean.knee - shipped.knee).max() < 1.01 * ROUNDING
    assert np.abs(mean.hip - shipped.hip).max() < 1.01 * ROUNDING
    assert shipped.covariance is not None
    assert np.allclose(shipped.covariance, np.cov(curves.T), atol=1e-6)


@pytest.mark.parametrize("name", DESIGNS)
def test_power_and_its_error_are_those_of_the_drawn_curves(name: str) -> None:
    """Linear: to the rounding of the files and of the interpolation, not to a sampling error."""
    for group in GROUPS:
        shipped = quasi_static(fes_mj.load_design(name), fes_mj.load_moments(group))
        powers = sampled_coefficients(group) @ shipped.power_weights
        assert shipped.power_mean == pytest.approx(powers.mean(), abs=2e-3)
        assert shipped.power_sd == pytest.approx(np.hypot(powers.std(ddof=1), shipped.extrapolation.sd), rel=1e-3)


def test_drawn_moments_are_their_coefficients() -> None:
    moments, curves = sampled_moments("p1p3"), sampled_coefficients("p1p3")
    assert len(moments) == len(curves)
    assert [curve.name for curve in moments[:2]] == ["p1p3 1", "p1p3 2"]
    angle = np.radians([0.0, 7.0, 359.0])
    for number in (0, 17, 999):
        knee, hip = moments[number].at(angle)
        assert knee == pytest.approx(fourier(angle) @ curves[number, :49])
        assert hip == pytest.approx(fourier(angle) @ curves[number, 49:])
