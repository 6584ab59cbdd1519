"""What is known of the joint moments: evidence, curves before and after the text, and predictions to judge them by.

A printed power predicted from the other evidence misses by some of its own standard deviations: its score.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.linkage.design import Design
from fes_mj.linkage.design_file import SIX_BARS, load_design
from fes_mj.linkage.kinematics import solve
from fes_mj.linkage.variables import LENGTHS, replaced
from fes_mj.moments.files import sampled_coefficients
from fes_mj.moments.joint_moments import RIDER_GROUPS
from fes_mj.moments.reference_tricycle import PAPER_TRICYCLE
from fes_mj.moments.uncertainty import power_weights
from fes_mj.paper.evidence import Evidence, functional, of_group
from fes_mj.paper.identification import LENGTH_ROUNDING, inside_rounding
from fes_mj.paper.reconstruction import EvidenceSystem, Hyperparameters, Posterior, condition, drawn_curves, reconstruct
from fes_mj.paper.statements import allowed_curves

BASES = ("numbers alone", "with the text")
_SEED = 2022
_CURVES = 2000  # of the numbers alone
_LEFT_OUT_CURVES = 500  # a prediction with the text
_LINKAGES = 200  # drawn inside the rounding of Table 2


class Recovered(NamedTuple):
    """By group: mean and covariance, and curves drawn from what is known, N m, shape (curves, 98)."""

    posteriors: dict[str, Posterior]
    curves: dict[str, FloatArray]


class LeftOut(NamedTuple):
    """A printed power beside its prediction from other evidence, W; title: what was left out, in words.

    numbers, text: mean and standard deviation, by the numbers alone and with what the text says of the figures.
    """

    row: Evidence
    title: str
    numbers: tuple[float, float]
    text: tuple[float, float]

    @property
    def scores(self) -> list[float]:
        """By how many standard deviations of prediction and print together each is off."""
        return [float((mean - self.row.value) / np.hypot(sd, self.row.error)) for mean, sd in (self.numbers, self.text)]


@dataclass(frozen=True, eq=False)
class Known:
    """numbers: by the evidence alone; text: with what the text says of the figures, the curves that ship."""

    evidence: list[Evidence]
    hyperparameters: Hyperparameters
    numbers: Recovered
    text: Recovered
    predictions: list[LeftOut]

    @property
    def by_basis(self) -> dict[str, Recovered]:
        """In words."""
        return dict(zip(BASES, (self.numbers, self.text), strict=True))

    @cached_property
    def rounding(self) -> dict[tuple[str, str], FloatArray]:
        """By design and group: change of power, W, over linkages inside Table 2's rounding that move as Table 1 says.

        Shape (linkages,) each.
        """
        changes: dict[tuple[str, str], FloatArray] = {}
        random = np.random.default_rng(_SEED)
        for name in SIX_BARS:
            drawn = inside_rounding(name, dict.fromkeys(LENGTHS, LENGTH_ROUNDING), random, _LINKAGES)
            printed, rows = load_design(name, "printed"), zip(*drawn.values(), strict=True)
            weights = np.array([weights_of(replaced(printed, dict(zip(drawn, row, strict=True)))) for row in rows])
            for group, posterior in self.text.posteriors.items():
                changes[name, group] = (weights - weights_of(load_design(name))) @ posterior.mean
        return changes


def known(evidence: list[Evidence]) -> Known:
    """From the evidence and from the curves that ship."""
    random, (hyperparameters, posteriors) = np.random.default_rng(_SEED), reconstruct(evidence)
    before = {
        group: drawn_curves(of_group(evidence, group), hyperparameters, random, _CURVES) for group in RIDER_GROUPS
    }
    after = {group: sampled_coefficients(group) for group in RIDER_GROUPS}
    with_text = Recovered({group: Posterior.of(curves) for group, curves in after.items()}, after)
    predictions = left_out(evidence, hyperparameters)
    return Known(evidence, hyperparameters, Recovered(posteriors, before), with_text, predictions)


def weights_of(design: Design) -> FloatArray:
    """Mean power per coefficient, W/(N m), shape (98,)."""
    return power_weights(solve(design), design.linkage.cadence, PAPER_TRICYCLE)


def left_out(evidence: list[Evidence], hyperparameters: Hyperparameters) -> list[LeftOut]:
    """Every printed power predicted without itself; the TRT's also without its twin, the 15 W item."""
    predictions = []
    for row, title, without in _leave_outs(evidence):
        others = [other for other in of_group(evidence, row.group) if other.name not in without]
        curves, _ = allowed_curves(others, row.group, hyperparameters, _LEFT_OUT_CURVES)
        posteriors, weights = (condition(others, hyperparameters), Posterior.of(curves)), functional(row)
        predictions.append(LeftOut(row, title, *(posterior.predict(weights) for posterior in posteriors)))
    return predictions


def predictive_scores(rows: list[Evidence], hyperparameters: Hyperparameters) -> FloatArray:
    """Those of one group's printed powers by the numbers alone, in closed form."""
    system, names, misses = EvidenceSystem.of(rows), [row.name for row in rows], []
    for row, _, without in _leave_outs(rows):
        out = np.isin(names, [*without])
        mean, deviation = system.left_out(names.index(row.name), out, hyperparameters)
        misses.append((mean - row.value) / deviation)
    return np.array(misses)


def rms(scores: FloatArray) -> FloatArray:
    """Root mean square over the first axis: 1 if the stated errors are right."""
    return np.asarray(np.sqrt(np.mean(scores**2, axis=0)))


def _leave_outs(evidence: list[Evidence]) -> list[tuple[Evidence, str, set[str]]]:
    """Every printed power with what is left out, in words and as names."""
    cases = []
    for row in (row for row in evidence if row.quantity == "power"):
        cases.append((row, "itself", {row.name}))
        if row.design == "trt":
            twins = {other.name for other in of_group(evidence, row.group) if other.quantity == "crank_power"}
            cases.append((row, "itself and the 15 W item", {row.name} | twins))
    return cases
