"""How sure a gain in power is, given that the joint moments behind it are recovered with error bars.

Powers of two designs under the posterior of the moments are correlated: what counts is the standard deviation
of their difference. An optimiser seeks out what the evidence leaves open, so its gains have wide ones.
"""

from __future__ import annotations

from functools import cache
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from fes_mj.optimization.cycles import WorkTable
from fes_mj.paper.evidence import load_evidence
from fes_mj.paper.reconstruction import Hyperparameters, Posterior, choose_hyperparameters, condition, fourier
from fes_mj.torque import JOINTS

_NEGLIGIBLE = 1e-9  # part of the largest variance; directions below it are rounding


class Gain(NamedTuple):
    """Power gained over another design under the same moments, and its standard deviation, W."""

    mean: float
    deviation: float

    @property
    def beyond_error(self) -> bool:
        """Whether the gain exceeds its error bar of one standard deviation."""
        return self.mean > self.deviation


@cache
def posterior(group: str) -> Posterior:
    """Posterior of a group's recovered joint moments."""
    rows = load_evidence()
    return condition([row for row in rows if row.group == group], _hyperparameters())


@cache
def _hyperparameters() -> Hyperparameters:
    return choose_hyperparameters(load_evidence())


def uncertain_table(group: str) -> WorkTable:
    """Table whose first set of moments is the posterior mean, the others its deviations.

    A power p, shape (sets,), has the mean p[0] and the standard deviation |p[1:]|.
    """
    given = posterior(group)
    variance, directions = np.linalg.eigh(given.covariance)
    large = variance > _NEGLIGIBLE * variance[-1]
    sets = np.column_stack([given.mean, directions[:, large] * np.sqrt(variance[large])])
    size = len(sets) // len(JOINTS)
    coefficients = {joint: sets[start : start + size] for joint, start in zip(JOINTS, (0, size), strict=True)}

    def moments(joint: str, angle: Any) -> NDArray[np.float64]:
        return fourier(angle) @ coefficients[joint]

    return WorkTable(moments)


def gain(power: NDArray[np.float64], baseline: NDArray[np.float64]) -> Gain:
    """Gain of one design over another, both powers by the same uncertain_table, shape (sets,)."""
    difference = power - baseline
    return Gain(float(difference[0]), float(np.linalg.norm(difference[1:])))
