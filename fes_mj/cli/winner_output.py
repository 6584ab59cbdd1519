"""What `fes_mj optimize` shows and writes of the design that it found."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from fes_mj.cli.output import output, print_table
from fes_mj.design import Design
from fes_mj.design_file import design_toml
from fes_mj.files import write_text
from fes_mj.torque import GROUPS

if TYPE_CHECKING:
    from fes_mj.optimization.pareto import Front
    from fes_mj.optimization.problem import Problem
    from fes_mj.optimization.winner import Winner


class Found(NamedTuple):
    """The outcome of a search: variables of the best design, and the whole front where there is one."""

    task: Problem
    method: str
    x: Any
    evaluations: int
    front: Front | None = None


def summary(winner: Winner, found: Found) -> dict[str, Any]:
    """The keys of the JSON object."""
    task, front, check = found.task, found.front, winner.check
    evaluation = task.evaluate(found.x[None])
    content: dict[str, Any] = {
        "kind": winner.design.linkage.kind,
        "group": check.static.moments.name,
        "method": found.method,
        "power_mean_W": check.static.power_mean,
        "work_per_turn_J": check.static.work_per_turn,
        "cadence_rpm": check.static.cadence * 30 / math.pi,
        "feasible": bool(evaluation.feasible[0]),
        "violations": task.violations(evaluation),
        "evaluations": found.evaluations,
        "mean_knee_speed_deg_s": winner.speeds["knee"],
        "mean_hip_speed_deg_s": winner.speeds["hip"],
        "reversals_per_turn": winner.reversals,
        "simulated_power_mean_W": check.simulation.power_mean,
        "relative_difference": check.relative_difference,
        "timestep_s": check.simulation.timestep,
        "agrees": check.agrees,
        "compared_with": winner.rival.name,
        "gain_W": winner.gain.mean if winner.gain else None,
        "gain_deviation_W": winner.gain.deviation if winner.gain else None,
        "tolerance_manufacturing": winner.manufacturing._asdict(),
        "tolerance_rider": winner.rider._asdict(),
        "design_space": task.limits.space,
    }
    if front:
        content["front"] = [
            {"power_mean_W": dict(zip(GROUPS, power, strict=True)), "x": list(row)}
            | ({} if front.fluctuation is None else {"fluctuation": front.fluctuation[number]})
            for number, (power, row) in enumerate(zip(front.power.tolist(), front.x.tolist(), strict=True))
        ]
    return content


def rows(winner: Winner) -> list[tuple[str, str]]:
    """What was found out about a winner, as text."""
    check, static = winner.check, winner.check.static
    cells = [
        ("mean crank power by statics, W", f"{static.power_mean:.3f}"),
        ("mean crank power simulated, W", f"{check.simulation.power_mean:.3f}"),
        ("time step of the simulation, ms", f"{1e3 * check.simulation.timestep:.3g}"),
        ("work per turn, J", f"{static.work_per_turn:.3f}"),
        ("cadence, rpm", f"{static.cadence * 30 / math.pi:.1f}"),
        ("mean knee speed, deg/s", f"{winner.speeds['knee']:.1f}"),
        ("mean hip speed, deg/s", f"{winner.speeds['hip']:.1f}"),
        ("reversals of knee and hip in a turn", f"{winner.reversals['knee']}, {winner.reversals['hip']}"),
    ]
    if winner.gain:
        cells.append((f"gain over {winner.rival.name}, W", f"{winner.gain.mean:+.2f} ± {winner.gain.deviation:.2f}"))
    for what, tolerance in (("lengths ±1 mm", winner.manufacturing), ("thigh, shank ±5 cm", winner.rider)):
        cells.append((f"{what}: can turn", f"{100 * tolerance.turning:.1f} %"))
        cells.append((f"{what}: 5th percentile of power, W", f"{tolerance.power_low:.2f}"))
    return cells


def limits_table(found: Found) -> list[tuple[str, str, str, str]]:
    """Constraint, value, limit and whether it is active, as text."""
    task, evaluation = found.task, found.task.evaluate(found.x[None])
    return [
        (
            f"{c.name.replace('_', ' ')}, {c.unit}".rstrip(", "),
            f"{value:.4g}",
            f"{'>=' if c.at_least else '<='} {c.limit:.4g}",
            "active" if abs(margin) < 0.01 * c.scale else "",
        )
        for c, value, margin in zip(task.constraints, evaluation.values[0], evaluation.margins[0], strict=True)
    ]


def print_winner(winner: Winner, found: Found) -> None:
    """Tables of what was found, and notes on what to beware of."""
    front = found.front
    title = f"{winner.design.name}: {winner.design.linkage.architecture.title}; {winner.check.static.moments.name}"
    print_table(f"{title}; {found.method}, {found.evaluations:,} evaluations", ("", "value"), rows(winner))
    print_table("Constraints", ("constraint", "value", "limit", ""), limits_table(found))
    if front:
        keep = np.unique(np.linspace(0, len(front.x) - 1, 12).astype(int))
        cells = [(f"{number}", *(f"{power:.2f}" for power in front.power[number])) for number in keep]
        print_table(f"Front, {len(keep)} of {len(front.x)} designs", ("design", *(f"{g}, W" for g in GROUPS)), cells)
    if winner.gain and winner.gain.mean > 0 and not winner.gain.beyond_error:
        output.print(
            "note: the gain is within the error bar of the recovered moments; --caution 1 looks for a surer one"
        )
    if winner.reversals["knee"] > 2:
        output.print("note: the knee swings more than once per turn of the crank; can the muscles follow?")
    output.print("note: the design space is an assumption, see --problem", soft_wrap=True)


def write_design(design: Design, front: Front | None, out: Path, told: str) -> dict[str, str]:
    """Design file, model, and the front as CSV; each whole or not at all."""
    from fes_mj.export import mjcf_text
    from fes_mj.optimization.problem_file import VARIABLES

    write_text(out, design_toml(design, told))
    model = out.with_suffix(".xml")
    write_text(model, mjcf_text(design))
    files = {"design_file": str(out), "model_file": str(model)}
    if front:
        table = np.column_stack([front.power, front.x])
        lines = [",".join([*(f"power_{group}_W" for group in GROUPS), *VARIABLES])]
        lines += [",".join(f"{value:.6g}" for value in row) for row in table.tolist()]
        files["front_file"] = str(out.with_name(f"{out.stem}-front.csv"))
        write_text(Path(files["front_file"]), "\n".join(lines) + "\n")
    return files
