"""Periodic curves over the crank angle as Fourier series. Needs numpy alone: statics stay instant."""

from typing import Any

import numpy as np

from fes_mj.common.arrays import FloatArray

HARMONICS = 24  # beyond the 24th a kernel of length 0.5 has less than 1e-12 of its variance
TERMS = 2 * HARMONICS + 1  # of one joint
WIDEST_GAP = np.radians(60)  # six samples a turn tell the first harmonics; a wider gap is bridged by a straight line
_BRIDGE = np.radians(30)  # between the points of such a bridge: closer ones would make the curve ring
_ORDER = np.concatenate([np.zeros(1), np.tile(np.arange(1, HARMONICS + 1), 2)]) / HARMONICS
_ROUGHNESS = _ORDER**8  # mean square of the fourth derivative, in units of the highest harmonic's
# How much roughness may weigh against the mean square miss: from what leaves alone all that samples determine, to what
# leaves hardly more than their mean.
_WEIGHTS = 10.0 ** np.arange(-5, 13)
_SWING = 0.3  # how far, in their range, curves may swing beyond samples; three harmonics pass twelve by 0.21
_BLOCK = 20_000  # samples
_PASSES = 3  # each takes off what rounding left in the one before


def fourier(crank_angle: Any) -> FloatArray:
    """1, cos k a, sin k a along a new last axis of size TERMS; crank_angle in rad from top dead centre."""
    angle = np.asarray(crank_angle, float)
    turned = np.empty((*angle.shape, HARMONICS), complex)
    turned[...] = np.exp(1j * angle)[..., None]
    np.cumprod(turned, axis=-1, out=turned)  # e^(ika) for k = 1, 2, ...: ten times faster than as many sines
    return np.concatenate([np.ones((*angle.shape, 1)), turned.real, turned.imag], axis=-1)


def fit_fourier(angle: FloatArray, values: FloatArray) -> FloatArray:
    """Coefficients, shape (TERMS, curves), of the smooth periodic curves through samples, or among noisy dense ones.

    angle: rad, shape (n,), in any order and by any whole turns. values: shape (n, curves). Least squares in which all
    samples weigh the same and roughness weighs as samples left out would have it (_smoothed); gaps wider than
    WIDEST_GAP are bridged by straight lines.
    """
    bridge = _bridges(angle, values)
    angle, values = np.concatenate([angle, bridge[0]]), np.concatenate([values, bridge[1]])
    blocks = [slice(start, start + _BLOCK) for start in range(0, len(angle), _BLOCK)]  # a day of samples fits in memory
    roughness, closest = np.diag(_WEIGHTS[0] * _ROUGHNESS), np.zeros((TERMS, values.shape[1]))
    normal = np.sum([terms.T @ terms for terms in (fourier(angle[block]) for block in blocks)], axis=0) / len(angle)
    for _ in range(_PASSES):
        missed, square = -roughness @ closest, np.zeros(values.shape[1])
        for block in blocks:
            terms = fourier(angle[block])
            miss = values[block] - terms @ closest
            missed += terms.T @ miss / len(angle)
            square += np.sum(miss**2, axis=0) / len(angle)
        closest += np.linalg.solve(normal + roughness, missed)
    return _smoothed(closest, square, normal, values)


def _smoothed(closest: FloatArray, square: FloatArray, normal: FloatArray, values: FloatArray) -> FloatArray:
    """Of each curve the weight of roughness that generalised cross-validation prefers (Craven and Wahba 1979).

    Cross-validation cannot tell noise from shape where samples are fewer than terms; so only curves count that do not
    swing far beyond the samples. closest: with the least weight; square: its mean square miss.
    """
    count, turn = len(values), fourier(np.radians(np.arange(360)))
    low, high = values.min(axis=0), values.max(axis=0)
    margin = _SWING * (high - low) + 1e-9 * np.abs(values).max(axis=0)  # rounding, where all samples are the same
    lightest, rough = _WEIGHTS[0], _ROUGHNESS[:, None] * closest
    best, least = closest, np.full(len(square), np.inf)
    for weight in _WEIGHTS:
        inverse = np.linalg.inv(normal + np.diag(weight * _ROUGHNESS))
        change = (lightest - weight) * (inverse @ rough)
        # the miss after the change, without the difference of large numbers
        miss = square + np.sum(change * (2 * lightest * rough + normal @ change), axis=0)
        free = max(1 - np.trace(inverse @ normal) / count, 1e-9)  # share of the samples that is left to judge by
        score, tried = miss / free**2, closest + change
        curves = turn @ tried
        inside = np.all((curves >= low - margin) & (curves <= high + margin), axis=0)
        better = inside & (score < least)
        best, least = np.where(better, tried, best), np.where(better, score, least)
    return best


def gaps(angle: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Angles in order within [0, 2 pi] and the width of the gap from each to the next, round the circle; rad."""
    inside = np.sort(np.mod(angle, 2 * np.pi))
    return inside, np.diff(inside, append=inside[0] + 2 * np.pi)


def _bridges(angle: FloatArray, values: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Points on straight lines across the wide gaps, and the curves' values there."""
    inside, (sampled, widths) = np.mod(angle, 2 * np.pi), gaps(angle)
    points, heights = [np.empty(0)], [np.empty((0, values.shape[1]))]
    for number in np.flatnonzero(widths > WIDEST_GAP):
        start, stop = sampled[number], sampled[(number + 1) % len(sampled)]
        first, last = (values[inside == end].mean(axis=0) for end in (start, stop))
        part = np.arange(_BRIDGE, widths[number] - _BRIDGE / 2, _BRIDGE) / widths[number]
        points.append(start + part * widths[number])
        heights.append(first + part[:, None] * (last - first))
    return np.concatenate(points), np.concatenate(heights)
