"""The outcome of a search: the best design, its constraints, the whole front where there is one; as JSON and files."""

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from fes_mj.arrays import FloatArray
from fes_mj.cycles import WorkTable
from fes_mj.design import Design
from fes_mj.design_file import design_toml
from fes_mj.files import csv_text, write_text
from fes_mj.moments import GROUPS, load_moments
from fes_mj.optimization.pareto import Front, pareto_front
from fes_mj.optimization.problem import Problem
from fes_mj.optimization.problem_file import VARIED
from fes_mj.optimization.winner import Winner
from fes_mj.simulation.export import mjcf_text
from fes_mj.simulation.mjcf import build_mjcf

FRONT_BUDGET = 50_000  # evaluations


@dataclass(frozen=True)
class Outcome:
    """x: the ten variables of the best design, shape (10,). evaluations: of all searches together."""

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
        return content | ({"front": self.front.as_json()} if self.front else {})

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

    def write(self, design: Design, out: Path, comment: str) -> dict[str, str]:
        """Design file, model, and the front as CSV, each whole or not at all; returns the key of JSON -> file."""
        files = {"design_file": out, "model_file": out.with_suffix(".xml")}
        write_text(out, design_toml(design, comment))
        write_text(files["model_file"], mjcf_text(build_mjcf(design)))
        if self.front:
            files["front_file"] = out.with_name(f"{out.stem}-front.csv")
            names = [*(f"power_{group}_W" for group in GROUPS), *VARIED]
            columns = np.column_stack([self.front.power, self.front.x]).T
            write_text(files["front_file"], csv_text(dict(zip(names, columns, strict=True))))
        return {key: str(path) for key, path in files.items()}


def front_outcome(problem: Problem, budget: int | None, seed: int, smooth: bool) -> Outcome:
    """The front, and of it the design with the most power averaged over both groups (the paper's recommendation)."""
    sets = tuple(load_moments(each) for each in GROUPS)
    averaged = replace(problem, table=WorkTable.of(*sets), baseline=0.0)
    front = pareto_front(averaged, sets, budget or FRONT_BUDGET, seed, smooth)
    best = front.x[int(np.argmax(front.power.mean(axis=1)))]
    return Outcome(problem, "nsga-ii", best, front.evaluations, front)
