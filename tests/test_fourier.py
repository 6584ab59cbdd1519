"""The Fourier series against cosines and sines one by one, and curves through samples against what they sample."""

import numpy as np
import pytest

from fes_mj.arrays import FloatArray
from fes_mj.fourier import HARMONICS, TERMS, WIDEST_GAP, fit, fourier, gaps

TURN = np.linspace(0, 2 * np.pi, 721)


def curve(angle: FloatArray) -> FloatArray:
    """Two curves of three harmonics, shape (n, 2)."""
    one = 3 + np.cos(angle) + np.cos(2 * angle) + 2 * np.sin(3 * angle + 0.3)
    return np.column_stack([one, np.cos(3 * angle)])


def test_the_series_is_what_it_says() -> None:
    angle = np.array([[-1.0, 0.0], [2.0, 6.0]])
    order = np.arange(1, HARMONICS + 1)
    expected = [np.ones((2, 2, 1)), np.cos(angle[..., None] * order), np.sin(angle[..., None] * order)]
    assert np.abs(fourier(angle) - np.concatenate(expected, axis=-1)).max() < 1e-13


@pytest.mark.parametrize("count", [12, 13, 36, 360])
def test_twelve_samples_give_three_harmonics(count: int) -> None:
    """To a thousandth of the amplitude; in any order, by whole turns, with a closing row."""
    angle = np.arange(count) * 2 * np.pi / count + 0.1
    shuffled = np.random.default_rng(0).permutation(np.append(angle, angle[0] + 2 * np.pi)) - 4 * np.pi
    for samples in (angle, shuffled):
        assert np.abs(fourier(TURN) @ fit(samples, curve(samples)) - curve(TURN)).max() < 1e-3


def test_noisy_dense_samples_are_averaged() -> None:
    """The curve is off by the noise times the root of (terms / samples), as least squares have it."""
    random = np.random.default_rng(0)
    angle = random.uniform(0, 2 * np.pi, 50_000)
    found = fourier(TURN) @ fit(angle, curve(angle) + random.standard_normal((len(angle), 2)))
    assert np.std(found - curve(TURN)) == pytest.approx(np.sqrt(TERMS / len(angle)), rel=0.3)


def test_a_wide_gap_is_bridged_without_swinging() -> None:
    angle = np.radians(np.arange(0.0, 151.0, 10.0))
    values = curve(angle)
    bridged = fourier(TURN) @ fit(angle, values)
    margin = 0.2 * np.ptp(values, axis=0)
    assert np.all(bridged > values.min(axis=0) - margin)
    assert np.all(bridged < values.max(axis=0) + margin)
    middle = np.radians(255)  # of the gap
    assert fourier(middle) @ fit(angle, values) == pytest.approx(values[[0, -1]].mean(axis=0), abs=0.2)


def test_gaps_go_round_the_circle() -> None:
    inside, ways = gaps(np.radians([10.0, 350.0, 370.0, 100.0]))
    assert np.degrees(inside) == pytest.approx([10, 10, 100, 350])
    assert np.degrees(ways) == pytest.approx([0, 90, 250, 20], abs=1e-9)
    assert np.degrees(WIDEST_GAP) == pytest.approx(60)
