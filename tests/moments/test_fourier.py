"""The Fourier series against cosines and sines one by one, and curves through samples against what they sample."""

import numpy as np
import pytest

from fes_mj.common.arrays import FloatArray
from fes_mj.moments.fourier import HARMONICS, WIDEST_GAP, fit_fourier, fourier, gaps

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
        assert np.abs(fourier(TURN) @ fit_fourier(samples, curve(samples)) - curve(TURN)).max() < 1e-3


@pytest.mark.parametrize(
    ("count", "noise"), [(36, 0.1), (36, 1.0), (200, 0.3), pytest.param(50_000, 1.0, marks=pytest.mark.long)]
)
def test_noisy_samples_are_averaged(count: int, noise: float) -> None:
    """Without knowing that the curve has three harmonics, it is found almost as well as least squares that know it."""
    random, misses, least = np.random.default_rng(0), [], []
    few = [0, 1, 2, 3, *range(HARMONICS + 1, HARMONICS + 4)]
    for _ in range(10):
        angle = np.arange(count) * 2 * np.pi / count + random.uniform(0, 0.1, count)
        values = curve(angle) + noise * random.standard_normal((count, 2))
        misses.append(fourier(TURN) @ fit_fourier(angle, values) - curve(TURN))
        least.append(fourier(TURN)[:, few] @ np.linalg.lstsq(fourier(angle)[:, few], values)[0] - curve(TURN))
    assert np.std(misses) < 1.7 * np.std(least)


@pytest.mark.parametrize("span", [6.0, 60.0, 180.0, 300.0, 360.0])
@pytest.mark.parametrize("count", [6, 12, 20, 36, 60, 400])
def test_no_curve_swings_far_beyond_its_samples(count: int, span: float) -> None:
    """Wherever they are, near each other or far apart, and however noisy; a fit's curves know nothing of each other."""
    random, noise = np.random.default_rng(count), np.repeat([0.0, 0.01, 0.3, 2.0], 2)
    for _ in range(5):
        angle = np.radians(random.uniform(0, span, count))
        values = np.tile(curve(angle), 4) + noise * random.standard_normal((count, 8))
        fitted = fourier(TURN) @ fit_fourier(angle, values)
        margin = 0.35 * np.ptp(values, axis=0)
        assert np.all((fitted > values.min(axis=0) - margin) & (fitted < values.max(axis=0) + margin))


def test_the_same_moment_everywhere_stays_what_it_is() -> None:
    angle = np.radians([0.0, 1.0, 100.0, 200.0])
    assert fourier(TURN) @ fit_fourier(angle, np.tile([0.0, 5.0], (4, 1))) == pytest.approx(
        np.tile([0.0, 5.0], (721, 1))
    )


def test_a_wide_gap_is_bridged_without_swinging() -> None:
    angle = np.radians(np.arange(0.0, 151.0, 10.0))
    values = curve(angle)
    bridged = fourier(TURN) @ fit_fourier(angle, values)
    margin = 0.2 * np.ptp(values, axis=0)
    assert np.all(bridged > values.min(axis=0) - margin)
    assert np.all(bridged < values.max(axis=0) + margin)
    middle = np.radians(255)  # of the gap
    assert fourier(middle) @ fit_fourier(angle, values) == pytest.approx(values[[0, -1]].mean(axis=0), abs=0.2)


def test_gaps_go_round_the_circle() -> None:
    inside, ways = gaps(np.radians([10.0, 350.0, 370.0, 100.0]))
    assert np.degrees(inside) == pytest.approx([10, 10, 100, 350])
    assert np.degrees(ways) == pytest.approx([0, 90, 250, 20], abs=1e-9)
    assert np.degrees(WIDEST_GAP) == pytest.approx(60)
