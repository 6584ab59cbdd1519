"""Write results/stimulation.md: when to stimulate on the five designs, and where their linkages let moments drive.

python -m studies.stimulation
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

from fes_mj.common.markdown import Table
from fes_mj.common.units import RPM
from fes_mj.common.writing import write_text
from fes_mj.linkage.design_file import DESIGNS, load_design
from fes_mj.moments.joint_moments import RIDER_GROUPS
from fes_mj.muscles.riders import load_riders
from fes_mj.muscles.setting import MISTIMED, Setting
from fes_mj.riding.stimulation import CORE, LEAST_SWING, stimulation

PATH = Path(__file__).parents[1] / "results" / "stimulation.md"


def settings() -> Iterator[Setting]:
    """Best stimulation of both rider groups on every design, at the paper's gears."""
    for group in RIDER_GROUPS:
        for name in DESIGNS:
            design = load_design(name)
            yield Setting.best(design, load_riders(group), design.linkage.cadence)


def best_rows(setting: Setting) -> Iterator[tuple[Any, ...]]:
    for record in setting.records():
        if record["leg"] == "right":
            ends = (record["on_deg"], record["off_deg"], record["power_W"], record["power_sd_W"])
            cost = (record["stimulation_effort"], record["power_per_effort_W"])
            lost = (record["early_loss_W"], record["late_loss_W"])
            yield setting.riders.name, setting.design.name.upper(), record["muscle"], *ends, *cost, *lost


def total_row(setting: Setting) -> tuple[Any, ...]:
    content = setting.summary()
    cost = (content["stimulation_effort"], content["power_per_effort_W"])
    lost = (100 * content[f"{when}_loss_share"] for when in ("early", "late"))
    power = (setting.cadence / RPM, content["power_mean_W"], content["power_sd_W"])
    return setting.riders.name, setting.design.name.upper(), *power, *cost, *lost


def linkage_rows(name: str) -> Iterator[tuple[Any, ...]]:
    design = load_design(name)
    for record in (window.record(design) for window in stimulation(design) if window.leg == "right"):
        angles = (*record["works_deg"], record["width_deg"], record["core_width_deg"], record["joint_swing_deg"])
        yield name.upper(), record["muscle"], record["moment"], *angles, record["both_joints_deg"]


def main() -> None:
    solved = [*settings()]
    tables = (
        Table("Best windows", BEST, [row for setting in solved for row in best_rows(setting)]),
        Table("What a leg gives and costs", TOTALS, [total_row(setting) for setting in solved]),
        Table("Where the linkage lets moments drive", LINKAGE, [row for name in DESIGNS for row in linkage_rows(name)]),
    )
    write_text(PATH, "\n".join((HEADING, *(table._replace(note=NOTES[table.title]).markdown() for table in tables))))


HEADING = """# Stimulation windows

Written by `python -m studies.stimulation`. Right leg; angles in deg from the crank arm pointing backwards; at the
cadence at which the tricycle does 5.71 km/h.
"""
NOTES = {
    "Best windows": f"""\
`fes_mj stimulation DESIGN`: of one leg, +- over the riders who may have been measured; `early` and `late` are what
{MISTIMED:g} deg cost. Effort: share of the turn x strength x largest force, per that of the measurement.""",
    "What a leg gives and costs": "All groups together.",
    "Where the linkage lets moments drive": f"""\
`fes_mj stimulation DESIGN --drive moments`. *Core*: the part of a window in which the joint moves at least {CORE:g}
times as fast per crank angle as at best there. Windows with less than {100 * LEAST_SWING:g} % of the joint's swing are
left out. *Both*: in how much of the hamstrings' window the hip extends as well.""",
}
_WHOSE = {"group": "", "design": ""}
_COST = {"effort": ".2f", "W per effort": ".1f"}
BEST = _WHOSE | {"muscle": "", "on": ".0f", "off": ".0f", "power, W": ".1f", "+-": ".1f"} | _COST
BEST |= {"early, W": ".1f", "late, W": ".1f"}
TOTALS = _WHOSE | {"cadence, rpm": ".1f", "power, W": ".1f", "+-": ".1f"} | _COST
TOTALS |= {"early costs, %": ".0f", "late costs, %": ".0f"}
LINKAGE = {
    "design": "",
    "muscle": "",
    "moment": "",
    "from": ".0f",
    "to": ".0f",
    "width": ".0f",
    "core": ".0f",
    "joint swing": ".1f",
    "both": ".0f",
}


if __name__ == "__main__":
    main()
