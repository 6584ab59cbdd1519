"""The Fourier series against cosines and sines one by one."""

import numpy as np

from fes_mj.fourier import HARMONICS, fourier


def test_the_series_is_what_it_says() -> None:
    angle = np.array([[-1.0, 0.0], [2.0, 6.0]])
    order = np.arange(1, HARMONICS + 1)
    expected = [np.ones((2, 2, 1)), np.cos(angle[..., None] * order), np.sin(angle[..., None] * order)]
    assert np.abs(fourier(angle) - np.concatenate(expected, axis=-1)).max() < 1e-13
