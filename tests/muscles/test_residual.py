import numpy as np
import pytest

from fes_mj.linkage import kinematics
from fes_mj.moments.fourier import fourier
from fes_mj.moments.reference_tricycle import PAPER_TRICYCLE
from fes_mj.moments.uncertainty import power_weights
from fes_mj.muscles.residual import Residual

POWER = power_weights(kinematics.solve(PAPER_TRICYCLE.design), PAPER_TRICYCLE.cadence, PAPER_TRICYCLE)


def test_residual_does_no_net_work_but_its_loss():
    residual = Residual.on(POWER)
    assert residual.loss @ POWER == pytest.approx(-1)  # W
    assert residual.covariance @ POWER == pytest.approx(np.zeros(98), abs=1e-12)


def test_residual_has_its_standard_deviation_at_every_angle():
    features = fourier(np.radians([10.0, 200.0]))
    for part in (slice(0, 49), slice(49, 98)):
        covariance = Residual.on(POWER).covariance[part, part]
        deviation = np.sqrt(np.einsum("ai,ij,aj->a", features, covariance, features))
        assert (deviation <= 1 + 1e-9).all()
        assert (deviation > 0.8).all()  # one direction of many is fixed
