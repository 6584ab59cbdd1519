"""Evolutionary methods from libraries, over the nine lengths; the gear ratio follows from the joint speeds."""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.optimize import differential_evolution

from fes_mj.arrays import FloatArray
from fes_mj.errors import require_extra
from fes_mj.optimization.search import Search, feasible_start
from fes_mj.variables import LENGTHS

POPULATION = 7  # per variable
# Part of the search range; a restart of CMA-ES begins at another random feasible design.
CMA_SIGMA = 0.05
CMA_POPULATION = 32  # three times pycma's own: a population costs hardly more than a few designs


def differential(search: Search, start: FloatArray | None, random: np.random.Generator) -> None:
    """Differential evolution (scipy), started again from a new population whenever one has converged."""
    bounds = search.problem.limits.search[: len(LENGTHS)]
    while True:
        differential_evolution(
            lambda x: -search(x.T),
            bounds,
            x0=None if start is None else np.clip(start[: len(LENGTHS)], *bounds.T),
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


def cma_es(search: Search, start: FloatArray | None, random: np.random.Generator) -> None:
    """CMA-ES (pycma), started again with a doubled population whenever it has converged."""
    cma = require_extra("optimize", "cma")
    low, high = search.problem.limits.search[: len(LENGTHS)].T
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
        strategy = cma.CMAEvolutionStrategy(
            np.clip((x0[: len(LENGTHS)] - low) / (high - low), 0, 1), CMA_SIGMA, options
        )
        while not strategy.stop():
            trials = np.array(strategy.ask())
            strategy.tell(trials, -search(low + trials * (high - low)))
        start, population = None, 2 * population
