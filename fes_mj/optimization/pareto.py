"""Several objectives at once: power of both groups, and by choice smoothness, by NSGA-II (pymoo)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fes_mj import kinematics
from fes_mj.errors import InputError, import_extra
from fes_mj.optimization.cycles import take
from fes_mj.optimization.problem import LENGTHS, Problem
from fes_mj.statics import joint_moments, virtual_work
from fes_mj.torque import JointMoments

POPULATION = 100
_UNKNOWN = 10.0  # scales; for the margins of a design refused before they were computed


@dataclass(frozen=True)
class Front:
    """Non-dominated designs, by falling power of the first group.

    x: shape (n, 10). power: W, shape (n, groups). fluctuation: shape (n,), or None if it was no objective.
    """

    x: NDArray[np.float64]
    power: NDArray[np.float64]
    fluctuation: NDArray[np.float64] | None
    evaluations: int


def pareto_front(
    problem: Problem, moments: tuple[JointMoments, ...], budget: int, seed: int = 0, smooth: bool = False
) -> Front:
    """Trade-off between the powers of the problem's sets of moments, after `budget` evaluations.

    moments: those of problem.table, in its order. smooth: also the least coefficient of fluctuation of the first.
    Raises InputError if no feasible design was found.
    """
    import_extra("pymoo", "optimize")
    from pymoo.algorithms.moo.nsga2 import NSGA2
    from pymoo.core.problem import Problem as Vectorized
    from pymoo.optimize import minimize

    class Population(Vectorized):
        def __init__(self) -> None:
            low, high = problem.limits.search[:LENGTHS].T
            objectives = problem.table.sets + smooth
            super().__init__(n_var=LENGTHS, n_obj=objectives, n_ieq_constr=len(problem.constraints), xl=low, xu=high)

        def _evaluate(self, x: NDArray[np.float64], out: dict[str, Any]) -> None:
            evaluation = problem.evaluate(x)
            goals = [*-np.nan_to_num(evaluation.power).T]
            if smooth:
                goals.append(np.zeros(len(x)))
                batch, feasible = problem.batch(evaluation.x), evaluation.feasible
                if feasible.any():
                    goals[-1][feasible] = fluctuation(take(batch, feasible), moments[0])
            out["F"] = np.column_stack(goals)
            out["G"] = -np.nan_to_num(evaluation.margins / evaluation.scales, nan=-_UNKNOWN)

    result = minimize(Population(), NSGA2(pop_size=POPULATION), ("n_eval", budget), seed=seed, verbose=False)
    if result.X is None:
        raise InputError(
            f"no feasible {problem.template.linkage.kind} found in {budget} evaluations; "
            "loosen a limit, widen the design space or raise --budget"
        )
    order = np.argsort(np.atleast_2d(result.F)[:, 0])
    evaluation = problem.evaluate(np.atleast_2d(result.X)[order])
    return Front(
        evaluation.x,
        evaluation.power,
        np.atleast_2d(result.F)[order, -1] if smooth else None,
        int(result.algorithm.evaluator.n_eval),
    )


def fluctuation(design: Any, moments: JointMoments, points: int = 360) -> NDArray[np.float64]:
    """Coefficient of fluctuation of energy of two legs half a turn apart, for a batch, shape (designs,).

    Largest less smallest surplus of the work done over the mean, by the work of a turn: what a flywheel has to store.
    """
    crank_angle = np.arange(points) * (2 * np.pi / points)
    motion = kinematics.solve(design, crank_angle)
    leg = virtual_work(motion, *joint_moments(motion, moments))
    crank = np.atleast_2d(leg + np.roll(leg, points // 2, axis=-1))
    mean = crank.mean(axis=1, keepdims=True)
    surplus = np.cumsum(crank - mean, axis=1)
    return np.ptp(surplus, axis=1) / (points * np.abs(mean[:, 0]))
