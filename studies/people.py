"""Successors of R1 and D1 for people instead of for the paper's rider: what they look like, what they gain and lose.

Writes results/optimization/: people.md, people.json and a design file for each winner. Takes some minutes.
"""

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from fes_mj.common.markdown import Table
from fes_mj.common.parallel import Workers
from fes_mj.common.provenance import provenance
from fes_mj.common.units import turns_per_second
from fes_mj.common.writing import json_text, write_text
from fes_mj.fit.population import fit_population
from fes_mj.fit.search import best_seats
from fes_mj.fit.seat import fit_seat, seat_text
from fes_mj.fit.seats import Seats
from fes_mj.linkage.design import AT_JOINT, Design, Rider
from fes_mj.linkage.design_file import design_toml, load_design
from fes_mj.linkage.joints import PerJoint
from fes_mj.linkage.variables import COMPONENTS, component
from fes_mj.moments.files import load_moments
from fes_mj.optimization.limits import DEFAULT, load_limits
from fes_mj.optimization.optimize import run_searches
from fes_mj.optimization.people import sampled
from fes_mj.optimization.problem import Problem
from fes_mj.optimization.winner import Winner, assess
from fes_mj.statics.cycles import cycles, joint_speeds
from fes_mj.statics.work_table import WorkTable

FOLDER = Path("results/optimization")
MOMENTS = load_moments("p1p2")
TABLE = WorkTable.of(MOMENTS)
SAMPLES, SAMPLE_SEED = 1000, 0
SEARCHES, BUDGET, WORKERS = 3, 25_000, Workers(jobs=2)
TARGETS = ("r1", "d1")
STATISTICS = {"population": "the mean", "population-p10": "the 10th percentile"}
VARIED = tuple(name for name, (variable, _) in COMPONENTS.items() if variable.owner == "linkage")


@dataclass(frozen=True)
class Row:
    """A design, and what people get from it; W."""

    made_for: str
    design: Design
    winner: Winner
    content: dict[str, Any]


def riders() -> tuple[np.ndarray, np.ndarray]:
    """Thigh and shank, m, of the riders who stand for the sample."""
    thigh, shank = sampled("population", SAMPLES, SAMPLE_SEED).others.T
    return thigh, shank


def fitted_speeds(design: Design) -> PerJoint[np.ndarray]:
    """Mean absolute joint speeds of these riders, each in his best seat, deg/s."""
    thigh, shank = riders()
    seats, _ = best_seats(design, thigh, shank, TABLE)
    batch = design.with_rider(thigh=thigh[:, None], shank=shank[:, None])
    turn = cycles(Seats(*(part[:, None] for part in seats)).moved(batch), TABLE)
    return turn.joints.map(lambda joint: np.degrees(joint.travel) * turns_per_second(design.linkage.cadence))


def problem(target: str, statistic: str) -> Problem:
    """Joint speeds at most those of the printed design with anyone, its gear ratio, 5 mm of Grashof margin."""
    design = load_design(target)
    # half a degree beyond the limits, which rounding excuses in a printed design, is what `fit` would give back
    limits = replace(load_limits(), gear_ratio_max=design.linkage.gear_ratio + 1e-9, joint_rounding_deg=0.0)
    fitted, drawn = fitted_speeds(design), joint_speeds(design, TABLE)
    speeds = PerJoint.of(lambda joint: max(float(fitted[joint].max()), drawn[joint]) * (1 + 1e-9))
    return Problem(design, TABLE, limits, speeds, people=sampled(statistic, SAMPLES, SAMPLE_SEED))


def row(made_for: str, design: Design, printed: Design) -> Row:
    """Measure a design."""
    population = fit_population(design, MOMENTS, samples=SAMPLES, seed=SAMPLE_SEED)
    powers = np.concatenate([np.nan_to_num(rider.fitted.power) for rider in population.riders.values()])
    paper = fit_seat(design, Rider(), MOMENTS)
    power_of_paper = {key: value for key, value in paper.summary().items() if key.startswith("power")}
    content = {
        "design": design.name,
        "made_for": made_for,
        "power_people_mean_W": float(powers.mean()),
        "power_people_p10_W": float(np.percentile(powers, 10)),
        "can_ride": float(np.mean(powers > 0)),
        "can_ride_as_drawn": float(np.mean([*population.summary()["share_unmoved"].values()])),
        "power_paper_rider_fitted_W": power_of_paper["power_mean_W"],
        "power_paper_rider_drawn_W": power_of_paper["power_unmoved_W"],
        "paper_rider_seat": seat_text(paper.seat),
        **{f"{joint}_speed_max_deg_s": float(speed.max()) for joint, speed in fitted_speeds(design).items()},
        "map_error_W": population.map_error,
    }
    return Row(made_for, design, assess(design, printed, MOMENTS), content)


