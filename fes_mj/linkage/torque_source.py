"""What gives a leg its joint moments, whatever it is: a torque map, or muscles."""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Protocol, Self, TypeAlias

from fes_mj.common.arrays import FloatArray
from fes_mj.linkage.joints import PerJoint
from fes_mj.linkage.kinematics import Motion
from fes_mj.linkage.legs import Leg

# Crank, knee and hip angle (rad), speeds of knee and hip (rad/s) -> moments of knee and hip, N m.
MomentsOfState: TypeAlias = Callable[[float, float, float, float, float], tuple[float, float]]


@dataclass(frozen=True, eq=False)
class LegControl:
    """What moves one leg, step by step.

    moments: asked once at the beginning of every step; it may remember the steps before. activation: of each muscle
    group, to which every step adds; it stays empty where there are no muscles.
    """

    moments: MomentsOfState
    activation: list[tuple[float, ...]] = field(default_factory=list)


class TorqueSource(Protocol):
    """Joint moments twice: of a whole turn at once, for statics, and from the state of every step, for a simulation."""

    def of(self, name: str) -> Self:
        """That of the leg that a name or its prefix (linkage.legs) belongs to."""
        ...

    def along(self, motion: Motion, cadence: float) -> PerJoint[FloatArray]:
        """Moments along a motion at a crank speed in rad/s, N m."""
        ...

    def control(self, leg: Leg, timestep: float) -> LegControl:
        """What moves a leg in steps of this time, s, from crank angle 0 on."""
        ...
