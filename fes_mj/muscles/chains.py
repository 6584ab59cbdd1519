"""Riders of a posterior that is sharper than importance sampling resolves: Markov chains, one from each rider.

Metropolis, with what is random in the likelihood kept while a rider stays (pseudo-marginal: Andrieu and Roberts, Ann.
Stat. 37 (2009) 697-725); so strengths that are drawn with a rider belong to it.
"""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.muscles.anatomy import MUSCLE_GROUPS
from fes_mj.muscles.identification import STRENGTH_DRAWS, STRENGTHS, Candidates, Measured
from fes_mj.muscles.prior import normal_score, priors, quantile
from fes_mj.muscles.riders import Riders

_STEP = 2.38  # of a step per root of the dimensions, in standard deviations (Roberts, Gelman and Gilks 1997)
_QUANTITIES = [name for name in priors() if name not in STRENGTHS]


def moved(
    riders: Riders,
    measured: Measured,
    random: np.random.Generator,
    steps: int,
    advance: Callable[[int], None] = lambda _: None,
) -> Riders:
    """The riders after so many steps; advance: called with the number of riders that were just looked at."""
    scores = np.stack([normal_score(name, riders.values[name]) for name in _QUANTITIES], axis=1)
    here, density = _looked_at(riders, scores, measured, random)
    for _ in range(steps):
        # of where the chains are: it is wider than the posterior at first, and has its shape in the end
        shape = np.linalg.cholesky(np.cov(scores.T) + 1e-6 * np.eye(len(_QUANTITIES)))
        far = _STEP / np.sqrt(len(_QUANTITIES)) * random.choice([0.1, 0.4, 1.0], (len(riders), 1))
        tried = scores + far * random.standard_normal(scores.shape) @ shape.T
        there, its_density = _looked_at(riders, tried, measured, random)
        goes = np.log(random.random(len(riders))) + density < its_density
        scores, density = np.where(goes[:, None], tried, scores), np.where(goes, its_density, density)
        values = {name: np.where(goes, there.values[name], column) for name, column in here.values.items()}
        here = replace(here, values=values, likelihood=np.where(goes, there.likelihood, here.likelihood))
        advance(len(riders))
    return here


def _looked_at(
    riders: Riders, scores: FloatArray, measured: Measured, random: np.random.Generator
) -> tuple[Riders, FloatArray]:
    """Riders at these scores with strengths drawn, and the logarithm of their density, shape (riders,)."""
    values = {name: quantile(name, column) for name, column in zip(_QUANTITIES, scores.T, strict=True)}
    unit = {name: np.ones(len(scores)) for name in STRENGTHS}
    numbers = random.standard_normal((STRENGTH_DRAWS, len(scores), len(MUSCLE_GROUPS)))
    there, likelihood = Candidates.of(replace(riders, values=unit | values), measured).posterior(
        measured.values, numbers
    )
    return there, likelihood - np.sum(scores**2, axis=1) / 2
