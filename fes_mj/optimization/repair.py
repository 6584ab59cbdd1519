"""A design that does not keep the limits becomes the nearest that was found to keep them."""

import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.common.errors import InputError
from fes_mj.optimization.limits import VARIED
from fes_mj.optimization.problem import LENGTH_COUNT, Problem

_TRIED = 1000  # designs at each distance
# Parts of the search ranges within which designs are tried around the least broken one so far, the nearest first.
_DISTANCES = (0.003, 0.01, 0.02, 0.04, 0.08, 0.12, 0.2)
_ROUNDS = 6
_SHOWN = 5e-5  # m


def repaired(problem: Problem, start: FloatArray, seed: int = 0) -> FloatArray:
    """The variables of a design that keeps the limits, near those of `start`, shape (variables,).

    Designs are tried at growing distances around the one that broke the limits least, then nearer to the start again.
    Raises InputError, saying which limits of the problem file are in the way, if none was found.
    """
    low, high = problem.varied.T
    width, random = high - low, np.random.default_rng(seed)
    origin = np.clip(start[: len(low)], low, high)
    best, violation = start, np.inf
    for _ in range(_ROUNDS):
        for distance in _DISTANCES:
            around = origin if np.isinf(violation) else best[: len(low)]
            x = np.clip(around + distance * width * random.standard_normal((_TRIED, len(low))), low, high)
            evaluation = problem.evaluate(np.vstack([around, x]))
            if evaluation.feasible.any():
                kept = evaluation.x[evaluation.feasible]
                apart = np.abs((kept[:, : len(low)] - origin) / np.where(width, width, 1)).sum(axis=1)
                return np.asarray(kept[np.argmin(apart)])
            least = int(np.argmin(evaluation.violation))
            if evaluation.violation[least] < violation:
                best, violation = evaluation.x[least], evaluation.violation[least]
    raise InputError(
        f"{problem.template.name}: no design near it keeps the limits; the nearest one: "
        f"{problem.violations_text(best)}. `fes_mj optimize {problem.template.linkage.kind} --print-problem` writes a "
        "problem file in which these can be changed"
    )


def changes(start: FloatArray, after: FloatArray) -> str:
    """What a repair has changed, in words."""
    rows = zip(VARIED[:LENGTH_COUNT], start, after, strict=False)
    return ", ".join(f"{name} {old:.4f} -> {new:.4f} m" for name, old, new in rows if abs(new - old) > _SHOWN)