def rows(target: str) -> list[Row]:
    """The printed design, its successor for the paper's rider, and those for people."""
    printed = load_design(target)
    people = [row("the paper's rider (printed)", printed, printed)]
    path = FOLDER / f"{target}-caution-0.toml"
    people.append(row("the paper's rider", load_design(path), printed))
    for statistic, words in STATISTICS.items():
        task = problem(target, statistic)
        best = run_searches(task, "cma-es", searches=SEARCHES, budget=BUDGET, seed=2, workers=WORKERS)
        design = task.design(best[0].x, f"{target}-{statistic}")
        write_text(FOLDER / f"{design.name}.toml", design_toml(design, "Found by studies/people.py."))
        people.append(row(f"people, {words}", design, printed))
        people[-1].content["power_within_speeds_W"] = [result.merit for result in best]
        print(people[-1].content, flush=True)
    return people


def markdown(by_target: dict[str, list[Row]]) -> str:
    """The page."""
    every = [row for group in by_target.values() for row in group]
    names = VARIED
    dimensions = {"design": "", **dict.fromkeys(names, ".3f")}
    parts = [
        "# Designs for people instead of for one rider",
        "Written by `python -m studies.people`; versions and inputs: people.json. A search of the kind is "
        "`fes_mj optimize crt --riders population --method cma-es`.",
        f"{SAMPLES} men and as many women (ANSUR II, sample seed {SAMPLE_SEED}), moments of p1p2; power of one leg at "
        "the crank, W. Seat moved: to where `fes_mj fit` finds it for him or her; who cannot ride counts as no power. "
        "The successors are drawn for the paper's rider, as all designs are, but only the power of the people counted; "
        "they have at most the joint speeds that the printed design gives anyone, its gear ratio, and 5 mm of Grashof "
        "margin. Made for the paper's rider: comparison.md, caution 0, which has half a degree more of joint range "
        "and was not asked for the speeds of others. Knee and hip speed: largest mean of the absolute, among the "
        "riders who stand for the sample, seats moved.",
        Table("What people get", COLUMNS, [_cells(row) for row in every]).markdown().strip(),
        "## What the successors gain and lose",
        "\n".join(line for group in by_target.values() for line in _gains(group)),
        _degenerate([row.design for row in every]),
        Table(
            "Dimensions",
            dimensions,
            [(row.design.name, *(component(row.design, name) for name in names)) for row in every],
            "Metres and degrees, as in design files.",
        )
        .markdown()
        .strip(),
    ]
    return "\n\n".join(parts) + "\n"


COLUMNS = {
    "design": "",
    "made for": "",
    "people, mean": ".2f",
    "people, 10th percentile": ".2f",
    "can ride, %": ".1f",
    "seat as drawn, %": ".1f",
    "paper's rider": ".2f",
    "seat as drawn": ".2f",
    "knee speed, deg/s": ".1f",
    "hip speed, deg/s": ".1f",
    "simulated": ".2f",
    "agrees": "",
}


def _cells(row: Row) -> tuple[Any, ...]:
    content, case = row.content, row.winner.case
    return (
        row.design.name,
        row.made_for,
        content["power_people_mean_W"],
        content["power_people_p10_W"],
        100 * content["can_ride"],
        100 * content["can_ride_as_drawn"],
        content["power_paper_rider_fitted_W"],
        content["power_paper_rider_drawn_W"],
        content["knee_speed_max_deg_s"],
        content["hip_speed_max_deg_s"],
        case.simulation.power_mean,
        "yes" if case.agrees else "NO",
    )


def _gains(group: list[Row]) -> list[str]:
    keys = ("power_people_mean_W", "power_people_p10_W", "power_paper_rider_fitted_W")
    lines = []
    for row in group[2:]:
        parts = []
        for other in group[:2]:
            mean, low, paper = (f"{row.content[key] - other.content[key]:+.2f}" for key in keys)
            parts.append(f"against {other.design.name} {mean} W in the mean, {low} W at the 10th percentile, {paper} W")
        seat = row.content["paper_rider_seat"]
        lines.append(
            f"- {row.design.name}: {parts[0]} for the paper's rider, whose seat moves {seat}; {parts[1]} for that "
            "rider."
        )
    return lines


def _degenerate(designs: list[Design]) -> str:
    close = [
        f"{design.name} ({component(design, 'R8') * 1e3:.1f} mm)"
        for design in designs
        if component(design, "R8") < AT_JOINT
    ]
    return "Pedal practically on the rocker joint, so that the coupler no longer drives it: " + ", ".join(close) + "."


def main() -> None:
    """Search, compare, write; after every target what is known by then."""
    by_target: dict[str, list[Row]] = {}
    for target in TARGETS:
        by_target[target] = rows(target)
        write_text(FOLDER / "people.md", markdown(by_target))
        content = {
            "provenance": provenance([DEFAULT]),
            "designs": [row.content for g in by_target.values() for row in g],
        }
        write_text(FOLDER / "people.json", json_text(content))


if __name__ == "__main__":
    main()
