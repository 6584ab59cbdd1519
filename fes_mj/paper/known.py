"""What is known of the joint moments: evidence, curves before and after the text, predictions to judge them by."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.moments.joint_moments import GROUPS
from fes_mj.moments.samples import sampled_coefficients
from fes_mj.paper.evidence import Evidence, of_group
from fes_mj.paper.left_out import LeftOut, left_out
from fes_mj.paper.reconstruction import Hyperparameters, Posterior, draw, reconstruct

STAGES = ("numbers alone", "with the text")
_SEED = 2022
_CURVES = 2000  # of the numbers alone


class Stage(NamedTuple):
    """By group: mean and covariance, and curves drawn from what is known, N m, shape (curves, 98)."""

    posteriors: dict[str, Posterior]
    curves: dict[str, FloatArray]


@dataclass(frozen=True, eq=False)
class Known:
    """numbers: by the evidence alone; text: with what the text says of the figures, the curves that ship."""

    evidence: list[Evidence]
    hyperparameters: Hyperparameters
    numbers: Stage
    text: Stage
    predictions: list[LeftOut]

    @property
    def stages(self) -> tuple[Stage, Stage]:
        return self.numbers, self.text


def known(evidence: list[Evidence]) -> Known:
    """From the evidence and from the curves that ship."""
    random, (hyperparameters, posteriors) = np.random.default_rng(_SEED), reconstruct(evidence)
    before = {group: draw(of_group(evidence, group), hyperparameters, random, _CURVES) for group in GROUPS}
    after = {group: sampled_coefficients(group) for group in GROUPS}
    told = {group: Posterior.of(curves) for group, curves in after.items()}
    predictions = left_out(evidence, hyperparameters)
    return Known(evidence, hyperparameters, Stage(posteriors, before), Stage(told, after), predictions)
