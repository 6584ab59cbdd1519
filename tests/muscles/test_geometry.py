import numpy as np
import pytest

from fes_mj.muscles.anatomy import anatomy
from fes_mj.muscles.geometry import Flexion, exponents, terms

HIP, KNEE = np.radians([35.0, 70.0, 110.0])[:, None], np.radians([20.0, 67.5, 115.0])


def test_terms_are_the_powers_that_their_exponents_say():
    flexion = Flexion(HIP, KNEE)
    hip, knee = HIP - np.radians(70), KNEE - np.radians(67.5)
    for (first, second), term in zip(exponents(4), terms(flexion, 4), strict=True):
        assert term == pytest.approx(hip**first * knee**second, abs=1e-15)


@pytest.mark.parametrize("joint", ["hip", "knee"])
def test_derivatives_are_those_of_the_same_polynomial(joint):
    lengths, step = anatomy().lengths, 1e-20
    moved = Flexion(HIP + 1j * step * (joint == "hip"), KNEE + 1j * step * (joint == "knee"))
    powers = [(moved.hip - np.radians(70)) ** h * (moved.knee - np.radians(67.5)) ** k for h, k in exponents(5)]
    exact = np.einsum("mt,t...->m...", lengths.coefficients, np.stack(powers)).imag / step  # complex step
    assert getattr(lengths.at(Flexion(HIP, KNEE)), f"by_{joint}") == pytest.approx(exact, abs=1e-15)


def test_many_angles_have_the_values_of_few():
    lengths, bent = anatomy().lengths, np.radians(np.linspace(20, 100, 2500))
    together = lengths.at(Flexion(bent, bent[::-1]))
    for few in (slice(0, 3), slice(1022, 1026), slice(2497, 2500)):
        for whole, part in zip(together, lengths.at(Flexion(bent[few], bent[::-1][few])), strict=True):
            assert whole[:, few] == pytest.approx(part, rel=1e-13, abs=1e-15)
