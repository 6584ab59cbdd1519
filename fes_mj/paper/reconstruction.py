"""Joint moments recovered from the evidence: a periodic Gaussian process conditioned on linear measurements.

The kernel amplitude^2 exp(-2 sin^2(d / 2) / length^2) on the circle has the Fourier coefficients
exp(-1 / length^2) I_k(1 / length^2), so the process is Bayesian linear regression on a Fourier series; its posterior is
a mean and a covariance of 2 x 49 coefficients, and the variance of any power is a quadratic form.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from scipy.optimize import minimize
from scipy.special import ive

from fes_mj.common.arrays import BoolArray, FloatArray
from fes_mj.common.errors import InputError
from fes_mj.moments.fourier import HARMONICS, TERMS, fourier
from fes_mj.moments.joint_moments import RIDER_GROUPS
from fes_mj.moments.uncertainty import standard_deviation
from fes_mj.paper.evidence import Evidence, functional, of_group, of_joint

# What the Fourier series carries (fes_mj.moments.fourier), and half a turn: the likelihood's one maximum lies between.
SHORTEST_LENGTH, LONGEST_LENGTH = 0.5, 2.0
# The text's highest moment is 20 N m. Without a limit, curves of 200 N m would swallow any misprint in the evidence.
SMALLEST_AMPLITUDE, LARGEST_AMPLITUDE = 1.0, 40.0  # N m
# A row further from what the others predict contradicts them. The residual, in the row's errors, is never larger.
LARGEST_MISS = 5.0  # standard deviations


@dataclass(frozen=True)
class Hyperparameters:
    """Kernel length (of the sine of half the angle, no unit) and amplitude in N m, the same for knee and hip.

    discrepancy: N m, of a curve of its own, of the same length, by which the hip moment behind the six-bars' printed
    powers differs from the TRT's: their seat angles, 30 and 60 deg, contradict each other.
    """

    length: float
    amplitude: float
    discrepancy: float = 0.0

    def prior_variance(self) -> FloatArray:
        """Variance of each Fourier coefficient of knee, then hip, (N m)^2, shape (98,)."""
        return np.tile(self.amplitude**2 * self._spectrum, 2)

    def discrepancy_variance(self) -> FloatArray:
        """The same of the six-bars' discrepancy, which the knee does not have."""
        return np.concatenate([np.zeros(TERMS), self.discrepancy**2 * self._spectrum])

    @property
    def _spectrum(self) -> FloatArray:
        order = np.arange(HARMONICS + 1)
        spectrum = ive(order, self.length**-2) * np.where(order == 0, 1, 2)
        return np.concatenate([spectrum, spectrum[1:]])


