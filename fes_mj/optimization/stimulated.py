"""Muscles in the place of joint moments: what a search maximises and limits of designs that stimulated muscles drive.

Power is not proportional to the gear ratio, as muscles that shorten faster pull less: it is a variable of its own.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from fes_mj.common.arrays import ComplexArray, FloatArray
from fes_mj.linkage.design import Design
from fes_mj.linkage.design_file import load_design
from fes_mj.linkage.inertia import body_loads
from fes_mj.linkage.joints import JOINTS, PerJoint
from fes_mj.linkage.kinematics import solve
from fes_mj.muscles.anatomy import anatomy
from fes_mj.muscles.power import best_power, best_turn
from fes_mj.muscles.riders import Riders
from fes_mj.muscles.timing import ANGLES, DUTY, widths_up_to
from fes_mj.statics.cycles import Cycles
from fes_mj.statics.equilibrium import equilibrium

SEARCHED = 12  # members of an ensemble during a search


@dataclass(frozen=True, eq=False)
class MuscleDrive:
    """Riders stimulated at their best in expectation, no group for more than a share `duty` of the turn."""

    riders: Riders
    duty: float = DUTY

    def __post_init__(self) -> None:
        """Raises InputError for a duty that is none."""
        widths_up_to(self.duty)

    @cached_property
    def few(self) -> Riders:
        """SEARCHED who stand for all: the middles of as many equal parts of the ensemble, by power on the TRT."""
        turn, _ = best_turn(self.riders, load_design("trt"), duty=self.duty)
        order, count = np.argsort(turn.power_mean[:, 0]), min(SEARCHED, len(self.riders))
        return self.riders.taken(order[((np.arange(count) + 0.5) * len(order) / count).astype(int)])

    def power(self, designs: Design) -> FloatArray:
        """Mean crank power of one leg of each design, expected of the few, W, shape (designs,)."""
        return best_power(self.few, designs, duty=self.duty)

    def inside(self, turn: Cycles) -> PerJoint[FloatArray]:
        """How far each joint stays within the angles for which the lengths of muscles are known, deg, (designs,)."""
        known, offset = anatomy(), self.riders.values["hip_offset_deg"]
        shifts = {"knee": (0.0, 0.0), "hip": (float(offset.min()), float(offset.max()))}

        def margin(joint: str) -> FloatArray:
            (low, high), (least, most) = getattr(known, f"{joint}_deg"), shifts[joint]
            flexed, stretched = (180 - np.degrees(end) for end in (turn.joints[joint].low, turn.joints[joint].high))
            return np.asarray(np.minimum(stretched + least - low, high - (flexed + most)))

        return PerJoint.of(margin)

    def pin_force(self, design: Design) -> float:
        """Largest on any pin while riding with masses, N, of a design that turns: by the few's expected moments."""
        turn, _ = best_turn(self.few, design, duty=self.duty)
        moment = turn.moment.map(lambda moment: moment[:, 0].mean(axis=0))
        motion = solve(design, ANGLES)
        forces: dict[str, ComplexArray] = equilibrium(motion, moment, body_loads(motion, design.linkage.cadence))[1]
        return max(float(np.abs(force).max()) for joint, force in forces.items() if joint not in JOINTS)
