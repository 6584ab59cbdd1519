"""One call for every single-objective method: independent searches over seeds, side by side, the best of them."""

from collections.abc import Callable
from contextlib import suppress
from functools import partial

import numpy as np
from numpy.random import SeedSequence

from fes_mj.common.errors import InputError
from fes_mj.common.parallel import HERE, Workers, run_tasks
from fes_mj.optimization.findings import Findings
from fes_mj.optimization.methods import BUDGETS, METHODS, Start
from fes_mj.optimization.problem import Problem
from fes_mj.optimization.search import BudgetSpentError, Result, Search, require_feasible


def search_once(
    problem: Problem, method: str, budget: int, start: Start, findings: Findings | None, task: tuple[int, SeedSequence]
) -> Result | InputError:
    """One search, by its number and its own random numbers; an error, as a value, if it found nothing feasible."""
    number, seed = task
    search = Search(problem, budget, partial(findings.improve, number) if findings else None)
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
    findings: Findings | None = None,
    progress: Callable[[int], None] | None = None,
) -> list[Result]:
    """Independent searches, best first; the outcome does not depend on where they run.

    budget: evaluations of each search. start: ten variables, feasible; by default random. findings: where results are
    kept, and finished ones taken from; searches on a cluster, which may not see these files, are kept when finished.
    Raises InputError if the start is infeasible, or no search finds anything feasible. progress is told how many more
    searches are done.
    """
    if start is not None:
        require_feasible(problem, start, problem.template.name)
    seeds = SeedSequence(seed).spawn(searches)
    outcomes: dict[int, Result | InputError] = {**findings.finished()} if findings else {}
    if progress:
        progress(len(outcomes))
    missing = [number for number in range(searches) if number not in outcomes]
    seen = None if workers.cluster else findings
    task = partial(search_once, problem, method, budget or BUDGETS[method], start, seen)
    for index, outcome in run_tasks(task, [(number, seeds[number]) for number in missing], workers):
        outcomes[missing[index]] = outcome
        if findings and isinstance(outcome, Result):
            findings.finish(missing[index], outcome)
        if progress:
            progress(1)
    ordered = [outcomes[number] for number in range(searches)]
    results = [outcome for outcome in ordered if isinstance(outcome, Result)]
    if not results:
        raise next(outcome for outcome in ordered if isinstance(outcome, InputError))
    return sorted(results, key=lambda result: -result.merit)
