"""One call for every single-objective method: independent searches over seeds, side by side, the best of them."""

from collections.abc import Callable
from contextlib import suppress
from functools import partial

import numpy as np

from fes_mj.errors import InputError
from fes_mj.optimization.methods import BUDGETS, METHODS, Start
from fes_mj.optimization.problem import Problem
from fes_mj.optimization.search import BudgetSpentError, Result, Search, require_feasible
from fes_mj.parallel import HERE, Workers, run_tasks


def search_once(
    problem: Problem, method: str, budget: int, start: Start, seed: np.random.SeedSequence
) -> Result | InputError:
    """One search from its own random numbers; an error, as a value, if it found nothing feasible."""
    search = Search(problem, budget)
    with suppress(BudgetSpentError):
        METHODS[method](search, start, np.random.default_rng(seed))
    try:
        return search.result()
    except InputError as error:
        return error


def optimize(
    problem: Problem,
    method: str,
    *,
    searches: int = 1,
    budget: int | None = None,
    seed: int = 0,
    start: Start = None,
    workers: Workers = HERE,
    progress: Callable[[int], None] | None = None,
) -> list[Result]:
    """Independent searches, best first; the outcome does not depend on where they run.

    budget: evaluations of each search. start: ten variables, feasible; by default random. Raises InputError if the
    start is infeasible, or no search finds anything feasible. progress is told how many searches are done.
    """
    if start is not None:
        require_feasible(problem, start, problem.template.name)
    seeds = np.random.SeedSequence(seed).spawn(searches)
    task = partial(search_once, problem, method, budget or BUDGETS[method], start)
    outcomes: dict[int, Result | InputError] = {}
    for index, outcome in run_tasks(task, seeds, workers):
        outcomes[index] = outcome
        if progress:
            progress(len(outcomes))
    ordered = [outcomes[index] for index in range(searches)]
    results = [outcome for outcome in ordered if isinstance(outcome, Result)]
    if not results:
        raise next(outcome for outcome in ordered if isinstance(outcome, InputError))
    return sorted(results, key=lambda result: -result.merit)
