"""What a measurement says of a rider's muscles: riders of the prior, weighed by how well they explain it.

Muscles, passive moments and residual explain measured numbers that are linear in the joint moments. Given all else
these are linear in the groups' strengths as well, which are drawn from their Gaussian given all else; what is left is
weighed by the marginal likelihood. Riders are proposed where earlier ones weighed most (adaptive importance sampling:
Cappe et al., J. Comput. Graph. Stat. 13 (2004) 907-929).
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from fes_mj.common.arrays import FloatArray, IntArray
from fes_mj.common.errors import InputError
from fes_mj.linkage import kinematics
from fes_mj.linkage.joints import PerJoint
from fes_mj.moments.fourier import HARMONICS
from fes_mj.moments.reference_tricycle import PAPER_TRICYCLE, ReferenceTricycle
from fes_mj.moments.uncertainty import power_weights
from fes_mj.muscles.anatomy import MUSCLE_GROUPS
from fes_mj.muscles.passive import passive_moments
from fes_mj.muscles.posterior import WeighedRiders
from fes_mj.muscles.prior import priors, quantile, ramp
from fes_mj.muscles.pull import pull
from fes_mj.muscles.residual import Residual
from fes_mj.muscles.riders import Riders
from fes_mj.muscles.timing import Windows, responded

DOUBTS = "are signs, units, zero and tricycle as declared, and does nothing but stimulated legs move the crank?"
WHOLE = -1  # in place of a group: the whole moment, with passive part and residual
STRENGTHS = [f"{group}_strength" for group in MUSCLE_GROUPS]
_POINTS = 120  # crank angles: against three times as many a power changes by 1e-3 of itself, a tenth of its error
_TURN = np.arange(_POINTS) * (2 * np.pi / _POINTS)  # from the most bent knee
_BLOCK = 200  # riders at once
STAGES = 5
STRENGTH_DRAWS = 10  # of the strengths of each
_FROM_PRIOR = 0.1  # share of the proposals, so that no weight is large where nobody looked


class Measured(NamedTuple):
    """Numbers that are linear in the Fourier coefficients of knee and hip moment, and the tricycle they belong to.

    weights: shape (rows, 98). group: number of the group whose moments alone a row is of, or WHOLE, shape (rows,).
    values: shape (rows,), and covariance of their errors, shape (rows, rows).
    """

    weights: FloatArray
    group: IntArray
    values: FloatArray
    covariance: FloatArray
    reference: ReferenceTricycle = PAPER_TRICYCLE

    @property
    def residual(self) -> Residual:
        """The residual as the rows see it: loss of shape (rows,), covariance (rows, rows)."""
        motion = kinematics.solve(self.reference.design)
        residual = Residual.on(power_weights(motion, self.reference.cadence, self.reference))
        rows = self.weights * (self.group == WHOLE)[:, None]
        return Residual(rows @ residual.loss, rows @ residual.covariance @ rows.T)


def moment_coefficients(moment: PerJoint[FloatArray]) -> FloatArray:
    """Fourier coefficients (moments.fourier) of moments over uniform angles, knee's then hip's: shape (..., 98)."""

    def of_joint(curve: FloatArray) -> FloatArray:
        spectrum = np.fft.rfft(curve)[..., : HARMONICS + 1] * (2 / curve.shape[-1])
        return np.concatenate([spectrum.real[..., :1] / 2, spectrum.real[..., 1:], -spectrum.imag[..., 1:]], axis=-1)

    return np.concatenate([*moment.map(of_joint)], axis=-1)


@dataclass(frozen=True, eq=False)
class Candidates:
    """Riders and what a measurement of each would give.

    by_strength: values per strength of each group, shape (riders, rows, groups). explained: values by passive moments,
    where they count, and loss, shape (riders, rows). covariance: of the values about these, (riders, rows, rows).
    """

    riders: Riders
    by_strength: FloatArray
    explained: FloatArray
    covariance: FloatArray

    @classmethod
    def of(cls, riders: Riders, measured: Measured, advance: Callable[[int], None] = lambda _: None) -> "Candidates":
        """These riders, on the tricycle of the measurement; advance: called with the number of riders just seen."""
        values, parts = riders.values, []
        for start in range(0, len(riders), _BLOCK):
            block = riders.taken(slice(start, start + _BLOCK))
            parts.append(_seen(block, measured))
            advance(len(block))
        by_strength, passive = (np.concatenate(part) for part in zip(*parts, strict=True))
        explained = values["passive_included"][:, None] * passive
        residual = measured.residual
        explained += values["residual_loss_W"][:, None] * residual.loss
        variance = values["residual_sd_Nm"][:, None, None] ** 2
        return cls(riders, by_strength, explained, variance * residual.covariance + measured.covariance)

    def simulated(self, row: int, random: np.random.Generator) -> FloatArray:
        """What a measurement of one of the riders gives, with a residual and errors of its own, shape (rows,)."""
        strength = np.array([self.riders.values[name][row] for name in STRENGTHS])
        scatter = np.linalg.cholesky(self.covariance[row]) @ random.standard_normal(self.explained.shape[1])
        return np.asarray(self.by_strength[row] @ strength + self.explained[row] + scatter)

    def posterior(self, values: FloatArray, scores: FloatArray) -> tuple[Riders, FloatArray]:
        """The riders with strengths drawn given the measured values, and the logarithm of their likelihood without.

        scores: standard normal numbers for the strengths, shape (draws, riders, groups). Negative strengths are
        impossible: of the draws the first without counts, and the share of these belongs to the likelihood.
        """
        mean, deviation = np.array([priors()[name]["normal"] for name in STRENGTHS]).T
        spread = self.by_strength * deviation
        total = self.covariance + spread @ np.swapaxes(spread, 1, 2)
        apart = values - self.explained - self.by_strength @ mean
        gain = np.swapaxes(np.linalg.solve(total, spread * deviation), 1, 2)
        remaining = np.diag(deviation**2) - gain @ (spread * deviation)
        remaining_spread = np.linalg.cholesky((remaining + np.swapaxes(remaining, 1, 2)) / 2)
        changes = np.einsum("ngr,nr->ng", gain, apart) + np.einsum("ngh,dnh->dng", remaining_spread, scores)
        possible = (mean + changes > 0).all(axis=-1)
        change = changes[possible.argmax(axis=0), np.arange(len(self.riders))]
        strengths = mean + change
        fits = apart - np.einsum("nrg,ng->nr", self.by_strength, change)
        joint = _log_density(fits, self.covariance) - np.sum((change / deviation) ** 2, axis=1) / 2
        quantities = dict(self.riders.values) | dict(zip(STRENGTHS, strengths.T, strict=True))
        with np.errstate(divide="ignore"):
            share = np.log(possible.mean(axis=0))
        return replace(self.riders, values=quantities, likelihood=joint), _log_density(apart, total) + share


def _seen(riders: Riders, measured: Measured) -> tuple[FloatArray, FloatArray]:
    """Candidates.by_strength of riders, and values by passive moments, shape (riders, rows)."""
    unit = replace(riders, values=dict(riders.values) | {name: np.ones(len(riders)) for name in STRENGTHS})
    reference, weights = measured.reference, measured.weights
    cadence = np.full((1, 1), reference.cadence)
    motion = kinematics.solve(reference.design, _TURN + reference.top_dead_centre)
    on, width = np.moveaxis(riders.windows(), -1, 0)[..., None]
    stimulation = Windows(on, width).at(_TURN - cadence * riders["delay_s"], cadence * ramp())
    activation = responded(stimulation, riders, cadence)
    moment = pull(unit, motion, reference.cadence).moment.map(lambda moment: (activation * moment)[:, :, 0])
    by_group = np.einsum("rf,gmf->mrg", weights, moment_coefficients(moment))
    counts = (measured.group[:, None] == WHOLE) | (measured.group[:, None] == np.arange(len(MUSCLE_GROUPS)))
    passive = passive_moments(riders.flexion(motion))
    return by_group * counts, moment_coefficients(passive)[:, 0] @ weights.T * (measured.group == WHOLE)


def _log_density(apart: FloatArray, covariance: FloatArray) -> FloatArray:
    """Of Gaussian numbers this far from their means, shape (riders, rows), up to a constant."""
    solved = np.linalg.solve(covariance, apart[..., None])[..., 0]
    return np.asarray(-(np.sum(apart * solved, axis=-1) + np.linalg.slogdet(covariance)[1]) / 2)


def identify_riders(
    measured: Measured,
    random: np.random.Generator,
    count: int,
    name: str = "",
    advance: Callable[[int], None] = lambda _: None,
) -> WeighedRiders:
    """What is known of a rider after a measurement: so many candidates at each of STAGES, the last weighed.

    name: of the riders; advance: called with the number of candidates just seen.
    """

    def seen(riders: Riders) -> Candidates:
        return Candidates.of(replace(riders, measured_on=measured.reference), measured, advance)

    return weighed(seen, measured.values, random, count, name)


def weighed(
    seen: Callable[[Riders], Candidates], measured: FloatArray, random: np.random.Generator, count: int, name: str
) -> WeighedRiders:
    """The same of any numbers, shape (rows,); seen: what these would be of riders with strengths of 1."""
    quantities = [name for name in priors() if name not in STRENGTHS]
    centre, spread = np.zeros(len(quantities)), np.eye(len(quantities))
    for stage in range(STAGES):
        of_prior = random.standard_normal((count, len(quantities)))
        there = centre + of_prior @ np.linalg.cholesky(spread).T
        scores = np.where(random.random((count, 1)) < _FROM_PRIOR, of_prior, there) if stage else of_prior
        values = {name: quantile(name, column) for name, column in zip(quantities, scores.T, strict=True)}
        unit = {name: np.ones(count) for name in STRENGTHS}
        candidates = seen(Riders(name, unit | values, np.zeros(count)))
        numbers = random.standard_normal((STRENGTH_DRAWS, count, len(MUSCLE_GROUPS)))
        riders, likelihood = candidates.posterior(measured, numbers)
        # a proposal's density per that of the prior
        ratio = np.exp(_log_density(scores - centre, spread) + np.sum(scores**2, axis=1) / 2)
        log_weight = likelihood - np.log(_FROM_PRIOR + (1 - _FROM_PRIOR) * ratio)
        if np.isfinite(log_weight).sum() < 2 * len(quantities):
            raise InputError(f"{name}: no muscles that pull can have given these numbers: {DOUBTS}")
        posterior = WeighedRiders(riders, log_weight)
        weights = posterior.flattened().weights
        centre, spread = np.average(scores, axis=0, weights=weights), np.cov(scores.T, aweights=weights)
    return posterior
