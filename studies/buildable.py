"""The best designs that can be built, beside the traditional tricycle at its best and beside what was found without.

    python -m studies.buildable

Writes results/optimization/buildable.json and .md. The designs are those of results/optimization/buildable; each has
the command that finds it in its first lines.
"""

from __future__ import annotations

import itertools
import sys
from dataclasses import fields
from pathlib import Path
from typing import Any

from fes_mj.common.console import track
from fes_mj.common.errors import InputError
from fes_mj.common.markdown import Table
from fes_mj.common.provenance import provenance
from fes_mj.common.writing import json_text, write_text
from fes_mj.crosscheck.ride_case import RideCase
from fes_mj.crosscheck.turn_case import Case
from fes_mj.fit.population import fit_population
from fes_mj.linkage.design_file import DESIGNS, load_design
from fes_mj.moments.files import load_moments
from fes_mj.moments.joint_moments import RIDER_GROUPS
from fes_mj.optimization.buildable import PLAIN_BEARINGS, Buildability, BuildLimits
from fes_mj.riding.ride import Ride
from fes_mj.statics.friction import BearingLoss
from fes_mj.statics.joint_forces import JointForces
from fes_mj.statics.sizes import build
from fes_mj.statics.turn import difference_sd, quasi_static, ratio_sd

FOLDER = Path(__file__).parents[1] / "results" / "optimization"
BUILDABLE = FOLDER / "buildable"
KINDS = ("trt", "crt", "cdt")
# File name's end -> whose joint speeds are the limits, by group.
SPEEDS = {"": dict.fromkeys(RIDER_GROUPS, "trt"), "-fast": {"p1p2": "d1", "p1p3": "d2"}}
SAMPLES = 200  # people of each sex
LIMITS = {"hip swing": "hip_swing_min", "known moments": "extrapolated_max", "clearance": "clearance_min",
          "transmission angle": "transmission_angle_min", "hole distance": "hole_distance_min",
          "pin force": "pin_force_max"}  # fmt: skip


def power() -> Table:
    """What each design gives beside the best tricycle of its problem, and after plain bearings."""
    rows: list[tuple[Any, ...]] = []
    for group in RIDER_GROUPS:
        moments = load_moments(group)
        for end, speeds in SPEEDS.items():
            best = quasi_static(load_design(BUILDABLE / f"trt-{group}{end}.toml"), moments)
            printed = quasi_static(load_design(speeds[group]), moments)
            for name in (speeds[group], *(f"{kind}-{group}{end}" for kind in KINDS)):
                path = BUILDABLE / f"{name}.toml"
                turn = quasi_static(load_design(path if path.exists() else name), moments)
                lost = BearingLoss(JointForces(turn), PLAIN_BEARINGS).power
                ratio = turn.power_mean / best.power_mean, ratio_sd(turn, best)
                gain = turn.power_mean - printed.power_mean, difference_sd(turn, printed)
                rows.append((group.upper(), speeds[group].upper(), name, turn.power_mean, *ratio, *gain,
                             turn.power_mean - lost, ", ".join(Buildability.of(turn).broken()) or "none"))  # fmt: skip
    columns = {
        "moments": "",
        "joint speeds of": "",
        "design": "",
        "power, W": ".2f",
        "per the best TRT": ".2f",
        "± of that": ".2f",
        "gain over the first, W": "+.2f",
        "± of the gain, W": ".2f",
        "after plain bearings, W": ".2f",
        "limits it leaves": "",
    }
    note = (
        "Each search: mean joint speeds up to those of the printed design named, gear ratio up to 2.10, the limits of "
        "what can be built; differential evolution, 4 searches of 30,000 evaluations. With D1's and D2's knee speed a "
        "tricycle may have the hip speed of its own class (2 searches of 15,000). One leg."
    )
    return Table("Power", columns, rows, note)


def trial(group: str, name: str) -> tuple[Any, ...]:
    """A design simulated, sized, ridden, fitted: a row of `tried`."""
    design, moments = load_design(BUILDABLE / f"{name}.toml"), load_moments(group)
    case = Case(design, moments)
    try:
        sized = build(quasi_static(design, moments))
        mass, feet = sum(sized.mass.values()), 1e3 * sized.stack.feet
    except InputError:
        mass, feet = None, None
    verdicts = []
    for gear in ("freewheel", "fixed"):
        try:
            verdicts.append(RideCase(Ride(design, moments, transmission=gear)).summary()["verdict"])
        except InputError:  # more steps than there may be
            verdicts.append("not computed")
    fitted = fit_population(design, moments, samples=SAMPLES).summary()["share_fitted"]
    shares = (100 * fitted[who] for who in ("women", "men"))
    return name, case.simulation.power_mean, "yes" if case.agrees else "NO", mass, feet, *verdicts, *shares


def tried() -> Table:
    """Simulated, sized, ridden, fitted."""
    names = [(group, f"{kind}-{group}{end}") for group in RIDER_GROUPS for end in SPEEDS for kind in KINDS]
    rows = list(itertools.starmap(trial, track(names, "designs")))
    columns = {
        "design": "",
        "simulated, W": ".2f",
        "agrees": "",
        "links of a side, kg": ".2f",
        "between the feet, mm": ".0f",
        "with a freewheel": "",
        "with fixed gear": "",
        "women whom a seat suits, %": ".0f",
        "men, %": ".0f",
    }
    note = (
        "Sizes: aluminium plates for the forces of riding and 1,500 N on the pedal, factor 2 against yielding; a dash "
        "where nothing in stock bears them; `fes_mj draw` draws them. Rides: 60 s on the level from 5.71 km/h, moments "
        f"that do not depend on speed. Seats: {SAMPLES} of each sex, the seat moved as by `fes_mj fit`."
    )
    return Table("Simulated, sized, ridden, fitted", columns, rows, note)


def passed() -> Table:
    """Which limits the paper's designs and those found without them keep, under the moments that each was made for."""
    files = sorted(FOLDER.glob("*.toml"))
    names = [*DESIGNS, *map(str, files)]
    broken = {}
    for name in track(names, "limits"):
        group = RIDER_GROUPS[1] if Path(name).stem.startswith(("r2", "d2")) else RIDER_GROUPS[0]
        broken[name] = Buildability.of(quasi_static(load_design(name), load_moments(group))).broken()
    assert {*LIMITS.values()} == {field.name for field in fields(BuildLimits)}
    rows: list[tuple[Any, ...]] = []
    for limit in LIMITS:
        kept = ["no" if limit in broken[name] else "yes" for name in DESIGNS]
        rows.append((limit, *kept, sum(limit not in broken[str(path)] for path in files)))
    kept = ["no" if broken[name] else "yes" for name in DESIGNS]
    rows.append(("all", *kept, sum(not broken[str(path)] for path in files)))
    columns = {"limit": "", **{name.upper(): "" for name in DESIGNS}, f"of {len(files)} found designs": "d"}
    note = "Found designs: those that were found under the paper's limits alone; each is in [build](../build.md)."
    return Table("Limits that designs keep which were made without them", columns, rows, note)


def main() -> int:
    tables = [power(), tried(), passed()]
    rows = {table.title: table.records() for table in tables}
    write_text(FOLDER / "buildable.json", json_text({"provenance": provenance(), **rows}))
    write_text(FOLDER / "buildable.md", HEADING + "\n".join(table.markdown() for table in tables))
    return 0


HEADING = """# The best designs that can be built

Written by `python -m studies.buildable`.

"""


if __name__ == "__main__":
    sys.exit(main())
