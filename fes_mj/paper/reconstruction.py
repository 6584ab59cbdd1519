"""Joint moments recovered from the evidence: a periodic Gaussian process conditioned on linear measurements.

The kernel amplitude^2 exp(-2 sin^2(d / 2) / length^2) on the circle has the Fourier coefficients
exp(-1 / length^2) I_k(1 / length^2), so the process is Bayesian linear regression on a Fourier series; its posterior is
a mean and a covariance of 2 x 49 coefficients, and the variance of any power is a quadratic form.
"""

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from scipy.optimize import minimize
from scipy.special import ive

from fes_mj.arrays import FloatArray
from fes_mj.errors import InputError
from fes_mj.fourier import HARMONICS, TERMS, fourier
from fes_mj.joints import JOINTS
from fes_mj.moments import GROUPS, JointMoments
from fes_mj.paper.evidence import Evidence, functional
from fes_mj.uncertainty import standard_deviation

# A mean curve over a group of riders is smooth. The marginal likelihood hardly tells lengths apart between 0.25 and 1.2
# (1 of log-likelihood), so shorter ones, which wiggle within 30 deg of crank angle, are excluded, and of its two equal
# maxima (0.85, and 0.5 at the bound, higher by 0.1) the smooth one is taken.
SHORTEST_LENGTH, LONGEST_LENGTH = 0.5, 2.0
# The text's highest moment is 20 N m. Without a limit, curves of 200 N m would swallow any misprint in the evidence.
SMALLEST_AMPLITUDE, LARGEST_AMPLITUDE = 1.0, 40.0  # N m
# A row further from what the others predict contradicts them. The residual, in the row's errors, is never larger.
LARGEST_MISS = 5.0  # standard deviations


@dataclass(frozen=True)
class Hyperparameters:
    """Kernel length (of the sine of half the angle, no unit) and amplitude in N m, the same for knee and hip."""

    length: float
    amplitude: float

    def prior_variance(self) -> FloatArray:
        """Variance of each Fourier coefficient of knee, then hip, (N m)^2, shape (98,)."""
        order = np.arange(HARMONICS + 1)
        spectrum = self.amplitude**2 * ive(order, self.length**-2) * np.where(order == 0, 1, 2)
        curve = np.concatenate([spectrum, spectrum[1:]])
        return np.concatenate([curve, curve])


@dataclass(frozen=True)
class Posterior:
    """Gaussian over the Fourier coefficients of knee, then hip moment of one group.

    mean: N m, shape (98,). covariance: (N m)^2, shape (98, 98). log_likelihood: marginal, of the evidence.
    """

    mean: FloatArray
    covariance: FloatArray
    log_likelihood: float

    def predict(self, weights: FloatArray) -> tuple[float, float]:
        """Mean and standard deviation of a linear functional with the given weights, shape (98,)."""
        return float(weights @ self.mean), standard_deviation(weights, self.covariance)

    def curve(self, joint: str, crank_angle: Any) -> tuple[FloatArray, FloatArray]:
        """Mean and standard deviation of a joint's moment, N m, at crank angles from top dead centre, rad."""
        features, start = fourier(crank_angle), JOINTS.index(joint) * TERMS
        part = slice(start, start + TERMS)
        variance = np.einsum("...i,ij,...j->...", features, self.covariance[part, part], features)
        return features @ self.mean[part], np.sqrt(variance)

    def moments(self, name: str) -> JointMoments:
        """The mean curves at every degree of crank angle, with their covariance."""
        degrees = np.arange(360.0)
        knee, hip = (self.curve(joint, np.radians(degrees))[0] for joint in JOINTS)
        return JointMoments(name, np.radians(degrees), knee, hip, self.covariance)


class Reconstruction(NamedTuple):
    """Hyperparameters of both groups together, and the posterior of each."""

    hyperparameters: Hyperparameters
    posteriors: dict[str, Posterior]


def reconstruct(evidence: list[Evidence]) -> Reconstruction:
    """Recover the moments of every group. Raises InputError naming the evidence that contradicts the rest."""
    chosen = choose_hyperparameters(evidence)
    misses: dict[str, float] = {}
    for group in GROUPS:
        rows = [row for row in evidence if row.group == group]
        misses |= dict(zip([row.name for row in rows], left_out_misses(rows, chosen).tolist(), strict=True))
    name, miss = max(misses.items(), key=lambda item: abs(item[1]))
    if abs(miss) > LARGEST_MISS:
        raise InputError(
            f"evidence {name!r} contradicts the rest: it lies {abs(miss):.1f} standard deviations from what the other "
            f"rows predict, {LARGEST_MISS:g} is allowed; correct its value, or give it the error it has"
        )
    posteriors = {group: condition([row for row in evidence if row.group == group], chosen) for group in GROUPS}
    return Reconstruction(chosen, posteriors)


def left_out_misses(rows: list[Evidence], hyperparameters: Hyperparameters) -> FloatArray:
    """Value less prediction from the other rows of the group, in standard deviations of both together, shape (rows,).

    Never smaller than the residual in units of the row's error, whose sign it has (Rasmussen and Williams, Gaussian
    Processes for Machine Learning, 2006, Eq. 5.12).
    """
    weights, values, errors = _system(rows)
    precision = np.linalg.inv(_evidence_covariance(weights, errors, hyperparameters))
    return precision @ values / np.sqrt(np.diag(precision))


def condition(rows: list[Evidence], hyperparameters: Hyperparameters) -> Posterior:
    """Posterior of one group's curves given its evidence (Gaussian conditioning on linear measurements)."""
    return _condition(*_system(rows), hyperparameters)


def choose_hyperparameters(rows: list[Evidence]) -> Hyperparameters:
    """Smooth maximum of the marginal likelihood of all groups together, one length and one amplitude."""
    systems = [_system([row for row in rows if row.group == group]) for group in GROUPS]

    def cost(logs: FloatArray) -> float:
        hyperparameters = Hyperparameters(*np.exp(logs))
        return -sum(_condition(*system, hyperparameters).log_likelihood for system in systems)

    bounds = [np.log((SHORTEST_LENGTH, LONGEST_LENGTH)), np.log((SMALLEST_AMPLITUDE, LARGEST_AMPLITUDE))]
    best = minimize(cost, np.log([1.0, 13.0]), method="L-BFGS-B", bounds=bounds)
    return Hyperparameters(*(float(value) for value in np.exp(best.x)))


def _system(rows: list[Evidence]) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Weights (rows, 98), values and errors (rows,) of the evidence."""
    weights, values, errors = zip(*(functional(row) for row in rows), strict=True)
    return np.array(weights), np.array(values), np.array(errors)


def _condition(
    weights: FloatArray, values: FloatArray, errors: FloatArray, hyperparameters: Hyperparameters
) -> Posterior:
    prior = hyperparameters.prior_variance()
    spread = weights * prior
    total = _evidence_covariance(weights, errors, hyperparameters)
    gain = np.linalg.solve(total, spread).T
    log_likelihood = -0.5 * (values @ np.linalg.solve(total, values) + np.linalg.slogdet(2 * np.pi * total)[1])
    return Posterior(gain @ values, np.diag(prior) - gain @ spread, float(log_likelihood))


def _evidence_covariance(weights: FloatArray, errors: FloatArray, hyperparameters: Hyperparameters) -> FloatArray:
    """Of the evidence before it is seen: by the curves' prior and by its own errors, shape (rows, rows)."""
    return (weights * hyperparameters.prior_variance()) @ weights.T + np.diag(errors**2)
