"""How evenly a design rides: the ripple of the crank speed on a tricycle, for populations of designs."""

from dataclasses import dataclass, field

import numpy as np

from fes_mj.arrays import FloatArray
from fes_mj.batch import batch_size
from fes_mj.design import TWO_LEGS, Design
from fes_mj.geometry import SCAN
from fes_mj.kinematics import solve
from fes_mj.moments import JointMoments
from fes_mj.reduced import even_ripple, masses
from fes_mj.ride import Ride, Road
from fes_mj.statics import virtual_work
from fes_mj.torque_map import torque_map


@dataclass(frozen=True)
class RippleLimit:
    """Largest ripple of the crank speed, (largest - smallest) / mean, that a design may have.

    Ridden with a fixed gear at the tricycle's speed, both legs driven by these moments; see reduced.steady_ripple.
    """

    limit: float
    moments: JointMoments
    road: Road = field(default_factory=Road)

    def ripple(self, design: Design) -> FloatArray:
        """Of a batch of designs that turn, shape (designs,); from 120 angles, within 1 % of what a fine table gives."""
        motion = solve(design, SCAN)
        drive = virtual_work(motion, torque_map(self.moments).along(motion, design.linkage.cadence))
        behind = [round(len(SCAN) * leg.lag / (2 * np.pi)) for leg in TWO_LEGS]
        of_leg = masses(motion)
        both = sum(np.roll(drive, rows, axis=-1) for rows in behind)
        legs = sum(np.roll(of_leg, rows, axis=-2) for rows in behind)
        ripple = even_ripple(Ride(design, self.moments, self.road, "fixed"), np.asarray(both), np.asarray(legs))
        return np.broadcast_to(ripple, batch_size(design))
