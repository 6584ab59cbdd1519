"""The paper's random pursuit beside the other methods, and designs that beat the printed ones.

Writes results/optimization/: comparison.json, comparison.md and a design file for each winner. Takes some minutes.
"""

import time
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from fes_mj.common.markdown import Table
from fes_mj.common.parallel import Workers
from fes_mj.common.provenance import provenance
from fes_mj.common.writing import json_text, write_text
from fes_mj.linkage.design_file import design_toml, load_design
from fes_mj.moments.files import load_moments
from fes_mj.moments.joint_moments import RIDER_GROUPS
from fes_mj.optimization.limits import DEFAULT, load_limits
from fes_mj.optimization.moment_drive import MomentDrive
from fes_mj.optimization.optimize import run_searches
from fes_mj.optimization.pareto import pareto_front
from fes_mj.optimization.problem import Problem
from fes_mj.optimization.search import BUDGETS, SearchResult
from fes_mj.optimization.winner import Winner, assess, gain
from fes_mj.statics.cycles import joint_speeds
from fes_mj.statics.work_table import WorkTable, uncertain_table

FOLDER = Path("results/optimization")
SEEDS, BUDGET, WORKERS = 5, 50_000, Workers(jobs=2)
SEARCHES, SEARCH_BUDGET = 3, 20_000  # for each winner
TARGETS = {"r1": "p1p2", "r2": "p1p3", "d1": "p1p2", "d2": "p1p3"}  # the group each was optimised for
CAUTIONS = (0.0, 1.0, 2.0)


class Row(NamedTuple):
    """One method on one target: power in W over the seeds, evaluations of a search."""

    target: str
    method: str
    median: float
    best: float
    spread: float
    evaluations: float
    to_pursuit_median: float | None  # evaluations until random pursuit's median was passed, median of the seeds


def problem(target: str, manufacturable: bool, caution: float = 0.0) -> Problem:
    """Joint speeds and gear ratio no larger than the printed design's own; the paper's Grashof condition or ours."""
    design, table = load_design(target), uncertain_table(load_moments(TARGETS[target]))
    limits = replace(load_limits(), gear_ratio_max=design.linkage.gear_ratio + 1e-9)
    if not manufacturable:
        limits = replace(limits, grashof_min=0.0)
    speeds = joint_speeds(design, table).map(lambda speed: speed * (1 + 1e-9))
    task = Problem(design, table, limits, speeds)
    paper = replace(task, limits=replace(limits, grashof_min=0.0))
    baseline = paper.evaluate(task.variables(design)[None]).power[0]
    return replace(task, drive=MomentDrive(caution=caution, baseline=baseline))


def summarise(target: str, method: str, results: list[SearchResult], reference: float | None) -> Row:
    merits = np.array([result.merit for result in results])
    reached = None
    if reference is not None:
        counts = [
            float(result.history[np.argmax(passed), 0])
            if (passed := result.history[:, 1] >= reference).any()
            else np.inf
            for result in results
        ]
        reached = float(np.median(counts))
    evaluations = float(np.median([result.evaluations for result in results]))
    return Row(
        target, method, float(np.median(merits)), float(merits.max()), float(np.ptp(merits)), evaluations, reached
    )


def at_budget(result: SearchResult, budget: int) -> SearchResult:
    """What a search had found after `budget` evaluations."""
    history = result.history[result.history[:, 0] <= budget]
    merit = float(history[-1, 1]) if len(history) else -np.inf
    return replace(result, merit=merit, evaluations=min(budget, result.evaluations))


def compare(target: str) -> list[Row]:
    """All methods under the paper's own constraints, the same seeds."""
    task = problem(target, manufacturable=False)
    printed_variables = task.variables(task.template)
    options: dict[str, Any] = {"searches": SEEDS, "seed": 1, "workers": WORKERS}
    usual = BUDGETS["random-pursuit"]
    pursued = run_searches(task, "random-pursuit", budget=usual, **options)
    own = options | {"searches": 2}
    from_own = run_searches(task, "random-pursuit", budget=usual, start=printed_variables, **own)
    median = float(np.median([result.merit for result in pursued]))
    printed = float(task.evaluate(printed_variables[None]).power[0, 0])
    rows = [
        Row(target, "printed design", printed, printed, 0.0, 1, None),
        summarise(target, "random pursuit from the printed design, to its end", from_own, None),
        summarise(target, "random pursuit from random starts, to its end", pursued, median),
        summarise(target, f"random pursuit, {BUDGET:,} evaluations", [at_budget(r, BUDGET) for r in pursued], None),
    ]
    for method in ("differential-evolution", "cma-es"):
        rows += [summarise(target, method, run_searches(task, method, budget=BUDGET, **options), median)]
    return rows


def best_with(target: str, caution: float) -> Winner:
    """The best manufacturable design by CMA-ES, simulated."""
    task = problem(target, manufacturable=True, caution=caution)
    best = run_searches(task, "cma-es", searches=SEARCHES, budget=SEARCH_BUDGET, seed=2, workers=WORKERS)[0]
    design = task.design(best.x, f"{target}-caution-{caution:.0f}")
    return assess(design, task.template, load_moments(TARGETS[target]))


