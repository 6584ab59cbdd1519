"""Printed powers predicted from the other evidence, and by how many of their own standard deviations that misses."""

from typing import NamedTuple

import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.paper.evidence import Evidence, functional, of_group
from fes_mj.paper.reconstruction import Hyperparameters, Posterior, System, condition
from fes_mj.paper.statements import told

_CURVES = 500  # a prediction with the text


class LeftOut(NamedTuple):
    """A printed power beside its prediction from other evidence, W; title: what was left out, in words.

    numbers, text: mean and standard deviation, by the numbers alone and with what the text says of the figures.
    """

    row: Evidence
    title: str
    numbers: tuple[float, float]
    text: tuple[float, float]

    def score(self, prediction: tuple[float, float]) -> float:
        """By how many standard deviations of prediction and print together it is off."""
        mean, deviation = prediction
        return float((mean - self.row.value) / np.hypot(deviation, self.row.error))

    @property
    def scores(self) -> tuple[float, float]:
        """By the numbers alone, and with the text."""
        return self.score(self.numbers), self.score(self.text)


def left_out(evidence: list[Evidence], hyperparameters: Hyperparameters) -> list[LeftOut]:
    """Every printed power predicted without itself; the TRT's also without its twin, the 15 W item."""
    predictions = []
    for row, title, without in _leave_outs(evidence):
        others = [other for other in of_group(evidence, row.group) if other.name not in without]
        curves, _ = told(others, row.group, hyperparameters, _CURVES)
        posteriors, weights = (condition(others, hyperparameters), Posterior.of(curves)), functional(row)[0]
        predictions.append(LeftOut(row, title, *(posterior.predict(weights) for posterior in posteriors)))
    return predictions


def scores(rows: list[Evidence], hyperparameters: Hyperparameters) -> FloatArray:
    """Those of one group's printed powers by the numbers alone, in closed form."""
    system, names, found = System.of(rows), [row.name for row in rows], []
    for row, _, without in _leave_outs(rows):
        out = np.isin(names, [*without])
        mean, deviation = system.left_out(names.index(row.name), out, hyperparameters)
        found.append((mean - row.value) / deviation)
    return np.array(found)


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
