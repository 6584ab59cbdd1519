"""Settings of a stimulator for one design and seat, by cadence: as JSON and as a table.

Windows are those of the stimulation itself, before delay and activation, to be set as they are.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from fes_mj.linkage.design import Design
from fes_mj.linkage.turning import CRANK_ZERO, turning
from fes_mj.muscles.prior import ramp
from fes_mj.muscles.riders import Riders
from fes_mj.muscles.rules import BEST
from fes_mj.muscles.setting import MISTIMED, Setting
from fes_mj.muscles.timing import DUTY


@dataclass(frozen=True, eq=False)
class Settings:
    """Of one design and seat, by cadence; main: number of the cadence that is shown in full."""

    by_cadence: tuple[Setting, ...]
    main: Setting

    @classmethod
    def solve(
        cls, design: Design, riders: Riders, cadences: Sequence[float], main: float, duty: float = DUTY, legs: int = 2
    ) -> "Settings":
        """cadences: rad/s, of which `main` is one. legs: as of Setting. Raises as rules.stimulated."""
        by_cadence = {cadence: Setting.best(design, riders, cadence, duty, legs) for cadence in sorted(cadences)}
        return cls(tuple(by_cadence.values()), by_cadence[main])

    @property
    def seat(self) -> dict[str, Any]:
        """For whom and where the settings hold: another seat or rider needs others."""
        design, motion = self.main.design, self.main.stimulated.motion
        bent = {joint: np.degrees(np.pi - motion.joint_angle[joint]) for joint in ("knee", "hip")}
        return {
            "seat_angle_deg": math.degrees(design.linkage.seat_angle),
            "hip_to_crank_centre_m": abs(design.linkage.crank_centre),
            "crank_m": design.linkage.crank,
            "thigh_m": design.rider.thigh,
            "shank_m": design.rider.shank,
            **{f"{joint}_flexion_deg": [float(angle.min()), float(angle.max())] for joint, angle in bent.items()},
        }

    def summary(self) -> dict[str, Any]:
        """As JSON names and units it; the numbers of the main cadence beside `settings` of all."""
        main = self.main
        return {
            "design": main.design.name,
            "drive": "muscles",
            "timing": BEST,
            "group": main.riders.name,
            "legs": main.legs,
            "seat": self.seat,
            "crank_angle_zero": CRANK_ZERO,
            "top_dead_centre_deg": math.degrees(turning(main.design).top_dead_centre),
            "ramp_s": ramp(),
            "duty_limit": main.duty,
            "mistimed_deg": MISTIMED,
            **main.summary(),
            "settings": [setting.summary() for setting in self.by_cadence],
            "notes": main.stimulated.notes,
            "windows": [record for setting in self.by_cadence for record in setting.records()],
        }

    def table_csv(self) -> str:
        """The windows, a row for each cadence, group and leg."""
        rows = [record for setting in self.by_cadence for record in setting.records()]
        cells = [[_cell(value) for value in row.values()] for row in rows]
        return "\n".join([",".join(rows[0]), *map(",".join, cells)]) + "\n"


def _cell(value: Any) -> str:
    return "" if value is None else value if isinstance(value, str) else f"{value:.6g}"
