"""The instruments that find errors of kinematics."""

import numpy as np
import pytest

import fes_mj
from fes_mj import kinematics
from fes_mj.kinematics import Rotation
from fes_mj.verification.geometry import fourier_derivative, rate_errors


def test_a_fourier_derivative_is_exact() -> None:
    angle = np.linspace(0, 2 * np.pi, 64, endpoint=False)
    assert fourier_derivative(np.exp(np.sin(angle))) == pytest.approx(np.cos(angle) * np.exp(np.sin(angle)), abs=1e-12)
    assert fourier_derivative(np.exp(3j * angle)) == pytest.approx(3j * np.exp(3j * angle), abs=1e-12)


def test_rate_errors_see_an_error_of_a_millionth(design: fes_mj.Design, monkeypatch: pytest.MonkeyPatch) -> None:
    motion = kinematics.solve(design, np.linspace(0, 2 * np.pi, 512, endpoint=False))
    assert max(rate_errors(motion)) < 1e-10
    first, second = motion.rotation["thigh"]
    motion.rotation["thigh"] = Rotation(first * (1 + 1e-6), second)
    assert rate_errors(motion)[0] > 1e-8
