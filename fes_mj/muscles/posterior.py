"""Riders weighed by how well they explain a measurement."""

from typing import NamedTuple

import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.muscles.riders import Riders

MEMBERS = 200  # riders that a posterior is kept as
_LEAST_EFFECTIVE = 100  # riders by whose spread the next ones are proposed


class WeighedRiders(NamedTuple):
    """Weighed riders; log_weights: up to a constant, -inf for one that cannot be, shape (riders,)."""

    riders: Riders
    log_weights: FloatArray

    @property
    def weights(self) -> FloatArray:
        return np.asarray(np.exp(self.log_weights - self.log_weights.max()))

    @property
    def effective(self) -> float:
        """How many independent riders the weighed ones are worth."""
        return float(self.weights.sum() ** 2 / np.sum(self.weights**2))

    def members(self, count: int) -> Riders:
        """So many riders, each as likely as any other: at even steps of the weights' sum."""
        steps, weights = (np.arange(count) + 0.5) / count, self.weights
        return self.riders.taken(np.searchsorted(np.cumsum(weights) / weights.sum(), steps))

    def flattened(self, enough: float = _LEAST_EFFECTIVE) -> "WeighedRiders":
        """The same with weights so flat that enough riders count to say where to look, or half of those that can be."""
        flat, enough = self, min(enough, np.isfinite(self.log_weights).sum() / 2)
        power = 1.0
        while flat.effective < enough:
            power *= 0.8
            flat = self._replace(log_weights=power * (self.log_weights - self.log_weights.max()))
        return flat
