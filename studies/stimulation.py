"""Write results/stimulation.md: the windows of the five designs, and how wide they are beside those in use.

python -m studies.stimulation
"""

from __future__ import annotations

import math
from pathlib import Path

from fes_mj.common.markdown import Table
from fes_mj.common.units import RPM
from fes_mj.common.writing import write_text
from fes_mj.linkage.design_file import DESIGNS, load_design
from fes_mj.riding.stimulation import CORE, LEAST_SHARE, stimulation

PATH = Path(__file__).parents[1] / "results" / "stimulation.md"
LAGS = (0.06, 0.15)  # s, the span of what cycles in use advance by


def main() -> None:
    rows, leads = [], []
    for name in DESIGNS:
        design = load_design(name)
        cadence = design.linkage.cadence
        for window in stimulation(design, [cadence]):
            if window.leg == "right":
                record = window.record(design)
                both = record["both_joints_deg"]
                angles = (
                    *record["works_deg"],
                    record["width_deg"],
                    record["core_width_deg"],
                    record["joint_swing_deg"],
                )
                rows.append((name.upper(), window.muscle, record["moment"], *angles, both))
        leads.append((name.upper(), cadence / RPM, *(math.degrees(cadence * lag) for lag in LAGS)))
    write_text(
        PATH,
        "\n".join(
            (
                HEADING,
                Table("", COLUMNS, rows).markdown(),
                Table("What the crank turns in the lag", LEADS, leads).markdown(),
            )
        ),
    )


HEADING = f"""# Stimulation windows

Written by `python -m studies.stimulation`. Right leg, no lag; angles in deg from the crank arm pointing
backwards. *Core*: the part of a window in which the joint moves at least {CORE:g} times as fast per crank angle as at
best there. Windows with less than {100 * LEAST_SHARE:g} % of the joint's swing are left out. *Both*: in how much of the
hamstrings' window the hip extends as well.
"""
COLUMNS = {
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
LEADS = {"design": "", "cadence, rpm": ".1f", **{f"lead of {lag:g} s, deg": ".0f" for lag in LAGS}}


if __name__ == "__main__":
    main()
