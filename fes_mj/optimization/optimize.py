"""New designs in one call: a problem, a method, independent searches over seeds side by side, the best of them."""

import math
from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext, suppress
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import Any, TypeAlias, Unpack

import numpy as np
from numpy.random import SeedSequence

from fes_mj.common.arrays import FloatArray
from fes_mj.common.brief import Brief
from fes_mj.common.errors import InputError, require_one_of, require_within
from fes_mj.common.parallel import HERE, Workers, run_tasks
from fes_mj.common.units import turns_per_second
from fes_mj.linkage.design import Design
from fes_mj.linkage.design_file import load_design
from fes_mj.moments.files import load_moments
from fes_mj.moments.joint_moments import RIDER_GROUPS, JointMoments
from fes_mj.optimization.findings import Findings
from fes_mj.optimization.limits import MEANINGS, PIVOTS, VARIED
from fes_mj.optimization.moment_drive import MomentDrive
from fes_mj.optimization.pareto import Front, pareto_front
from fes_mj.optimization.problem import LENGTH_COUNT, Evaluation, Problem, ProblemOptions, make_problem
from fes_mj.optimization.repair import changes, repaired
from fes_mj.optimization.search import BUDGETS, METHODS, MUSCLE_BUDGET, BudgetSpentError, Search, SearchResult, Start
from fes_mj.statics.cycles import cycles
from fes_mj.statics.work_table import WorkTable

Advance: TypeAlias = Callable[[int], None]  # told how many more evaluations are behind
_AT_EDGE = 0.01  # of a constraint's scale, or of a search range


@dataclass(frozen=True, repr=False)
class Optimum(Brief):
    """The best design of all searches, or of a front the one with the most power averaged over both groups.

    name: the design's. x: its variables, shape (variables,), see Problem. evaluations: of all searches together.
    """

    problem: Problem
    method: str
    name: str
    x: FloatArray
    evaluations: int
    front: Front | None = None
    repair: str = ""  # what was changed of a start that did not keep the limits

    @property
    def brief(self) -> str:
        return f"{self.name}: {self.power:.2f} W after {self.evaluations} evaluations"

    @property
    def design(self) -> Design:
        """As drawn for the rider of the problem's template."""
        return self.problem.design(self.x, self.name)

    @property
    def power(self) -> float:
        """Mean crank power of one leg, W; for people their statistic."""
        return float(self._evaluation.power[0, 0])

    @property
    def feasible(self) -> bool:
        return bool(self._evaluation.feasible[0])

    @property
    def violations(self) -> list[dict[str, Any]]:
        """See Problem.violations."""
        return self.problem.violations(self._evaluation)

    @property
    def edges(self) -> list[str]:
        """What of the design lies at an edge of where it was looked for: a wider one may have better ones."""
        margins = self._evaluation.margins[0]
        of_space = {"crank_length", "rocker_length", "ankle_to_pedal", "rocker_pivot_inside", "crank_centre_inside"}
        limits = [
            f"{c.name} is at its limit ({MEANINGS[c.name].where})"
            for c, margin in zip(self.problem.constraints, margins, strict=True)
            if c.name in of_space and abs(margin) < _AT_EDGE * c.scale
        ]
        ranges = zip(VARIED[:LENGTH_COUNT], self.x, self.problem.search, strict=False)
        ends = [
            f"{name} is at the end of its search range (search.{name})"
            for name, value, (low, high) in ranges
            if name not in PIVOTS and low < high and min(value - low, high - value) < _AT_EDGE * (high - low)
        ]
        return [*limits, *ends]

    @property
    def riders(self) -> list[dict[str, float]]:
        """Whom the design was made for, the rider of its file first: legs and seat, and the power in it."""
        task, designs = self.problem, self.problem.riders(self.x)
        ground = designs[0].linkage.ground

        def power(design: Design) -> float:
            turn, turns_per_s = cycles(design, task.table), turns_per_second(design.linkage.cadence)
            return float(task.drive.power(design, turn, np.array([turns_per_s]), np.array([True]))[0, 0])

        return [
            {
                "thigh": design.rider.thigh,
                "shank": design.rider.shank,
                "forward_m": (design.linkage.ground - ground).real,
                "up_m": (ground - design.linkage.ground).imag,
                "seat_angle_deg": math.degrees(design.linkage.seat_angle),
                "power_mean_W": power(design),
            }
            for design in designs
        ]

    @property
    def limit_rows(self) -> list[tuple[str, str, str, str]]:
        """Constraint, value, limit and whether it is active, as text; without those on what a four-bar lacks."""
        values, margins = self._evaluation.values[0], self._evaluation.margins[0]
        return [
            (
                f"{c.name.replace('_', ' ')}, {c.unit}".rstrip(", "),
                f"{value:.4g}",
                f"{'>=' if c.at_least else '<='} {c.limit:.4g}",
                "active" if abs(margin) < _AT_EDGE * c.scale else "",
            )
            for c, value, margin in zip(self.problem.constraints, values, margins, strict=True)
            if np.isfinite(value)
        ]

    @cached_property
    def _evaluation(self) -> Evaluation:
        return self.problem.evaluate(self.x[None])


