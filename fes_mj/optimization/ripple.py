"""How evenly a design rides: the ripple of the crank speed on a tricycle, for populations of designs."""

from dataclasses import dataclass, field

import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.linkage.assembly import SCAN
from fes_mj.linkage.batch import batch_size
from fes_mj.linkage.design import Design
from fes_mj.linkage.inertia import CrankInertia, crank_inertia
from fes_mj.linkage.kinematics import solve
from fes_mj.linkage.legs import all_legs
from fes_mj.moments.joint_moments import JointMoments
from fes_mj.moments.torque_map import torque_map
from fes_mj.riding.reduced import even_ripple
from fes_mj.riding.ride import Ride, Road
from fes_mj.statics.turn import virtual_work


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
        ride = Ride(design, self.moments, self.road, "fixed")
        ripple = even_ripple(ride, all_legs(drive), CrankInertia(*map(all_legs, crank_inertia(motion))))
        return np.broadcast_to(ripple, batch_size(design))