@dataclass(frozen=True)
class Posterior:
    """Gaussian over the Fourier coefficients of knee, then hip moment of one group.

    mean: N m, shape (98,). covariance: (N m)^2, shape (98, 98).
    """

    mean: FloatArray
    covariance: FloatArray

    @classmethod
    def of(cls, curves: FloatArray) -> "Posterior":
        """Mean and covariance of curves, shape (curves, 98)."""
        return cls(curves.mean(axis=0), np.cov(curves.T))

    def predict(self, weights: FloatArray) -> tuple[float, float]:
        """Mean and standard deviation of a linear functional with the given weights, shape (98,)."""
        return float(weights @ self.mean), standard_deviation(weights, self.covariance)

    def predict_all(self, weights: FloatArray) -> tuple[FloatArray, FloatArray]:
        """The same of many functionals, weights of shape (functionals, 98)."""
        variance = np.einsum("ai,ij,aj->a", weights, self.covariance, weights)
        return weights @ self.mean, np.sqrt(variance)

    def curve(self, joint: str, crank_angle: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Mean and standard deviation of a joint's moment, N m, at crank angles from top dead centre, rad."""
        return self.predict_all(of_joint(joint, fourier(crank_angle)))


class EvidenceSystem(NamedTuple):
    """Evidence as linear measurements: weights on the Fourier coefficients (rows, 98), values and errors (rows,).

    six_bar: whether a row is a six-bar's power, shape (rows,).
    """

    weights: FloatArray
    values: FloatArray
    errors: FloatArray
    six_bar: BoolArray

    @classmethod
    def of(cls, rows: list[Evidence]) -> "EvidenceSystem":
        six_bar = [row.quantity == "power" and row.design != "trt" for row in rows]
        columns = ([functional(row) for row in rows], [row.value for row in rows], [row.error for row in rows], six_bar)
        return cls(*map(np.array, columns))

    def covariance(self, hyperparameters: Hyperparameters) -> FloatArray:
        """Of the values before they are seen, by the curves' prior and by noise, shape (rows, rows)."""
        by_curves = (self.weights * hyperparameters.prior_variance()) @ self.weights.T
        return np.asarray(by_curves + self.noise(hyperparameters))

    def noise(self, hyperparameters: Hyperparameters) -> FloatArray:
        """Covariance of the values about what the curves give, by discrepancy and errors, shape (rows, rows)."""
        apart = self.weights * self.six_bar[:, None]
        return np.asarray((apart * hyperparameters.discrepancy_variance()) @ apart.T + np.diag(self.errors**2))

    def gain(self, hyperparameters: Hyperparameters) -> FloatArray:
        """By how much each coefficient follows each value, shape (98, rows)."""
        spread = self.weights * hyperparameters.prior_variance()
        return np.linalg.solve(self.covariance(hyperparameters), spread).T

    def log_likelihood(self, hyperparameters: Hyperparameters) -> float:
        """Marginal, of the evidence."""
        total = self.covariance(hyperparameters)
        misfit = self.values @ np.linalg.solve(total, self.values)
        return float(-0.5 * (misfit + np.linalg.slogdet(2 * np.pi * total)[1]))

    def left_out(self, row: int, without: BoolArray, hyperparameters: Hyperparameters) -> tuple[float, float]:
        """Prediction of a row's value from those not `without`, and the sd of both, the row's error included."""
        total, kept = self.covariance(hyperparameters), ~without
        follows = np.linalg.solve(total[np.ix_(kept, kept)], total[kept, row])
        return float(follows @ self.values[kept]), float(np.sqrt(total[row, row] - follows @ total[kept, row]))


def reconstruct(evidence: list[Evidence]) -> tuple[Hyperparameters, dict[str, Posterior]]:
    """Recover the moments: hyperparameters of both groups together, and the posterior of each.

    Raises InputError naming the evidence that contradicts the rest.
    """
    chosen = choose_hyperparameters(evidence)
    misses: dict[str, float] = {}
    for group in RIDER_GROUPS:
        rows = of_group(evidence, group)
        misses |= dict(zip([row.name for row in rows], left_out_misses(rows, chosen).tolist(), strict=True))
    name, miss = max(misses.items(), key=lambda item: abs(item[1]))
    if abs(miss) > LARGEST_MISS:
        raise InputError(
            f"evidence {name!r} contradicts the rest: it lies {abs(miss):.1f} standard deviations from what the other "
            f"rows predict, {LARGEST_MISS:g} is allowed; correct its value, or give it the error it has"
        )
    return chosen, {group: condition(of_group(evidence, group), chosen) for group in RIDER_GROUPS}


def left_out_misses(rows: list[Evidence], hyperparameters: Hyperparameters) -> FloatArray:
    """Value less prediction from the other rows of the group, in standard deviations of both together, shape (rows,).

    Never smaller than the residual in units of the row's error, whose sign it has (Rasmussen and Williams, Gaussian
    Processes for Machine Learning, 2006, Eq. 5.12).
    """
    system = EvidenceSystem.of(rows)
    precision = np.linalg.inv(system.covariance(hyperparameters))
    return precision @ system.values / np.sqrt(np.diag(precision))


def condition(rows: list[Evidence], hyperparameters: Hyperparameters) -> Posterior:
    """Posterior of one group's curves given its evidence (Gaussian conditioning on linear measurements)."""
    system, prior = EvidenceSystem.of(rows), hyperparameters.prior_variance()
    gain = system.gain(hyperparameters)
    return Posterior(gain @ system.values, np.diag(prior) - gain @ (system.weights * prior))


def drawn_curves(
    rows: list[Evidence], hyperparameters: Hyperparameters, random: np.random.Generator, count: int
) -> FloatArray:
    """Curves from one group's posterior, N m, shape (count, 98).

    A curve of the prior, corrected by what it, with an error of its own, misses of the evidence (Matheron's rule): no
    factor of a covariance, whose sign or order would depend on the linear algebra underneath.
    """
    system, deviation = EvidenceSystem.of(rows), np.sqrt(hyperparameters.prior_variance())
    curves = deviation * random.standard_normal((count, deviation.size))
    noise = random.standard_normal((count, len(rows))) @ np.linalg.cholesky(system.noise(hyperparameters)).T
    return np.asarray(curves + (system.values - curves @ system.weights.T - noise) @ system.gain(hyperparameters).T)


def choose_hyperparameters(rows: list[Evidence]) -> Hyperparameters:
    """Maximum of the marginal likelihood of all groups together, one length and one amplitude, to three digits.

    More digits than the likelihood knows, and the same wherever the search runs.
    """
    return most_likely([EvidenceSystem.of(of_group(rows, group)) for group in RIDER_GROUPS])


def most_likely(systems: list[EvidenceSystem]) -> Hyperparameters:
    """Maximum of the marginal likelihood of these systems together; otherwise as choose_hyperparameters."""

    def cost(logs: FloatArray) -> float:
        hyperparameters = Hyperparameters(*np.exp(logs))
        return -sum(system.log_likelihood(hyperparameters) for system in systems)

    bounds = [np.log((SHORTEST_LENGTH, LONGEST_LENGTH)), np.log((SMALLEST_AMPLITUDE, LARGEST_AMPLITUDE))]
    best = minimize(cost, np.log([1.0, 13.0]), method="L-BFGS-B", bounds=bounds)
    return Hyperparameters(*(float(f"{value:.3g}") for value in np.exp(best.x)))
