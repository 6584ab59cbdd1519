"""Forces on pedal, knee and pins over a turn, without and with the masses, and what those of the knee say of bones."""

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from fes_mj.common.arrays import ComplexArray
from fes_mj.linkage.inertia import GRAVITY, body_loads
from fes_mj.linkage.riders import leg_mass_after_injury
from fes_mj.statics.equilibrium import equilibrium
from fes_mj.statics.turn import DrivenTurn

# Stimulating the quadriceps of paralysed, seated legs: largest load on the distal femur, body weights (PMC3324830).
STIMULATED_SHEAR, STIMULATED_COMPRESSION = 2.15, 1.39
NET_FORCE = (
    "Net joint forces: the pull of the muscles themselves, which presses the bones together, is not in them and comes "
    f"on top. For scale: stimulating the quadriceps of seated legs loaded the distal femur with {STIMULATED_SHEAR} "
    f"body weights of shear and {STIMULATED_COMPRESSION} of compression (PMC3324830); paralysed legs have thin bones."
)


class KneeLoad(NamedTuple):
    """Net force of the shank on the femur, largest over the turn, in body weights: across it, and pressing along it."""

    shear: float
    compression: float


@dataclass(frozen=True)
class JointForces:
    """Joint forces of a turn, as QuasiStatic.reactions: of the moments alone, and with weight and inertia as well."""

    static: DrivenTurn

    @cached_property
    def with_masses(self) -> dict[str, ComplexArray]:
        """At constant crank speed, N."""
        return self._with_leg_mass(self.static.design.rider.leg_mass_factor)

    def _with_leg_mass(self, factor: float) -> dict[str, ComplexArray]:
        static = self.static
        motion = replace(static.motion, design=static.design.with_rider(leg_mass_factor=factor))
        return equilibrium(motion, static.joint_moment, body_loads(motion, static.cadence))[1]

    @property
    def leg_mass_sd(self) -> dict[str, float] | None:
        """Standard deviation of the peaks with masses by that of the legs' after an injury, N; None for full legs."""
        factor, (_, deviation) = self.static.design.rider.leg_mass_factor, leg_mass_after_injury()
        if factor == 1:
            return None
        more, less = (peaks(self._with_leg_mass(factor + sign * deviation)) for sign in (1, -1))
        return {joint: abs(more[joint] - less[joint]) / 2 for joint in more}

    def knee(self, forces: dict[str, ComplexArray]) -> KneeLoad:
        """What one of the two dictionaries of forces means for the knee."""
        along = forces["knee"] * np.conj(self.static.motion.direction("thigh"))  # on the shank; compression is positive
        weight = self.static.design.rider.mass * GRAVITY
        return KneeLoad(float(np.abs(along.imag).max()) / weight, max(0.0, float(along.real.max())) / weight)

    def summary(self) -> dict[str, Any]:
        """The result as JSON names and units it."""
        massless, massive = self.static.reactions, self.with_masses
        return {
            "peak_force_N": peaks(massless),
            "peak_force_with_masses_N": peaks(massive),
            "peak_force_leg_mass_sd_N": self.leg_mass_sd,
            "knee_load_bodyweight": self.knee(massless)._asdict(),
            "knee_load_with_masses_bodyweight": self.knee(massive)._asdict(),
            "knee_load_note": NET_FORCE,
        }


def peaks(forces: dict[str, ComplexArray]) -> dict[str, float]:
    """Largest size of forces over the turn, N, by joint."""
    return {joint: float(np.abs(force).max()) for joint, force in forces.items()}
