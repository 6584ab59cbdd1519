"""Several objectives at once: power of both groups, and by choice smoothness, by NSGA-II (pymoo)."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.common.errors import InputError, require_extra
from fes_mj.common.markdown import Table
from fes_mj.common.writing import csv_text
from fes_mj.linkage.variables import LENGTHS
from fes_mj.moments.joint_moments import RIDER_GROUPS, JointMoments
from fes_mj.optimization.evenness import fluctuation
from fes_mj.optimization.limits import VARIED
from fes_mj.optimization.problem import Evaluation, Problem
from fes_mj.optimization.search import Improved, Search

FRONT_POPULATION = 100
FLUCTUATION = "fluctuation of energy"  # the coefficient, see evenness.fluctuation
_ROWS = 12  # of the front's table


@dataclass(frozen=True)
class Front:
    """Non-dominated designs, by falling power of the first group.

    x: shape (n, 10). power: W, shape (n, groups). fluctuation: shape (n,), or None if it was no objective.
    """

    x: FloatArray
    power: FloatArray
    fluctuation: FloatArray | None
    evaluations: int

    def as_json(self) -> list[dict[str, Any]]:
        """A dictionary a design."""
        rows: list[dict[str, Any]] = [
            {"power_mean_W": dict(zip(RIDER_GROUPS, power, strict=True)), "x": x}
            for power, x in zip(self.power.tolist(), self.x.tolist(), strict=True)
        ]
        for row, value in zip(rows, self._smooth.get("fluctuation", ()), strict=False):
            row["fluctuation"] = float(value)
        return rows

    def as_csv(self) -> str:
        """A row a design."""
        powers = {f"power_{group}_W": column for group, column in zip(RIDER_GROUPS, self.power.T, strict=True)}
        return csv_text(powers | dict(zip(VARIED, self.x.T, strict=True)) | self._smooth)

    @property
    def table(self) -> Table:
        """Designs all along the front: number, powers and, if it was an objective, fluctuation."""
        shown = np.unique(np.linspace(0, len(self.x) - 1, _ROWS).astype(int))
        columns = {"design": ""} | {f"{group}, W": ".2f" for group in RIDER_GROUPS}
        columns |= dict.fromkeys([FLUCTUATION] * len(self._smooth), ".3f")
        measured = np.column_stack([self.power, *self._smooth.values()])
        return Table(f"{len(shown)} of {len(self.x)} designs", columns, [(f"{row}", *measured[row]) for row in shown])

    @property
    def _smooth(self) -> dict[str, FloatArray]:
        """The column of the fluctuation, if it was an objective."""
        return {} if self.fluctuation is None else {"fluctuation": self.fluctuation}


def pareto_front(
    problem: Problem,
    moments: tuple[JointMoments, ...],
    budget: int,
    seed: int = 0,
    smooth: bool = False,
    improved: Improved | None = None,
) -> Front:
    """Trade-off between the powers of the problem's sets of moments, after `budget` evaluations.

    moments: those of problem.table, in its order. smooth: also the least coefficient of fluctuation of the first.
    improved: told of designs whose power, averaged over the sets, is the most so far; the last of them is in the front.
    Raises InputError if no feasible design was found.
    """
    require_extra("optimize", "pymoo")
    from pymoo.algorithms.moo.nsga2 import NSGA2
    from pymoo.core.problem import Problem as Space
    from pymoo.problems.static import StaticProblem
    from pymoo.util.nds.non_dominated_sorting import NonDominatedSorting

    low, high = problem.limits.search[: len(LENGTHS)].T
    goals, limits = problem.table.sets + smooth, len(problem.constraints)
    space = Space(n_var=len(LENGTHS), n_obj=goals, n_ieq_constr=limits, xl=low, xu=high)
    search, nsga = Search(problem, budget, improved), NSGA2(pop_size=FRONT_POPULATION)
    nsga.setup(space, termination=("n_eval", budget), seed=seed)
    while nsga.has_next():
        population = nsga.ask()
        evaluation = problem.evaluate(population.get("X"))
        search.note(evaluation.x, np.where(evaluation.feasible, evaluation.power.mean(axis=1), -np.inf))
        values = {"F": _objectives(problem, evaluation, moments, smooth), "G": -evaluation.scaled_margins}
        nsga.evaluator.eval(StaticProblem(space, **values), population)
        nsga.tell(infills=population)
    best = nsga.result().X
    if best is None:
        raise InputError(
            f"no feasible {problem.template.linkage.kind} found in {budget} evaluations; "
            "loosen a limit, widen the design space or raise the budget"
        )
    # NSGA-II thins out its front where it is crowded, whichever design it loses
    x = np.unique(np.vstack([np.atleast_2d(best), search.best_x[: len(LENGTHS)]]), axis=0)
    objectives = _objectives(problem, problem.evaluate(x), moments, smooth)
    front = NonDominatedSorting().do(objectives, only_non_dominated_front=True)
    order = front[np.argsort(objectives[front, 0])]
    evaluation = problem.evaluate(x[order])
    return Front(evaluation.x, evaluation.power, objectives[order, -1] if smooth else None, search.evaluations)


def _objectives(
    problem: Problem, evaluation: Evaluation, moments: tuple[JointMoments, ...], smooth: bool
) -> FloatArray:
    """To be made small, shape (n, objectives); any number where a design is not feasible."""
    columns = [*-np.nan_to_num(evaluation.power).T]
    if smooth:
        columns.append(np.zeros(len(evaluation.x)))
        feasible = evaluation.feasible
        if feasible.any():
            columns[-1][feasible] = fluctuation(problem.batch(evaluation.x).taken(feasible), moments[0])
    return np.column_stack(columns)
