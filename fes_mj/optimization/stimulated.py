"""Muscles in the place of joint moments: what a search maximises and limits of designs that stimulated muscles drive.

Power is not proportional to the gear ratio, as muscles that shorten faster pull less: it is a variable of its own.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

import numpy as np

from fes_mj.common.arrays import BoolArray, FloatArray
from fes_mj.linkage.design import Design
from fes_mj.linkage.design_file import load_design
from fes_mj.linkage.joints import PerJoint
from fes_mj.linkage.kinematics import solve
from fes_mj.muscles.anatomy import anatomy
from fes_mj.muscles.power import best_power, best_turn
from fes_mj.muscles.riders import Riders
from fes_mj.muscles.timing import DUTY, TURN_ANGLES, widths_up_to
from fes_mj.optimization.buildable import pin_force
from fes_mj.statics.cycles import Cycles

SEARCHED = 12  # members of an ensemble during a search


@dataclass(frozen=True, eq=False)
class MuscleDrive:
    """Riders stimulated at their best in expectation, no group for more than a share `duty` of the turn."""

    riders: Riders
    duty: float = DUTY

    proportional: ClassVar = False  # as of MomentDrive
    inside_limit: ClassVar = ("muscles", 0.0)

    def __post_init__(self) -> None:
        """Raises InputError for a duty that is none."""
        widths_up_to(self.duty)

    @cached_property
    def few(self) -> Riders:
        """SEARCHED who stand for all: the middles of as many equal parts of the ensemble, by power on the TRT."""
        turn, _ = best_turn(self.riders, load_design("trt"), duty=self.duty)
        order, count = np.argsort(turn.power_mean[:, 0]), min(SEARCHED, len(self.riders))
        return self.riders.taken(order[((np.arange(count) + 0.5) * len(order) / count).astype(int)])

    def power(self, designs: Design, turn: Cycles, turns_per_s: FloatArray, within: BoolArray) -> FloatArray:
        """As MomentDrive.power, expected of the few, shape (designs, 1); NaN of designs that are not `within`."""
        power = np.full((designs.size, 1), np.nan)
        if within.any():
            power[within, 0] = best_power(self.few, designs.taken(within), duty=self.duty)
        return power

    def worth(self, power: FloatArray) -> FloatArray:
        """What is maximised, W, shape (n,); power: shape (n, 1)."""
        return power[:, 0]

    def inside(self, turn: Cycles) -> PerJoint[FloatArray]:
        """How far each joint stays within the angles for which the lengths of muscles are known, deg, (designs,)."""
        muscles, offset = anatomy(), self.riders.values["hip_offset_deg"]
        shifts = {"knee": (0.0, 0.0), "hip": (float(offset.min()), float(offset.max()))}

        def margin(joint: str) -> FloatArray:
            (low, high), (least, most) = getattr(muscles, f"{joint}_deg"), shifts[joint]
            flexed, stretched = (180 - np.degrees(end) for end in (turn.joints[joint].low, turn.joints[joint].high))
            return np.asarray(np.minimum(stretched + least - low, high - (flexed + most)))

        return PerJoint.of(margin)

    def outside(self, turn: Cycles) -> FloatArray:
        """Share of the turn of which nothing is known, shape (designs,): none of what is inside."""
        return np.zeros(len(turn.turns))

    def pin_force(self, design: Design) -> float:
        """Largest on any pin while riding with masses, N, of a design that turns: by the few's expected moments."""
        turn, _ = best_turn(self.few, design, duty=self.duty)
        return pin_force(solve(design, TURN_ANGLES), turn.moment.map(lambda moment: moment[:, 0].mean(axis=0)))
