"""The criteria of Section 7 on cases with known answers."""

import math

import numpy as np
import pytest

import fes_mj
from fes_mj.moments.fourier import fourier
from fes_mj.moments.joint_moments import JointMoments
from fes_mj.moments.torque_map import TorqueMap
from fes_mj.paper.metrics import jump_weights, smoothing_weights
from fes_mj.statics.turn import quasi_static


def test_smoothing_against_the_solver() -> None:
    """The functional against powers of moments smoothed by hand along the motion."""
    random, few = np.random.default_rng(5), np.tile(np.r_[1, 1, 1, np.zeros(22), 1, 1, np.zeros(22)], 2)
    coefficients, angle = random.normal(size=98) * few, np.radians(np.arange(0, 360, 0.1))
    moments = JointMoments("random", angle, *(fourier(angle) @ half for half in np.split(coefficients, 2)))
    result, width = quasi_static(fes_mj.load_design("r1"), moments), math.radians(5)
    smoothed, torque_map = np.zeros(result.crank_angle.shape), TorqueMap(moments)
    for joint, at in result.joint_angle.items():
        rate = result.motion.joint_rate[joint]
        own, other = (torque_map.moment(joint, at, sign * rate) for sign in (1, -1))
        inside = np.clip(np.minimum(at - at.min(), at.max() - at) / width, 0, 1)
        smoothed += rate * ((own + other) / 2 + inside * (own - other) / 2)
    expected = result.power_mean - result.cadence * smoothed.mean()
    assert smoothing_weights(result, width) @ coefficients == pytest.approx(expected, abs=2e-4)
    low = result.joint_angle.knee.min()
    jump = torque_map.moment("knee", low, 1.0) - torque_map.moment("knee", low, -1.0)
    assert jump_weights(result)[0] @ coefficients == pytest.approx(float(jump), abs=1e-3)
