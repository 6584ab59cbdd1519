"""The single-objective methods: two evolutionary ones from libraries, and the paper's own.

The evolutionary ones vary all but the gear ratio, which follows from the joint speeds.
"""

from collections.abc import Callable
from typing import Any, TypeAlias

import numpy as np
from scipy.optimize import differential_evolution

from fes_mj.common.arrays import FloatArray
from fes_mj.common.errors import require_extra
from fes_mj.optimization.search import BudgetSpentError, Search, feasible_start

Start: TypeAlias = FloatArray | None
POPULATION = 7  # per variable
# Part of the search range; a restart of CMA-ES begins at another random feasible design.
CMA_SIGMA = 0.05
CMA_POPULATION = 32  # three times pycma's own: a population costs hardly more than a few designs
STEP = 0.01  # of every variable: m, and 1 for the gear ratio (Eq. 18)
PATIENCE = 10_000  # feasible trials in a row without improvement
_SMALLEST_BLOCK, _LARGEST_BLOCK = 16, 2048


def differential(search: Search, start: Start, random: np.random.Generator) -> None:
    """Differential evolution (scipy), started again from a new population whenever one has converged."""
    bounds = search.problem.search[:-1]
    while True:
        differential_evolution(
            lambda x: -search(x.T),
            bounds,
            x0=None if start is None else np.clip(start[:-1], *bounds.T),
            popsize=POPULATION,
            maxiter=search.budget,
            tol=1e-6,
            mutation=(0.4, 0.9),
            recombination=0.9,
            rng=random,
            vectorized=True,
            updating="deferred",
            polish=False,
        )
        start = None


def cma_es(search: Search, start: Start, random: np.random.Generator) -> None:
    """CMA-ES (pycma), started again with a doubled population whenever it has converged."""
    cma = require_extra("optimize", "cma")
    low, high = search.problem.search[:-1].T
    population = CMA_POPULATION
    while True:
        x0 = feasible_start(search, random) if start is None else start
        options: dict[str, Any] = {
            "bounds": [0, 1],
            "popsize": population,
            "seed": int(random.integers(1, 2**31)),
            "verbose": -9,
            "tolfun": 1e-6,
        }
        strategy = cma.CMAEvolutionStrategy(np.clip((x0[:-1] - low) / (high - low), 0, 1), CMA_SIGMA, options)
        while not strategy.stop():
            trials = np.array(strategy.ask())
            strategy.tell(trials, -search(low + trials * (high - low)))
        start, population = None, 2 * population


def random_pursuit(search: Search, start: Start, random: np.random.Generator, patience: int = PATIENCE) -> None:
    """The paper's method (Section 6): small uniform steps from the best design, kept if feasible and better.

    It goes on until `patience` feasible trials in a row brought nothing.

    Trials are evaluated in blocks, in which those after an improvement are discarded and not counted: the
    sequence of trials is distributed exactly as one at a time.
    """
    problem, failures, block = search.problem, 0, _SMALLEST_BLOCK
    start = feasible_start(search, random) if start is None else start
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


Method: TypeAlias = Callable[[Search, Start, np.random.Generator], None]
METHODS: dict[str, Method] = {
    "differential-evolution": differential,
    "cma-es": cma_es,
    "random-pursuit": random_pursuit,
}
# Evaluations of one search. Random pursuit stops by itself, after 0.04 to 1 million trials.
BUDGETS = {"differential-evolution": 50_000, "cma-es": 50_000, "random-pursuit": 5_000_000, "nsga-ii": 50_000}
