"""The front of mean power against ripple for the coupler-driven tricycle, and how its designs ride.

Writes results/optimization/: ripple.md, ripple.json, ripple.png and a design file for each winner. Takes some minutes;
with --picture it only draws again what stands in ripple.json.
"""

import json
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

from fes_mj.common.markdown import Table
from fes_mj.common.parallel import Workers
from fes_mj.common.provenance import provenance
from fes_mj.common.style import COLOURS, STYLE
from fes_mj.common.units import KMH
from fes_mj.common.writing import json_text, write_text
from fes_mj.crosscheck.ride_case import RideCase
from fes_mj.linkage.design import Design
from fes_mj.linkage.design_file import design_toml, load_design
from fes_mj.moments.files import load_moments
from fes_mj.optimization.evenness import RippleLimit
from fes_mj.optimization.limits import DEFAULT
from fes_mj.optimization.optimize import run_searches
from fes_mj.optimization.problem import Problem
from fes_mj.optimization.winner import assess
from fes_mj.riding.ride import Ride, balancing_slope, steady_ripple
from studies.optimizers import problem

FOLDER = Path("results/optimization")
MOMENTS = load_moments("p1p2")
LIMITS = (None, 0.14, 0.12, 0.10, 0.08, 0.06, 0.045, 0.03)
SEARCHES, BUDGET, WORKERS = 2, 15_000, Workers(jobs=2)
PRINTED = ("r1", "r2", "d1", "d2")
COLUMNS = {
    "design": "",
    "largest ripple allowed, %": ".1f",
    "power, W": ".2f",
    "simulated, W": ".2f",
    "±1 mm: can turn, %": ".1f",
    "5th percentile, W": ".2f",
    "ripple, %": ".2f",
    "slope, %": ".2f",
    "with a freewheel": "",
    "its speed, km/h": ".2f",
    "freewheeling, %": ".1f",
    "solvers agree": "",
}


def even(limit: float | None) -> Problem:
    """The problem of D1 with a limit on the ripple: its joint speeds and gear ratio, 5 mm of Grashof margin."""
    task = replace(problem("d1", manufacturable=True), ripple=None)
    return task if limit is None else replace(task, ripple=RippleLimit(limit, MOMENTS))


def ridden(design: Design, limit: float | None) -> dict[str, Any]:
    """A design on the slope that its mean power balances, with a freewheel: the cells of COLUMNS."""
    level = Ride(design, MOMENTS)
    slope, winner = balancing_slope(level), assess(design, load_design("d1"), MOMENTS)
    case = RideCase(replace(level, road=replace(level.road, slope=slope)))
    trace = case.simulation.trace
    stopped = f"stops after {trace.stopped_at:.1f} s" if trace.stopped_at is not None else "rides"
    cells = (
        design.name,
        None if limit is None else 100 * limit,
        winner.case.static.power_mean,
        winner.case.simulation.power_mean,
        100 * winner.manufacturing.turning,
        winner.manufacturing.power_low,
        100 * steady_ripple(replace(level, transmission="fixed")),
        100 * slope,
        stopped,
        trace.mean_speed / KMH if trace.mean_speed else None,
        100 * trace.coasting_share,
        "yes" if all(check.ok for check in case.checks) else "NO",
    )
    return dict(zip(COLUMNS, cells, strict=True))


def found(limit: float | None) -> Design:
    """The design with the most power within a limit, written as a file."""
    task = even(limit)
    best = run_searches(task, "cma-es", searches=SEARCHES, budget=BUDGET, seed=2, workers=WORKERS)[0]
    name = "d1-ripple-free" if limit is None else f"d1-ripple-{100 * limit:g}"
    design = task.design(best.x, name)
    write_text(FOLDER / f"{name}.toml", design_toml(design, "Found by studies/ripple.py."))
    return design


def markdown(rows: list[dict[str, Any]]) -> str:
    """The page."""
    table = Table("", COLUMNS, [tuple(row.values()) for row in rows])
    parts = [
        "# Power against ripple",
        "Written by `python -m studies.ripple`; versions and inputs: ripple.json. A search of the kind is "
        "`fes_mj optimize cdt --speeds-of d1 --ripple-limit 8 --method cma-es`.",
        "The coupler-driven tricycle with the most mean power of one leg, p1p2, at most D1's joint speeds and gear "
        "ratio, 5 mm of Grashof margin, and a ripple of the crank speed, (largest - smallest) / mean, below a limit: "
        "with both legs and a fixed gear at 5.71 km/h on the level, the frame free to recoil. Each is then ridden, by "
        "MuJoCo and by the reduced equation of motion, for a minute with a freewheel on the slope that its mean power "
        "balances at this speed, its moments independent of speed.",
        "![Power against ripple](ripple.png)",
        table.markdown().strip(),
    ]
    return "\n\n".join(parts) + "\n"


def draw(rows: list[dict[str, Any]]) -> None:
    """The front with the printed designs, as a picture; filled where the freewheel rides."""
    import matplotlib as mpl
    from matplotlib.figure import Figure

    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(7, 4.5), layout="constrained")
        axes = figure.subplots()
        new = sorted((row["ripple, %"], row["power, W"]) for row in rows if row["design"].startswith("d1-"))
        axes.plot(*zip(*new, strict=True), color=COLOURS["comparison"], lw=1, zorder=1)
        for row in rows:
            point, rides = (row["ripple, %"], row["power, W"]), row["with a freewheel"] == "rides"
            is_d1 = row["design"].startswith("d1-")
            axes.plot(*point, "o" if is_d1 else "s", color="black", mfc="black" if rides else "white", zorder=2)
            if not is_d1:
                axes.annotate(row["design"].upper(), point, xytext=(6, 4), textcoords="offset points")
        axes.set(xlabel="ripple of the crank speed, %", ylabel="mean power of one leg, W", xlim=(0, None))
        axes.set_title("Power against ripple", loc="left")
        for marker, face, label in (
            ("o", "none", "found"),
            ("s", "none", "printed"),
            ("d", "black", "filled: rides with a freewheel on the slope its power balances"),
        ):
            axes.plot([], [], marker, color="black", mfc=face, label=label)
        axes.legend(loc="lower right")
        figure.savefig(FOLDER / "ripple.png", dpi=150)


def main() -> None:
    """Search, ride, write; after every design what is known by then."""
    if "--picture" in sys.argv:
        draw(json.loads((FOLDER / "ripple.json").read_text(encoding="utf-8"))["designs"])
        return
    rows = [ridden(load_design(name), None) for name in PRINTED]
    for limit in LIMITS:
        rows.append(ridden(found(limit), limit))
        print(rows[-1], flush=True)
        write_text(FOLDER / "ripple.md", markdown(rows))
        write_text(FOLDER / "ripple.json", json_text({"provenance": provenance([DEFAULT]), "designs": rows}))
    draw(rows)


if __name__ == "__main__":
    main()
