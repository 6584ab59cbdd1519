"""The single-objective methods: two evolutionary ones from libraries, the paper's own, and the search they all share.

The evolutionary ones vary all but the gear ratio where power is proportional to it: it follows from the joint speeds.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
from scipy.optimize import OptimizeResult, differential_evolution

from fes_mj.common.arrays import FloatArray
from fes_mj.common.errors import InputError, require_extra
from fes_mj.optimization.problem import INFEASIBLE, LENGTH_COUNT, Problem

Improved: TypeAlias = Callable[[FloatArray, float], None]  # a feasible design, shape (variables,), and its merit
Start: TypeAlias = FloatArray | None
POPULATION_FACTOR = 7  # per variable
# Part of the search range; a restart of CMA-ES begins at another random feasible design.
CMA_SIGMA = 0.05
CMA_POPULATION = 32  # three times pycma's own: a population costs hardly more than a few designs
TRIAL_STEP = 0.01  # of every variable: m, and 1 for the gear ratio (Eq. 18)
PATIENCE = 10_000  # feasible trials in a row without improvement
_SMALLEST_BLOCK, _LARGEST_BLOCK = 16, 2048
_SAMPLE = 2000  # random designs tried at once for a feasible one


class BudgetSpentError(Exception):
    """Ends a method when its evaluations are used up."""


@dataclass(frozen=True)
class SearchResult:
    """Outcome of one search.

    x: shape (variables,). merit: see Problem.merit. history: evaluations and merit at each improvement, shape (k, 2).
    """

    x: FloatArray
    merit: float
    evaluations: int
    history: FloatArray


class Search:
    """Evaluates populations for a method, counts, remembers the best. Raises BudgetSpentError at the budget's end.

    improved: told of every feasible design that is better than all before. counted: of how many were evaluated.
    """

    def __init__(
        self,
        problem: Problem,
        budget: int,
        improved: Improved | None = None,
        counted: Callable[[int], None] | None = None,
    ) -> None:
        self.problem, self.budget, self.evaluations = problem, budget, 0
        self.best_x, self.best = np.full(len(problem.search), np.nan), -np.inf
        self._history: list[tuple[int, float]] = []
        self._improved, self._counted = improved, counted

    def __call__(self, x: FloatArray, to_beat: FloatArray | float = -np.inf) -> FloatArray:
        """Merit of each row of x, shape (n, variables) or without gear ratios; see Problem.evaluate."""
        rest = self.budget - self.evaluations
        if rest <= 0:
            raise BudgetSpentError
        evaluation = self.problem.evaluate(x[:rest], np.broadcast_to(to_beat, len(x))[:rest])
        merit = self.problem.merit(evaluation)
        self.note(evaluation.x, merit)
        if len(x) > rest:
            raise BudgetSpentError
        return merit

    def note(self, x: FloatArray, merit: FloatArray) -> None:
        """Count evaluations made elsewhere; x of shape (n, variables) in the order they were made."""
        top = int(np.argmax(merit))
        if merit[top] > self.best:
            self.best, self.best_x = float(merit[top]), x[top].copy()
            self._history.append((self.evaluations + top + 1, self.best))
            if self._improved and self.best > INFEASIBLE:
                self._improved(self.best_x, self.best)
        self.evaluations += len(merit)
        if self._counted:
            self._counted(len(merit))

    def result(self) -> SearchResult:
        """The best design so far. Raises InputError, saying what stood in the way, if none was feasible."""
        broken = self.problem.violations_text(self.best_x)
        if broken:
            kind = self.problem.template.linkage.kind
            raise InputError(
                f"no feasible {kind} found in {self.evaluations} evaluations; the closest violates: {broken}. "
                "Loosen a limit, widen the design space or raise the budget"
            )
        return SearchResult(self.best_x, self.best, self.evaluations, np.array(self._history))


def feasible_start(search: Search, random: np.random.Generator) -> FloatArray:
    """A random feasible design, all its variables, from the search ranges; every design tried until then is counted.

    Raises BudgetSpentError if none turns up within the budget.
    """
    low, high = search.problem.search.T
    while search.evaluations < search.budget:
        x = random.uniform(low, high, (min(_SAMPLE, search.budget - search.evaluations), len(low)))
        x[:, LENGTH_COUNT:-1] = 0.0  # of people, whom seats suit in which all their legs are equally stretched
        evaluation = search.problem.evaluate(x)
        any_feasible = evaluation.feasible.any()
        used = int(np.argmax(evaluation.feasible)) + 1 if any_feasible else len(x)
        search.note(evaluation.x[:used], search.problem.merit(evaluation)[:used])
        if any_feasible:
            return np.asarray(evaluation.x[used - 1])
    raise BudgetSpentError


def differential(search: Search, start: Start, random: np.random.Generator) -> None:
    """Differential evolution (scipy), started again from a new population whenever one has converged.

    A trial replaces the member of its own number, or is forgotten: it has that one's merit to beat.
    """
    bounds = search.problem.varied
    to_beat: list[FloatArray] = []

    def after_generation(intermediate_result: OptimizeResult) -> None:
        to_beat[:] = [-intermediate_result.population_energies]

    while True:
        to_beat.clear()  # nothing is known of the first population
        differential_evolution(
            lambda x: -search(x.T, *to_beat),
            bounds,
            x0=None if start is None else np.clip(start[: len(bounds)], *bounds.T),
            popsize=POPULATION_FACTOR,
            maxiter=search.budget,
            tol=1e-6,
            mutation=(0.4, 0.9),
            recombination=0.9,
            rng=random,
            vectorized=True,
            updating="deferred",
            polish=False,
            callback=after_generation,
        )
        start = None


def cma_es(search: Search, start: Start, random: np.random.Generator) -> None:
    """CMA-ES (pycma), started again with a doubled population whenever it has converged."""
    cma = require_extra("optimize", "cma")
    low, high = search.problem.varied.T
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
        width = np.where(high > low, high - low, 1.0)  # a variable that a linkage lacks has none
        strategy = cma.CMAEvolutionStrategy(np.clip((x0[: len(low)] - low) / width, 0, 1), CMA_SIGMA, options)
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
        x = search.best_x + random.uniform(-TRIAL_STEP, TRIAL_STEP, (block, len(start)))
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
# Usual evaluations of one search. Random pursuit stops by itself, after 0.04 to 1 million trials. Under muscles an
# evaluation takes a thousand times as long.
BUDGETS = {"differential-evolution": 50_000, "cma-es": 50_000, "random-pursuit": 5_000_000, "nsga-ii": 50_000}
MUSCLE_BUDGET = 3000