def fronts() -> dict[str, Any]:
    """NSGA-II for both kinds at the TRT's joint speeds: the ends of the front and the designs between."""
    trt = load_design("trt")
    result = {}
    for kind, template in (("crt", "r1"), ("cdt", "d1")):
        moments = tuple(load_moments(group) for group in RIDER_GROUPS)
        table = WorkTable.of(*moments)
        task = Problem(load_design(template), table, load_limits(), joint_speeds(trt, table))
        front = pareto_front(task, moments, BUDGET, seed=1)
        result[kind] = {"evaluations": front.evaluations, "power_W": front.power.tolist(), "x": front.x.tolist()}
    return result


def unbounded() -> dict[str, str]:
    """The power of D1's problem when only joint speed is bounded, as a function of the gear ratio allowed."""
    notes = {}
    for ratio in (2.1, 4.0, 8.0, 16.0):
        task = problem("d1", manufacturable=True)
        task = replace(task, limits=replace(task.limits, gear_ratio_max=ratio))
        best = run_searches(task, "cma-es", searches=2, budget=20_000, seed=3, workers=WORKERS)[0]
        turn = task.evaluate(best.x[None])
        values = dict(zip((c.name for c in task.constraints), turn.values[0], strict=True))
        assert isinstance(task.drive, MomentDrive)
        gained = gain(turn.power[0], np.asarray(task.drive.baseline))
        notes[f"D1's joint speeds, gear ratio up to {ratio:g}"] = (
            f"{best.merit:.2f} W ({gained.mean:+.2f} ± {gained.deviation:.2f} W), knee {values['knee_min']:.1f} to "
            f"{values['knee_max']:.1f} deg at gear ratio {best.x[-1]:.2f}"
        )
    return notes


METHODS = {
    "target": "",
    "method": "",
    **dict.fromkeys(("median", "best", "spread"), ".2f"),
    **dict.fromkeys(("evaluations", "to pursuit's median"), ",.0f"),
}
WINNERS = {
    "target": "",
    "caution": ".0f",
    "power, W": ".2f",
    "gain, W": "",
    "simulated, W": ".2f",
    "agrees": "",
    "knee reversals": "d",
    **dict.fromkeys(("±1 mm, %", "legs ±5 cm, %"), ".1f"),
    "limits of building it leaves": "",
}


def markdown(content: dict[str, Any]) -> str:
    """The page, from what comparison.json says."""
    winners = [
        (
            won["target"],
            won["caution"],
            won["power_mean_W"],
            f"{won['gain_W']:+.2f} ± {won['gain_deviation_W']:.2f}",
            won["simulated_power_mean_W"],
            "yes" if won["agrees"] else "NO",
            won["reversals"]["knee"],
            100 * won["manufacturing"]["turning"],
            100 * won["rider"]["turning"],
            ", ".join(won["leaves"]) or "none",
        )
        for won in content["winners"]
    ]
    parts = [
        "# Optimisers side by side",
        f"Power of the group a design was made for, W; {SEEDS} seeds; joint speeds and gear ratio at most those of "
        "the printed design; the paper's constraints.",
        Table("", METHODS, [tuple(row.values()) for row in content["methods"]]).markdown().strip(),
        "# Designs that beat the printed ones",
        "CMA-ES, with 5 mm of Grashof margin. Gain: over the identified printed design under the same recovered "
        "moments, with the standard deviation of the difference. Caution: how many were taken off in the search. Of "
        "samples with lengths off by 1 mm, and with thigh and shank off by 5 cm: how many can turn. The last column: "
        "the limits of what can be built that a design leaves; [these designs](buildable.md) keep them.",
        Table("", WINNERS, winners).markdown().strip(),
        "# What bounds the power",
        "\n".join(f"- {name}: {text}" for name, text in content["bounds"].items()),
    ]
    return "\n\n".join(parts) + "\n"


def record(winner: Winner, target: str, caution: float) -> dict[str, Any]:
    """A winner as comparison.json has it."""
    return {
        "target": target,
        "caution": caution,
        "power_mean_W": winner.case.static.power_mean,
        "gain_W": winner.gain.mean if winner.gain else None,
        "gain_deviation_W": winner.gain.deviation if winner.gain else None,
        "simulated_power_mean_W": winner.case.simulation.power_mean,
        "timestep_s": winner.case.simulation.timestep,
        "agrees": winner.case.agrees,
        "reversals": dict(winner.reversals.items()),
        "manufacturing": winner.manufacturing._asdict(),
        "rider": winner.rider._asdict(),
        "leaves": [*winner.build.broken()],
    }


def main() -> None:
    """Compare, find winners, write the results; after every target what is known by then."""
    started = time.perf_counter()
    FOLDER.mkdir(parents=True, exist_ok=True)
    content: dict[str, Any] = {
        "provenance": provenance([DEFAULT]), "methods": [], "winners": [], "bounds": unbounded(), "fronts": fronts(),
    }  # fmt: skip
    for target in TARGETS:
        content["methods"] += [row._asdict() for row in compare(target)]
        for caution in CAUTIONS:
            winner = best_with(target, caution)
            text = design_toml(winner.design, "Found by studies/optimizers.py.")
            write_text(FOLDER / f"{winner.design.name}.toml", text)
            content["winners"].append(record(winner, target, caution))
        write_text(FOLDER / "comparison.json", json_text(content))
        write_text(FOLDER / "comparison.md", markdown(content))
        print(f"{target}: {time.perf_counter() - started:.0f} s", flush=True)
    print((FOLDER / "comparison.md").read_text())


if __name__ == "__main__":
    main()
