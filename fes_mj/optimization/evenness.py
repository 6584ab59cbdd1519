"""How evenly designs push and ride: the crank's energy over a turn, and the ripple of its speed on a tricycle."""

from dataclasses import dataclass

import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.linkage.assembly import SCAN
from fes_mj.linkage.design import Design
from fes_mj.linkage.inertia import CrankInertia, crank_inertia
from fes_mj.linkage.kinematics import FULL_TURN, Motion, solve
from fes_mj.linkage.legs import all_legs
from fes_mj.moments.joint_moments import JointMoments
from fes_mj.moments.torque_map import torque_map
from fes_mj.riding.ride import Ride, even_ripple
from fes_mj.statics.characteristics import energy_fluctuation
from fes_mj.statics.equilibrium import virtual_work


def fluctuation(design: Design, moments: JointMoments) -> FloatArray:
    """Coefficient of fluctuation of energy of two legs half a turn apart, for a batch, shape (designs,).

    Largest less smallest surplus of the work done over the mean, by the work of a turn: what a flywheel has to store.
    """
    return np.atleast_1d(energy_fluctuation(_both_legs(solve(design, FULL_TURN[::2]), moments)))


@dataclass(frozen=True)
class RippleLimit:
    """Largest ripple of the crank speed, (largest - smallest) / mean, that a design may have.

    Ridden with a fixed gear at the tricycle's speed, both legs driven by these moments; see ripple.steady_ripple.
    """

    limit: float
    moments: JointMoments

    def ripple(self, design: Design) -> FloatArray:
        """Of a batch of designs that turn, shape (designs,); from 120 angles, within 1 % of what a fine table gives."""
        motion = solve(design, SCAN)
        masses = CrankInertia(*map(all_legs, crank_inertia(motion)))
        ride = Ride(design, self.moments, transmission="fixed")
        return np.broadcast_to(even_ripple(ride, _both_legs(motion, self.moments), masses), design.size)


def _both_legs(motion: Motion, moments: JointMoments) -> FloatArray:
    """Moment on the crank by the joint moments of two legs half a turn apart, N m, shape (designs, angles)."""
    along = torque_map(moments).along(motion, motion.design.linkage.cadence)
    return np.asarray(all_legs(virtual_work(motion, along)))