def optimize(
    kind: str,
    moments: JointMoments,
    *,
    method: str = "differential-evolution",
    budget: int | None = None,
    searches: int = 4,
    seed: int = 0,
    smooth: bool = False,
    workers: Workers = HERE,
    findings: Findings | None = None,
    progress: Callable[[int], AbstractContextManager[Advance]] = lambda _: nullcontext(lambda _: None),
    **problem: Unpack[ProblemOptions],
) -> Optimum:
    """The linkage of a kind ("crt", "cdt", "trt") with the most mean crank power under joint moments that can be built.

    method: one of search.METHODS, of which the best of so many independent searches counts, or "nsga-ii", which makes
    one and weighs the powers of both rider groups and, if `smooth`, the least fluctuation of energy. budget:
    evaluations of each search, by default search.BUDGETS, under muscles MUSCLE_BUDGET. seed: the same one finds the
    same design, wherever the searches run. findings: where results are kept, and finished ones taken from. progress:
    given the number of all evaluations, opens what is told how many more of them are behind. problem: limits, start,
    people: as for make_problem.

    Raises InputError for what make_problem refuses, a method that is none, a budget or number of searches below 1, a
    negative seed, what the method cannot do, an infeasible start, and if no search finds anything feasible;
    MissingPartError without the package of the method.

    >>> fes_mj.optimize("crt", fes_mj.load_moments("p1p2"), budget=1000, searches=1)
    <Optimum crt-p1p2: 24.71 W after 1000 evaluations>
    """
    require_one_of("method", method, BUDGETS)
    require_within("searches", searches, 1)
    require_within("budget", 1 if budget is None else budget, 1)
    require_within("seed", seed, 0)
    task = make_problem(kind, moments, **problem)
    if method == "nsga-ii" and (problem.get("caution") or not task.drive.proportional):
        raise InputError("nsga-ii weighs the powers of both groups under joint moments: not with caution or muscles")
    if smooth and method != "nsga-ii":
        raise InputError(f"smooth is an objective of its own, of nsga-ii; method is {method}")
    name = findings.name if findings else f"{kind}-{moments.name}"
    origin = problem.get("like") or problem.get("start")
    start, repair = None, ""
    if origin and load_design(origin).linkage.kind == kind:
        drawn = task.variables(task.template)
        start = drawn if task.evaluate(drawn[None]).feasible[0] else repaired(task, drawn, seed)
        repair = changes(drawn, start)
    if budget is None:
        budget = BUDGETS[method] if task.drive.proportional else MUSCLE_BUDGET
    count = 1 if method == "nsga-ii" else searches
    with findings.searching(task) if findings else nullcontext(), progress(count * budget) as advance:
        if method == "nsga-ii":
            front = _front(task, moments, budget, seed, smooth, findings)
            advance(budget)
            best = front.x[int(np.argmax(front.power.mean(axis=1)))]
            return Optimum(task, method, name, best, front.evaluations, front)
        results = run_searches(
            task, method, searches=searches, budget=budget, seed=seed, start=start,
            workers=workers, findings=findings, progress=advance,
        )  # fmt: skip
    return Optimum(task, method, name, results[0].x, sum(result.evaluations for result in results), repair=repair)


def _front(
    problem: Problem, moments: JointMoments, budget: int, seed: int, smooth: bool, findings: Findings | None
) -> Front:
    """Of the powers of both groups; their average is what counts as the best so far."""
    groups = tuple(map(load_moments, RIDER_GROUPS))
    averaged = replace(problem, table=WorkTable.of(*groups), drive=MomentDrive(moments))
    improved = partial(findings.improve, 0) if findings else None
    return pareto_front(averaged, groups, budget, seed, smooth, improved)


def run_searches(
    problem: Problem,
    method: str,
    *,
    budget: int,
    searches: int = 1,
    seed: int = 0,
    start: Start = None,
    workers: Workers = HERE,
    findings: Findings | None = None,
    progress: Advance = lambda _: None,
) -> list[SearchResult]:
    """Independent searches of a problem, best first; otherwise as optimize.

    start: ten variables, feasible; by default random. progress: told how many more evaluations are behind. Searches on
    a cluster, which may not see the files of findings, are kept when finished.
    """
    seeds = SeedSequence(seed).spawn(searches)
    outcomes: dict[int, SearchResult | InputError] = {**findings.finished()} if findings else {}
    here = workers.jobs == 1 and not workers.cluster
    progress(budget * len(outcomes))
    missing = [number for number in range(searches) if number not in outcomes]
    kept_at_once = None if workers.cluster else findings
    task = partial(search_once, problem, method, budget, start, kept_at_once, progress if here else None)
    for index, outcome in run_tasks(task, [(number, seeds[number]) for number in missing], workers):
        outcomes[missing[index]] = outcome
        if findings and isinstance(outcome, SearchResult):
            findings.finish(missing[index], outcome)
        done = outcome.evaluations if here and isinstance(outcome, SearchResult) else budget if here else 0
        progress(budget - done)
    ordered = [outcomes[number] for number in range(searches)]
    results = [outcome for outcome in ordered if isinstance(outcome, SearchResult)]
    if not results:
        raise next(outcome for outcome in ordered if isinstance(outcome, InputError))
    return sorted(results, key=lambda result: -result.merit)


def search_once(
    problem: Problem,
    method: str,
    budget: int,
    start: Start,
    findings: Findings | None,
    counted: Callable[[int], None] | None,
    task: tuple[int, SeedSequence],
) -> SearchResult | InputError:
    """One search, by its number and its own random numbers; an error, as a value, if nothing feasible turned up."""
    number, seed = task
    search = Search(problem, budget, partial(findings.improve, number) if findings else None, counted)
    with suppress(BudgetSpentError):
        METHODS[method](search, start, np.random.default_rng(seed))
    try:
        return search.result()
    except InputError as error:
        return error
