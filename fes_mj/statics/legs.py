"""The quasi-static turns of all legs on one crank: the same for each, or each under moments of its own."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.linkage.design import Design
from fes_mj.linkage.legs import LEGS, delayed
from fes_mj.moments.joint_moments import JointMoments
from fes_mj.statics.characteristics import power_characteristics
from fes_mj.statics.turn import TURN_POINTS, QuasiStatic, difference_sd, quasi_static


@dataclass(frozen=True, eq=False)
class LegTurns:
    """turns: of each leg with moments of its own, right first; one if all do the same. legs: how many there are."""

    turns: tuple[QuasiStatic, ...]
    legs: int

    @classmethod
    def solve(
        cls, design: Design, moments: JointMoments, cadence: float, legs: int = 1, points: int = TURN_POINTS
    ) -> "LegTurns":
        """Solve so many legs at a cadence in rad/s. Raises InputError as quasi_static."""
        own = [moments] if legs == 1 or moments.left is None else [moments, moments.left]
        return cls(tuple(quasi_static(design, leg, cadence, points) for leg in own), legs)

    @property
    def first(self) -> QuasiStatic:
        return self.turns[0]

    @property
    def power_mean(self) -> float:
        """Mean crank power of one leg, on average of the legs, W."""
        return float(np.mean([turn.power_mean for turn in self.turns]))

    @property
    def power_sd(self) -> float | None:
        """Its standard deviation, W: the errors of two files of moments are independent. None where it is not known."""
        return _of_mean([turn.power_sd for turn in self.turns])

    @property
    def power(self) -> FloatArray:
        """Crank power of all legs over the right crank's angle, W, shape (n,)."""
        each = self.turns * (self.legs // len(self.turns))
        shifted = [delayed(turn.power, leg.lag) for turn, leg in zip(each, LEGS[self.legs], strict=True)]
        return np.asarray(np.sum(shifted, axis=0))

    def ratio(self, other: "LegTurns") -> tuple[float, float | None]:
        """Mean power per another design's with the same moments, and its standard deviation; NaN per a power of 0."""
        if self is other:
            return 1.0, 0.0
        ratio = self.power_mean / other.power_mean if other.power_mean else math.nan
        pairs = zip(self.turns, other.turns, strict=True)
        deviation = _of_mean([difference_sd(mine, theirs, ratio) for mine, theirs in pairs])
        return ratio, None if deviation is None or not other.power_mean else deviation / abs(other.power_mean)

    def summary(self) -> dict[str, Any]:
        """As QuasiStatic.summary; power and work are one leg's, evenness is that of all legs together."""
        return self.first.summary() | {
            "legs": self.legs,
            "power_mean_W": self.power_mean,
            "power_sd_W": self.power_sd,
            "work_per_turn_J": 2 * math.pi * self.power_mean / self.first.cadence,
            **power_characteristics(self.power),
        }


def _of_mean(deviations: list[float | None]) -> float | None:
    """Standard deviation of a mean of independent numbers; None where one is not known."""
    known = [deviation for deviation in deviations if deviation is not None]
    return math.hypot(*known) / len(known) if len(known) == len(deviations) else None
