"""The Fourier series that carries the recovered moments' uncertainty. Needs numpy alone: statics stay instant."""

from typing import Any

import numpy as np

from fes_mj.arrays import FloatArray

HARMONICS = 24  # beyond the 24th a kernel of length 0.5 has less than 1e-12 of its variance
TERMS = 2 * HARMONICS + 1  # of one joint


def fourier(crank_angle: Any) -> FloatArray:
    """1, cos k a, sin k a along a new last axis of size TERMS; crank_angle in rad from top dead centre."""
    angle = np.asarray(crank_angle, float)
    turned = np.empty((*angle.shape, HARMONICS), complex)
    turned[...] = np.exp(1j * angle)[..., None]
    np.cumprod(turned, axis=-1, out=turned)  # e^(ika) for k = 1, 2, ...: ten times faster than as many sines
    return np.concatenate([np.ones((*angle.shape, 1)), turned.real, turned.imag], axis=-1)
