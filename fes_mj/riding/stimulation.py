"""Where a muscle group's joint moment drives the crank: what the linkage alone says of stimulation, at any cadence.

A joint moment M does the work M dphi over a joint angle, so it drives the crank where the joint turns with it: the
kinematic effectiveness of Bellman et al. 2016 (doi:10.1109/TNSRE.2015.2500180). The hamstrings count as knee flexors.
What they do at the hip depends on the ratio of their two moment arms, which no net joint moment tells; `both_joints`
says over how much of their window the hip extends as well, so that their hip moment helps whatever that ratio is.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.common.brief import Brief
from fes_mj.linkage import kinematics
from fes_mj.linkage.design import Design
from fes_mj.linkage.joints import PerJoint
from fes_mj.linkage.legs import LEGS, TWO_LEGS, Leg
from fes_mj.linkage.turning import turning


class Muscle(NamedTuple):
    """A stimulated group: the joint it moves, and 1 if it extends it, -1 if it flexes it."""

    joint: str
    sense: int

    @property
    def moment(self) -> str:
        return f"{self.joint} {'extension' if self.sense > 0 else 'flexion'}"


MUSCLES = {"quadriceps": Muscle("knee", 1), "hamstrings": Muscle("knee", -1), "gluteus": Muscle("hip", 1)}
CORE = 0.5  # of the largest effect in a window: beyond it the joint moves fast enough to be worth fatigue
LEAST_SWING = 0.05  # of a muscle's swing over the turn; a window that holds less is not worth a pulse
WINDOW_POINTS = 3600  # of a turn; the zeros between them are interpolated
ZERO = "right crank arm points backwards (away from the rider's front); angles grow as the tricycle goes forward"


@dataclass(frozen=True, repr=False)
class Window(Brief):
    """One window of one muscle group of one leg. Angles in rad from ZERO, starts within a turn, ends after them.

    works: where its moment drives the crank. core: where by at least CORE of its largest effect there. swing: of the
    joint in the window, rad, which is work per moment. both_joints: where hamstrings help at the hip too, rad.
    """

    muscle: str
    leg: str
    works: tuple[float, float]
    core: tuple[float, float]
    swing: float
    both_joints: float | None

    @property
    def brief(self) -> str:
        on, off = (math.degrees(end) % 360 for end in self.works)
        return f"{self.leg} {self.muscle}: {on:.0f} to {off:.0f} deg"

    @property
    def width(self) -> float:
        return self.works[1] - self.works[0]

    @property
    def core_width(self) -> float:
        return self.core[1] - self.core[0]

    def of(self, leg: Leg) -> Window:
        """That of another leg."""
        turned = leg.lag - 2 * math.pi * ((self.works[0] + leg.lag) // (2 * math.pi))
        works, core = ((start + turned, end + turned) for start, end in (self.works, self.core))
        return replace(self, leg=leg.prefix.removesuffix("_"), works=works, core=core)

    def record(self, design: Design) -> dict[str, Any]:
        """Names and units of files: angles in deg within [0, 360), of ZERO and of the right leg's top dead centre."""
        return {
            "muscle": self.muscle,
            "moment": MUSCLES[self.muscle].moment,
            "leg": self.leg,
            "works_deg": _degrees(self.works),
            "works_from_tdc_deg": turning(design).degrees_from_top(np.array(self.works)).tolist(),
            "width_deg": math.degrees(self.width),
            "core_deg": _degrees(self.core),
            "core_from_tdc_deg": turning(design).degrees_from_top(np.array(self.core)).tolist(),
            "core_width_deg": math.degrees(self.core_width),
            "joint_swing_deg": math.degrees(self.swing),
            "both_joints_deg": None if self.both_joints is None else math.degrees(self.both_joints),
        }


def stimulation(design: Design, legs: int = 2) -> list[Window]:
    """Windows of every muscle group, of both legs or the right one alone; by muscle, leg, and crank angle.

    Windows that hold less than LEAST_SWING of the muscle's swing are left out. Raises AssemblyError for a linkage that
    does not close.

    >>> window = fes_mj.stimulation(fes_mj.load_design("d1"))[0]
    >>> window.muscle, window.leg, [round(math.degrees(angle)) for angle in window.works]
    ('quadriceps', 'right', [315, 444])
    """
    turning(design)
    angle = kinematics.uniform_turn(WINDOW_POINTS)
    rate = kinematics.solve(design, angle).joint_rate
    windows = []
    for name, muscle in MUSCLES.items():
        of_muscle = [_window(name, muscle, angle, rate, *ends) for ends in _positive(muscle.sense * rate[muscle.joint])]
        least = LEAST_SWING * sum(window.swing for window in of_muscle)
        worth = [window for window in of_muscle if window.swing >= least]
        windows += [window.of(leg) for leg in TWO_LEGS[: len(LEGS[legs])] for window in worth]
    return windows


def _window(
    name: str, muscle: Muscle, angle: FloatArray, rate: PerJoint[FloatArray], start: float, end: float
) -> Window:
    """The window of the right leg between two zeros of the joint's rate."""
    cell, effect = 2 * math.pi / WINDOW_POINTS, muscle.sense * rate[muscle.joint]
    inside = (angle - start) % (2 * np.pi) < end - start
    core = start + (angle[inside & (effect >= CORE * effect[inside].max())] - start) % (2 * np.pi)
    both = cell * float((inside & (rate["hip"] > 0)).sum()) if name == "hamstrings" else None
    return Window(
        muscle=name,
        leg="right",
        works=(start, end),
        core=(float(core.min()), float(core.max())),
        swing=cell * float(effect[inside].sum()),
        both_joints=both,
    )


def _positive(values: FloatArray) -> list[tuple[float, float]]:
    """Where a periodic function over a turn is positive: start within [0, 2 pi) and end, rad, in order."""
    cell, after = 2 * np.pi / len(values), np.roll(values, -1)
    rising, falling = (np.flatnonzero(change) for change in ((values <= 0) & (after > 0), (values > 0) & (after <= 0)))
    starts, ends = (cell * (at + values[at] / (values[at] - after[at])) for at in (rising, falling))
    return [(float(start), float(start + ((ends - start) % (2 * np.pi)).min())) for start in np.sort(starts)]


def _degrees(angles: Sequence[float] | FloatArray) -> list[float]:
    return [float(angle) for angle in np.degrees(angles) % 360]


def windows_summary(design: Design, windows: Sequence[Window]) -> dict[str, Any]:
    """The table as JSON names and units it."""
    return {
        "design": design.name,
        "crank_angle_zero": ZERO,
        "top_dead_centre_deg": math.degrees(turning(design).top_dead_centre),
        "core_share": CORE,
        "windows": [window.record(design) for window in windows],
    }


def table_csv(design: Design, windows: Sequence[Window]) -> str:
    """A row a window: pairs of angles as two columns, `..._on_deg` and `..._off_deg`."""
    rows = []
    for record in (window.record(design) for window in windows):
        row: dict[str, str] = {}
        for name, value in record.items():
            if isinstance(value, list):
                stem = name.removesuffix("_deg")
                row |= {f"{stem}_on_deg": f"{value[0]:.2f}", f"{stem}_off_deg": f"{value[1]:.2f}"}
            else:
                row[name] = "" if value is None else value if isinstance(value, str) else f"{value:.6g}"
        rows.append(row)
    return "\n".join([",".join(rows[0]), *(",".join(row.values()) for row in rows)]) + "\n"
