"""What all single-objective methods share: a counted, remembered evaluation, and the result."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.common.errors import InputError
from fes_mj.optimization.problem import INFEASIBLE, LENGTH_COUNT, Problem

Improved: TypeAlias = Callable[[FloatArray, float], None]  # a feasible design, shape (variables,), and its merit
_SAMPLE = 2000


class BudgetSpentError(Exception):
    """Ends a method when its evaluations are used up."""


@dataclass(frozen=True)
class Result:
    """Outcome of one search.

    x: shape (variables,). merit: see Problem.merit. history: evaluations and merit at each improvement, shape (k, 2).
    """

    x: FloatArray
    merit: float
    evaluations: int
    history: FloatArray


class Search:
    """Evaluates populations for a method, counts, remembers the best. Raises BudgetSpentError at the budget's end.

    improved: told of every feasible design that is better than all before.
    """

    def __init__(self, problem: Problem, budget: int, improved: Improved | None = None) -> None:
        self.problem, self.budget, self.evaluations = problem, budget, 0
        self.best_x, self.best = np.full(len(problem.search), np.nan), -np.inf
        self._history: list[tuple[int, float]] = []
        self._improved = improved

    def __call__(self, x: FloatArray) -> FloatArray:
        """Merit of each row of x, shape (n, variables) or without gear ratios; see Problem.evaluate."""
        rest = self.budget - self.evaluations
        if rest <= 0:
            raise BudgetSpentError
        evaluation = self.problem.evaluate(x[:rest])
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

    def result(self) -> Result:
        """The best design so far. Raises InputError, saying what stood in the way, if none was feasible."""
        broken = violations_text(self.problem, self.best_x)
        if broken is not None:
            kind = self.problem.template.linkage.kind
            raise InputError(
                f"no feasible {kind} found in {self.evaluations} evaluations; the closest violates: {broken}. "
                "Loosen a limit, widen the design space or raise --budget"
            )
        return Result(self.best_x, self.best, self.evaluations, np.array(self._history))


def feasible_start(search: Search, random: np.random.Generator) -> FloatArray:
    """A random feasible design, all its variables, from the search ranges; every design tried until then is counted.

    Raises BudgetSpentError if none turns up within the budget.
    """
    low, high = search.problem.search.T
    while search.evaluations < search.budget:
        x = random.uniform(low, high, (min(_SAMPLE, search.budget - search.evaluations), len(low)))
        x[:, LENGTH_COUNT:-1] = 0.0  # of people, whom seats suit in which all their legs are equally stretched
        evaluation = search.problem.evaluate(x)
        found = evaluation.feasible.any()
        used = int(np.argmax(evaluation.feasible)) + 1 if found else len(x)
        search.note(evaluation.x[:used], search.problem.merit(evaluation)[:used])
        if found:
            return np.asarray(evaluation.x[used - 1])
    raise BudgetSpentError


def require_feasible(problem: Problem, x: FloatArray, name: str) -> None:
    """Raise InputError naming the violated constraints if a start, shape (variables,), is not feasible."""
    broken = violations_text(problem, x)
    if broken is not None:
        raise InputError(f"the start {name} is not feasible: {broken}")


def violations_text(problem: Problem, x: FloatArray) -> str | None:
    """Which constraints a design, shape (variables,), violates and by how much; None if it is feasible."""
    evaluation = problem.evaluate(x[None])
    if evaluation.feasible[0]:
        return None
    parts = (
        f"{v['name']} is {v['value']:.4g} {v['unit']}".rstrip() + f" (limit {v['limit']:.4g})"
        for v in problem.violations(evaluation)
    )
    return ", ".join(parts) or "the thigh swings through 180 deg or more"
