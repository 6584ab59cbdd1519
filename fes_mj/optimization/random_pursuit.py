"""The paper's method (Section 6): small uniform steps from the best design, kept if feasible and better."""

from __future__ import annotations

import numpy as np

from fes_mj.arrays import FloatArray
from fes_mj.optimization.search import BudgetSpentError, Search

STEP = 0.01  # of every variable: m, and 1 for the gear ratio (Eq. 18)
PATIENCE = 10_000  # feasible trials in a row without improvement
_SMALLEST_BLOCK, _LARGEST_BLOCK = 16, 2048


def random_pursuit(search: Search, start: FloatArray, random: np.random.Generator, patience: int = PATIENCE) -> None:
    """Pursue from a feasible start, shape (10,), until `patience` feasible trials in a row brought nothing.

    Trials are evaluated in blocks, in which those after an improvement are discarded and not counted: the
    sequence of trials is distributed exactly as one at a time.
    """
    problem, failures, block = search.problem, 0, _SMALLEST_BLOCK
    search(start[None])
    while failures < patience and search.evaluations < search.budget:
        x = search.best_x + random.uniform(-STEP, STEP, (block, len(start)))
        evaluation = problem.evaluate(x[: search.budget - search.evaluations])
        merit = problem.merit(evaluation)
        better = np.flatnonzero(merit > search.best)
        trials = np.cumsum(evaluation.feasible)
        used = int(better[0]) + 1 if better.size else len(merit)
        used = min(used, int(np.searchsorted(trials, patience - failures)) + 1, len(merit))
        improved = bool(better.size) and used > better[0]
        search.note(evaluation.x[:used], merit[:used])
        failures = 0 if improved else failures + int(trials[used - 1])
        # blocks as long as improvements are apart
        block = int(np.clip(2 * used if improved else 2 * block, _SMALLEST_BLOCK, _LARGEST_BLOCK))
    if search.evaluations >= search.budget:
        raise BudgetSpentError
