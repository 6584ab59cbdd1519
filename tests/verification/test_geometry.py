"""The instruments that find errors of kinematics."""

import numpy as np
import pytest

import fes_mj
from fes_mj.linkage import kinematics
from fes_mj.linkage.kinematics import Rotation
from fes_mj.verification.geometry import closure_error, rate_errors


def test_rate_errors_see_an_error_of_a_millionth(design: fes_mj.Design, monkeypatch: pytest.MonkeyPatch) -> None:
    motion = kinematics.solve(design, np.linspace(0, 2 * np.pi, 512, endpoint=False))
    assert max(rate_errors(motion)) < 1e-10
    first, second = motion.rotation["thigh"]
    motion.rotation["thigh"] = Rotation(first * (1 + 1e-6), second)
    assert rate_errors(motion)[0] > 1e-8


def test_a_nan_anywhere_is_an_error(design: fes_mj.Design) -> None:
    """Whichever body it is in: the largest of a number and a NaN is the NaN."""
    for body in ("thigh", "shank"):
        motion = kinematics.solve(design, np.linspace(0, 2 * np.pi, 512, endpoint=False))
        first, second = motion.rotation[body]
        motion.rotation[body] = Rotation(first * np.nan, second * np.nan)
        assert np.isnan(rate_errors(motion)).all(), body
    for point in motion.points:
        motion = kinematics.solve(design, np.linspace(0, 2 * np.pi, 8, endpoint=False))
        motion.points[point] = motion.points[point]._replace(value=np.nan)
        assert np.isnan(closure_error(motion)), point
