"""The outcome of a search: the best design, its constraints, the whole front where there is one; as JSON and text."""

import math
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.moments.files import load_moments
from fes_mj.moments.joint_moments import GROUPS
from fes_mj.optimization.findings import Findings
from fes_mj.optimization.pareto import Front, pareto_front
from fes_mj.optimization.problem import Problem
from fes_mj.optimization.winner import Winner
from fes_mj.statics.cycles import WorkTable, cycles


@dataclass(frozen=True)
class Outcome:
    """x: variables of the best design, shape (variables,). evaluations: of all searches together."""

    problem: Problem
    method: str
    x: FloatArray
    evaluations: int
    front: Front | None = None

    def summary(self, winner: Winner) -> dict[str, Any]:
        """The result as JSON names and units it."""
        problem, case, evaluation = self.problem, winner.case, self.problem.evaluate(self.x[None])
        static = case.static.summary()
        content: dict[str, Any] = {
            "kind": winner.design.linkage.kind,
            "group": case.moments.name,
            "method": self.method,
            **{key: static[key] for key in ("power_mean_W", "work_per_turn_J", "cadence_rpm")},
            "feasible": bool(evaluation.feasible[0]),
            "violations": problem.violations(evaluation),
            "evaluations": self.evaluations,
            **{f"mean_{joint}_speed_deg_s": speed for joint, speed in winner.joint_speed.items()},
            "reversals_per_turn": dict(winner.reversals.items()),
            **winner.smoothness,
            "simulated_power_mean_W": case.simulation.power_mean,
            "relative_difference": case.relative_difference,
            "timestep_s": case.simulation.timestep,
            "agrees": case.agrees,
            "compared_with": winner.compared_with.name,
            "gain_W": winner.gain.mean if winner.gain else None,
            "gain_deviation_W": winner.gain.deviation if winner.gain else None,
            "tolerance_manufacturing": winner.manufacturing._asdict(),
            "tolerance_rider": winner.rider._asdict(),
            "design_space": problem.limits.space,
        }
        if problem.people.count > 1:
            content |= {"power_people_W": float(evaluation.power[0, 0]), "riders": self.riders}
        return content | ({"front": self.front.as_json()} if self.front else {})

    @property
    def riders(self) -> list[dict[str, float]]:
        """Whom the design was made for, the rider of its file first: legs and seat, and the power in it."""
        designs = self.problem.riders(self.x)
        return [
            {
                "thigh": each.rider.thigh,
                "shank": each.rider.shank,
                "forward_m": (each.linkage.ground - designs[0].linkage.ground).real,
                "up_m": (designs[0].linkage.ground - each.linkage.ground).imag,
                "seat_angle_deg": math.degrees(each.linkage.seat_angle),
                "power_mean_W": float(cycles(each, self.problem.table).work[0, 0]) * each.linkage.cadence / (2 * np.pi),
            }
            for each in designs
        ]

    @property
    def limit_rows(self) -> list[tuple[str, str, str, str]]:
        """Constraint, value, limit and whether it is active, as text."""
        evaluation = self.problem.evaluate(self.x[None])
        return [
            (
                f"{c.name.replace('_', ' ')}, {c.unit}".rstrip(", "),
                f"{value:.4g}",
                f"{'>=' if c.at_least else '<='} {c.limit:.4g}",
                "active" if abs(margin) < 0.01 * c.scale else "",
            )
            for c, value, margin in zip(
                self.problem.constraints, evaluation.values[0], evaluation.margins[0], strict=True
            )
        ]


def front_outcome(problem: Problem, budget: int, seed: int, smooth: bool, findings: Findings | None = None) -> Outcome:
    """The front, and of it the design with the most power averaged over both groups (the paper's recommendation)."""
    sets = tuple(load_moments(each) for each in GROUPS)
    averaged = replace(problem, table=WorkTable.of(*sets), baseline=0.0)
    improved = partial(findings.improve, 0) if findings else None
    front = pareto_front(averaged, sets, budget, seed, smooth, improved)
    best = front.x[int(np.argmax(front.power.mean(axis=1)))]
    return Outcome(problem, "nsga-ii", best, front.evaluations, front)
