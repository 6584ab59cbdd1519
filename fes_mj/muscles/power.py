"""Crank power of muscles that are stimulated at their best, for riders on one design or many."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.linkage import kinematics
from fes_mj.linkage.design import Design
from fes_mj.linkage.joints import PerJoint
from fes_mj.linkage.legs import all_legs
from fes_mj.muscles.pull import Pull, pull
from fes_mj.muscles.riders import Riders
from fes_mj.muscles.timing import DUTY, TURN_ANGLES, Windows, activation, best_windows

MEMBER_BLOCK = 64  # members of designs at once: more leave the processor's cache, fewer cost calls


@dataclass(frozen=True, eq=False)
class MuscleTurn:
    """A turn of every rider on every design; activation: shape (groups, members, designs, angles), over TURN_ANGLES."""

    pulled: Pull
    activation: FloatArray

    @cached_property
    def power(self) -> FloatArray:
        """Crank power of one leg, W, shape (members, designs, angles)."""
        return np.asarray(np.einsum("gmda,gmda->mda", self.activation, self.pulled.power))

    @cached_property
    def moment(self) -> PerJoint[FloatArray]:
        """Joint moments of the muscles, N m, positive in extension, shape (members, designs, angles)."""
        return self.pulled.moment.map(lambda moment: np.einsum("gmda,gmda->mda", self.activation, moment))

    def alone(self, member: int) -> "MuscleTurn":
        """That of one of the riders."""
        return MuscleTurn(self.pulled.alone(member), self.activation[:, [member]])

    @property
    def power_mean(self) -> FloatArray:
        """W, one leg, shape (members, designs)."""
        return np.asarray(self.power.mean(axis=-1))

    @property
    def group_power(self) -> FloatArray:
        """Mean power of each group, W, one leg, shape (groups, members, designs)."""
        return np.asarray(np.mean(self.activation * self.pulled.power, axis=-1))

    @property
    def two_legs(self) -> FloatArray:
        """Crank power of both legs, half a turn apart, W, shape (members, designs, angles)."""
        return all_legs(self.power)


def muscle_turn(riders: Riders, design: Design, cadence: Any, windows: Windows) -> MuscleTurn:
    """Of riders stimulated so on a design, or a batch; cadence: rad/s, scalar or (designs, 1)."""
    pulled = pull(riders, kinematics.solve(design, TURN_ANGLES), cadence)
    return MuscleTurn(pulled, activation(windows, riders, cadence))


def best_turn(
    riders: Riders, design: Design, cadence: Any = None, duty: float = DUTY, each_its_own: bool = False
) -> tuple[MuscleTurn, Windows]:
    """Of riders stimulated at their best (timing.best_windows), and the windows; cadence: by default the design's."""
    cadence = design.linkage.cadence if cadence is None else cadence
    pulled = pull(riders, kinematics.solve(design, TURN_ANGLES), cadence)
    windows, _ = best_windows(pulled.power, riders, cadence, duty, each_its_own)
    return MuscleTurn(pulled, activation(windows, riders, cadence)), windows


def best_power(riders: Riders, design: Design, duty: float = DUTY) -> FloatArray:
    """Expected mean power of one leg on each design of a batch at its cadence, stimulated at its best, W.

    Shape (designs,). NaN for a linkage that does not turn.
    """

    def power(block: Design) -> FloatArray:
        speed = block.linkage.cadence
        pulled = pull(riders, kinematics.solve(block, TURN_ANGLES), speed)
        return np.asarray(best_windows(pulled.power, riders, speed, duty)[1][0])

    size = max(1, MEMBER_BLOCK // len(riders))
    blocks = (design.taken(slice(start, start + size)) for start in range(0, design.size, size))
    with np.errstate(invalid="ignore"):
        return np.concatenate([power(block) for block in blocks])
