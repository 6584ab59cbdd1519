"""Which designs can be built, and what bearings and real links make of them; write results/build.*.

    python -m studies.build

The paper's designs and every found one in results/optimization and its folder buildable.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

from fes_mj.common.console import track
from fes_mj.common.errors import InputError
from fes_mj.common.markdown import Table
from fes_mj.common.provenance import provenance
from fes_mj.common.writing import json_text, write_text
from fes_mj.crosscheck.turn_case import Case
from fes_mj.linkage.design import Design
from fes_mj.linkage.design_file import DESIGNS, load_design
from fes_mj.moments.files import load_moments
from fes_mj.moments.joint_moments import RIDER_GROUPS
from fes_mj.optimization.buildable import PLAIN_BEARINGS, Buildability
from fes_mj.statics.characteristics import energy_swing
from fes_mj.statics.friction import BearingLoss
from fes_mj.statics.joint_forces import JointForces
from fes_mj.statics.sizes import build
from fes_mj.statics.turn import QuasiStatic, quasi_static

RESULTS = Path(__file__).parents[1] / "results"
ROLLING = PLAIN_BEARINGS._replace(friction=0.002)
POINTS = 720


def designs() -> list[Design]:
    """The paper's, and all that searches found."""
    folders = (RESULTS / "optimization", RESULTS / "optimization" / "buildable")
    return [
        *map(load_design, DESIGNS),
        *(load_design(path) for place in folders for path in sorted(place.glob("*.toml"))),
    ]


def ranking(turns: list[QuasiStatic]) -> Table:
    """By power after plain bearings."""
    rows = []
    for turn in turns:
        forces = JointForces(turn)
        plain, rolling = (BearingLoss(forces, bearings).power for bearings in (PLAIN_BEARINGS, ROLLING))
        power = turn.power_mean
        rows.append((turn.design.name, power, plain, 100 * plain / power, power - plain, 100 * rolling / power))
    columns = {
        "design": "",
        "power, W": ".2f",
        "lost in plain bearings, W": ".2f",
        "the same, %": ".1f",
        "left, W": ".2f",
        "lost in rolling ones, %": ".2f",
    }
    note = (
        f"Plain: coefficient of friction {PLAIN_BEARINGS.friction:g}, pins of {1e3 * PLAIN_BEARINGS.radius:g} mm "
        f"radius; rolling: {ROLLING.friction:g}. One leg, forces with masses, hip and knee left out; the first has "
        "most left."
    )
    return Table("Power after the bearings", columns, sorted(rows, key=lambda row: -row[4]), note)


def limits(turns: list[QuasiStatic]) -> Table:
    """What each design leaves of the limits of what can be built, and whether it can be sized."""
    rows: list[tuple[Any, ...]] = []
    for turn in track(turns, "designs"):
        can = Buildability.of(turn)
        try:
            mass = sum(build(turn).mass.values())
        except InputError:
            mass = None
        rows.append(
            (
                turn.design.name,
                can.transmission_angle_min_deg,
                1e3 * can.hole_distance_min_m,
                can.pin_force_max_N,
                can.hip_swing_deg,
                100 * can.extrapolated_share,
                None if can.clearance_min_m is None else 1e3 * can.clearance_min_m,
                mass,
                ", ".join(can.broken()) or "none",
            )
        )
    columns = {
        "design": "",
        "transmission angle, deg": ".0f",
        "holes apart, mm": ".4g",
        "pin force, N": ".0f",
        "hip swing, deg": ".1f",
        "outside the moments, %": ".1f",
        "clearance, mm": ".0f",
        "mass of the links of a side, kg": ".2f",
        "limits it leaves": "",
    }
    note = (
        "Limits: 30 deg, 25 mm, 1,500 N riding with masses, 5 deg, 0 %, 5 mm. No mass: nothing in stock bears 1,500 N "
        "on the pedal (aluminium plates, factor 2 against yielding), or holes run into each other."
    )
    return Table("What can be built", columns, rows, note)


def real_links(turns: list[QuasiStatic]) -> Table:
    """What the masses of sized links change in the simulation."""
    rows = []
    for turn in track(turns, "real links"):
        try:
            sized = build(turn)
        except InputError:
            continue
        cases = [Case(design, turn.moments) for design in (turn.design, sized.design)]
        for case, kind in zip(cases, ("bars of 1 kg/m", sized.material.name), strict=True):
            run = case.simulation
            swing = float(energy_swing(run.power, run.cadence))
            rows.append((turn.design.name, kind, run.power_mean, float(run.power.max() - run.power.min()), swing,
                         max(case.joint_forces.summary()["peak_force_with_masses_N"].values()),
                         "yes" if case.agrees else "NO"))  # fmt: skip
    columns = {
        "design": "",
        "links": "",
        "mean power, W": ".3f",
        "power peak to peak, W": ".0f",
        "energy swing, J": ".2f",
        "largest joint force, N": ".0f",
        "agrees with statics": "",
    }
    return Table(
        "Real links in the simulation", columns, rows, "The mean stays: masses return over a turn what they took."
    )


def main() -> int:
    rows: dict[str, Any] = {"provenance": provenance()}
    pages = ["# What can be built\n\nWritten by `python -m studies.build`.\n"]
    for group in RIDER_GROUPS:
        moments = load_moments(group)
        turns = [quasi_static(design, moments, points=POINTS) for design in designs()]
        tables = [ranking(turns), limits(turns), real_links(turns[: len(DESIGNS)])]
        rows[group] = {table.title: table.records() for table in tables}
        pages += [f"# Under the moments of {group.upper()}\n", *(table.markdown() for table in tables)]
    write_text(RESULTS / "build.json", json_text(rows))
    write_text(RESULTS / "build.md", "\n".join(pages))
    return 0


if __name__ == "__main__":
    sys.exit(main())
