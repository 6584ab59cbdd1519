"""Evolutionary methods from libraries, over the nine lengths; the gear ratio follows from the joint speeds."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import differential_evolution

from fes_mj.errors import import_extra
from fes_mj.optimization.problem import LENGTHS
from fes_mj.optimization.search import Search, feasible_start

POPULATION = 7  # per variable
# Part of the search range; a restart of CMA-ES begins at another random feasible design.
CMA_SIGMA = 0.05
CMA_POPULATION = 32  # three times pycma's own: a population costs hardly more than a few designs


def differential(search: Search, start: NDArray[np.float64] | None, random: np.random.Generator) -> None:
    """Differential evolution (scipy), started again from a new population whenever one has converged."""
    bounds = search.problem.limits.search[:LENGTHS]
    while True:
        differential_evolution(
            lambda x: -search(x.T),
            bounds,
            x0=None if start is None else np.clip(start[:LENGTHS], *bounds.T),
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


def cma_es(search: Search, start: NDArray[np.float64] | None, random: np.random.Generator) -> None:
    """CMA-ES (pycma), started again with a doubled population whenever it has converged."""
    cma = import_extra("cma", "optimize")
    low, high = search.problem.limits.search[:LENGTHS].T
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
        strategy = cma.CMAEvolutionStrategy(np.clip((x0[:LENGTHS] - low) / (high - low), 0, 1), CMA_SIGMA, options)
        while not strategy.stop():
            trials = np.array(strategy.ask())
            strategy.tell(trials, -search(low + trials * (high - low)))
        start, population = None, 2 * population
