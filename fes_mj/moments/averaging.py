"""The mean of the turns of a measurement, and its covariance: of turns, trials or riders, and by what is declared."""

from collections.abc import Hashable, Iterator, Sequence
from dataclasses import replace

import numpy as np

from fes_mj.common.arrays import BoolArray, FloatArray
from fes_mj.linkage.kinematics import solve, uniform_turn
from fes_mj.linkage.variables import component, replaced
from fes_mj.moments.fourier import fit_fourier
from fes_mj.moments.reference_tricycle import ReferenceTricycle
from fes_mj.moments.turn import Turn
from fes_mj.moments.uncertainty import power_weights

# One standard deviation of what is declared: lengths by tape on a seated person, a crank by its stamp, m; degrees.
DECLARED_ERRORS = {"R1x": 0.01, "R1y": 0.01, "R2": 0.001, "R6": 0.01, "thigh": 0.01, "shank": 0.01, "seat_angle": 1.0}
CADENCE_ERROR = 0.02  # of the cadence, where no time is recorded
_POINTS = 720  # of sums over the turn
_WINDOW = 7  # samples within which a spike stands alone
_SPIKE = 8.0  # standard deviations of the window about its median
_LEAST_SPIKE = 0.25  # of the moment's range over the turn
_NORMAL = 1.4826  # standard deviation per median absolute deviation


def spikes(values: FloatArray) -> BoolArray:
    """Which samples of a turn, in order, stand alone: Hampel's identifier (1974); shape (n,), bool."""
    if len(values) < 2 * _WINDOW:
        return np.zeros(len(values), bool)
    around = np.lib.stride_tricks.sliding_window_view(np.pad(values, _WINDOW // 2, mode="wrap"), _WINDOW)
    middle = np.median(around, axis=1)
    spread = _NORMAL * np.median(np.abs(around - middle[:, None]), axis=1)
    spread = np.maximum(spread, np.median(spread))  # seven samples of noise can happen to lie close together
    low, high = np.quantile(values, [0.05, 0.95])
    away = np.abs(values - middle)
    return np.asarray((away > _SPIKE * spread) & (away > _LEAST_SPIKE * (high - low)))


def without_spikes(turn: Turn) -> tuple[Turn, int]:
    """A turn without the samples in which either moment is a spike, and how many they were."""
    order = np.argsort(np.mod(turn.crank_angle, 2 * np.pi), kind="stable")
    alone = np.zeros(len(order), bool)
    alone[order] = np.logical_or(spikes(turn.knee[order]), spikes(turn.hip[order]))
    kept = ~alone
    cleaned = replace(turn, crank_angle=turn.crank_angle[kept], knee=turn.knee[kept], hip=turn.hip[kept])
    return cleaned, int(alone.sum())


def turn_coefficients(turn: Turn) -> FloatArray:
    """Of the Fourier series of a turn's moments, knee's then hip's, N m, shape (98,)."""
    return np.ravel(fit_fourier(turn.crank_angle, np.column_stack([turn.knee, turn.hip])).T)


def mean_of(rows: FloatArray, sources: Sequence[tuple[str, str]], weights: FloatArray) -> tuple[FloatArray, FloatArray]:
    """The mean of two turns or more with these coefficients, shape (turns, 98), and its covariance.

    sources: rider and trial of each. weights: of the mean power in the coefficients. Turns of a trial, trials of a
    rider and riders count the same; the error is the scatter of turns, of trials or of riders, of whichever it is the
    largest for the power, each widened by Student's factor: few know their own scatter badly.
    """
    levels = [rows]
    for keys in ([*sources], [(rider, "") for rider, _ in dict.fromkeys(sources)]):
        levels.append(np.stack([*_grouped(levels[-1], keys)]))
    errors = [covariance for level in levels if (covariance := _of_mean(level)) is not None]
    largest = max(errors, key=lambda covariance: float(weights @ covariance @ weights))
    return levels[-1].mean(axis=0), largest


def _grouped(rows: FloatArray, keys: Sequence[Hashable]) -> Iterator[FloatArray]:
    """The mean of the rows with each key."""
    for key in dict.fromkeys(keys):
        yield rows[[place for place, other in enumerate(keys) if other == key]].mean(axis=0)


def _of_mean(rows: FloatArray) -> FloatArray | None:
    """Covariance of the mean of rows by their scatter; one deviation holds 68 %, however few they are."""
    if len(rows) < 2:
        return None
    return np.asarray(few_factor(len(rows)) ** 2 * np.cov(rows.T) / len(rows))


def few_factor(count: int) -> float:
    """Student's factor by which the standard error of the mean of so many (two or more) is widened."""
    from scipy.special import ndtr, stdtrit

    return float(stdtrit(count - 1, ndtr(1.0)))


def weights_on(measured_on: ReferenceTricycle) -> FloatArray:
    """Of the mean power in the tricycle of the measurement, per coefficient of the moments, W/(N m), shape (98,)."""
    motion = solve(measured_on.design, uniform_turn(_POINTS))
    return power_weights(motion, measured_on.cadence, measured_on)


def declared_power_sd(mean: FloatArray, measured_on: ReferenceTricycle, timed: bool) -> float:
    """What the errors of tape measure and cadence add to the mean power, W: first order, one after the other.

    mean: coefficients, shape (98,). timed: whether the cadence is recorded.
    """
    power = float(weights_on(measured_on) @ mean)
    parts = [0.0 if timed else CADENCE_ERROR * power]
    design = measured_on.design
    for name, error in DECLARED_ERRORS.items():
        for step in (error, -error):  # one of them can lead to a tricycle that does not turn
            changed = ReferenceTricycle(replaced(design, {name: component(design, name) + step}), measured_on.cadence)
            part = float(weights_on(changed) @ mean) - power
            if np.isfinite(part):
                parts.append(part)
                break
    return float(np.linalg.norm(parts))


def with_power_sd(covariance: FloatArray, weights: FloatArray, deviation: float) -> FloatArray:
    """A covariance in which the power of these weights has another independent error, W, and nothing else has."""
    direction = weights / float(weights @ weights)
    return np.asarray(covariance + deviation**2 * np.outer(direction, direction))
