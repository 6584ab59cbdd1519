"""A turn of the massless model, of one leg or all: quasi-static crank moment, reactions, mean power, how sure it is."""

import math
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any

import numpy as np

from fes_mj.common.arrays import ComplexArray, FloatArray
from fes_mj.common.brief import Brief
from fes_mj.common.errors import InputError
from fes_mj.common.units import RPM, work_per_turn
from fes_mj.linkage import kinematics
from fes_mj.linkage.design import Design
from fes_mj.linkage.joints import PerJoint
from fes_mj.linkage.kinematics import Motion
from fes_mj.linkage.legs import LEGS, delayed
from fes_mj.linkage.turning import CRANK_ZERO, turning
from fes_mj.moments.joint_moments import JointMoments
from fes_mj.moments.torque_map import TorqueMap, torque_map
from fes_mj.moments.uncertainty import power_weights, standard_deviation
from fes_mj.statics.characteristics import motion_characteristics, power_characteristics
from fes_mj.statics.equilibrium import equilibrium
from fes_mj.statics.extrapolation import NO_MORE, Extrapolation, extrapolation
from fes_mj.statics.validity import valid_speed

# Of the trapezium rule over a turn, and up to which second derivative of a joint's angle by the crank's, 1/rad, these
# are enough. Its error comes from the moments' jumps where a joint turns round; it goes with this derivative and with
# the square of the step (docs/theory.md).
TURN_POINTS, BLUNT = 3600, 2.0
CURVE_POINTS = 360  # of which turn_points is a multiple: every degree is one of them


@dataclass(frozen=True, eq=False, repr=False)
class DrivenTurn(Brief):
    """One turn of the massless model, whatever drives it; arrays over crank angle, shape (n,).

    motion: over uniform crank angles of one turn. cadence: rad/s. joint_moment: N m, extension positive. crank_moment
    (N m, on the load) and reactions come from free-body equilibrium. A reaction is the complex force in N that the
    first body named by Architecture.joints exerts on the second, by point name.
    """

    motion: Motion
    cadence: float
    joint_moment: PerJoint[FloatArray]
    crank_moment: FloatArray
    reactions: dict[str, ComplexArray]

    @property
    def brief(self) -> str:
        return f"{self.design.name} {self.driver}: {self.power_mean:.2f} W at {self.cadence / RPM:.1f} rpm"

    @property
    def driver(self) -> str:
        """What moves the legs, in a few words."""
        raise NotImplementedError

    @property
    def power_sd(self) -> float | None:
        """Standard deviation of power_mean, W; None where nothing is known of the error."""
        raise NotImplementedError

    @property
    def notes(self) -> list[str]:
        """What a reader must know of the result."""
        raise NotImplementedError

    @property
    def design(self) -> Design:
        return self.motion.design

    @property
    def crank_angle(self) -> FloatArray:
        """Rad."""
        return self.motion.crank_angle

    @cached_property
    def joint_angle(self) -> PerJoint[FloatArray]:
        """Rad, growing in extension."""
        return self.motion.joint_angle

    @property
    def power(self) -> FloatArray:
        """Crank power of one leg, W, shape (n,)."""
        return self.crank_moment * self.cadence

    @property
    def power_mean(self) -> float:
        """Mean crank power of one leg over the turn, W (paper, Eq. 1)."""
        return float(self.power.mean())

    @property
    def work_per_turn(self) -> float:
        """Work of one leg on the crank in one turn, J, the same at any cadence."""
        return float(2 * np.pi * self.crank_moment.mean())

    @property
    def joint_range_deg(self) -> PerJoint[list[float]]:
        """Smallest and largest joint angle, deg."""
        return self.joint_angle.map(lambda angle: [float(np.degrees(f(angle))) for f in (np.min, np.max)])

    def summary(self) -> dict[str, Any]:
        """The keys that every turn has, as JSON names and units it."""
        return {
            "design": self.design.name,
            "cadence_rpm": self.cadence / RPM,
            "power_mean_W": self.power_mean,
            "work_per_turn_J": self.work_per_turn,
            "knee_range_deg": self.joint_range_deg.knee,
            "hip_range_deg": self.joint_range_deg.hip,
            **power_characteristics(self.power),
            **motion_characteristics(self.motion),
            "crank_angle_zero": CRANK_ZERO,
            "top_dead_centre_deg": float(np.degrees(turning(self.design).top_dead_centre)),
        }


@dataclass(frozen=True, eq=False, repr=False)
class QuasiStatic(DrivenTurn):
    """A turn that joint moments drive; torque: the map that gave them."""

    torque: TorqueMap

    @property
    def driver(self) -> str:
        return self.moments.name

    @property
    def moments(self) -> JointMoments:
        return self.torque.moments

    @cached_property
    def power_weights(self) -> FloatArray:
        """Mean power per Fourier coefficient of knee, then hip moment, W/(N m), shape (98,)."""
        return power_weights(self.motion, self.cadence, self.torque.reference)

    @property
    def power_sd(self) -> float | None:
        """Standard deviation of power_mean, W, by the error of recovered moments and where there are none.

        None for a user's own moments, of whose error nothing is known.
        """
        return difference_sd(self, self, 0.0)

    @cached_property
    def extrapolation(self) -> Extrapolation:
        """What of the turn has no data."""
        return extrapolation(self.motion, self.torque, self.joint_moment, self.cadence)

    @property
    def notes(self) -> list[str]:
        """What a reader must know of the result: joint angles for which the torque map has no data."""
        return [
            f"the {joint} moves {np.degrees(excess):.1f} deg beyond the range of the moments "
            f"({low:.1f} to {high:.1f} deg); the moment at its end is kept there"
            for joint, excess in self.extrapolation.excess.items()
            for low, high in [np.degrees(self.torque.reference.ranges[joint])]
            if excess > NO_MORE
        ]

    def summary(self) -> dict[str, Any]:
        """The keys that every result of a run has, as JSON names and units them."""
        return super().summary() | {
            "group": self.moments.name,
            "power_sd_W": self.power_sd,
            "extrapolation": self.extrapolation.verdict,
            "extrapolated_share": self.extrapolation.share,
            "extrapolated_work_share": self.extrapolation.work_share,
            "extrapolation_sd_W": self.extrapolation.sd,
            "notes": self.notes,
            "warnings": [misreading._asdict() for misreading in self.moments.misreadings],
        }


@lru_cache(maxsize=256)
def turn_points(design: Design) -> int:
    """Crank angles over which a turn is solved: TURN_POINTS, and more where a joint turns round more sharply."""
    motion = kinematics.solve(design, kinematics.uniform_turn(TURN_POINTS))
    sharpest = max(float(np.abs(rotation.second).max()) for rotation in motion.joint_rotation)
    needed = TURN_POINTS * math.sqrt(max(1.0, sharpest / BLUNT))
    return CURVE_POINTS * math.ceil(needed / CURVE_POINTS)


def quasi_static(
    design: Design, moments: JointMoments, cadence: float | None = None, points: int | None = None
) -> QuasiStatic:
    """Solve one turn of the massless, gravity-free model.

    cadence: crank speed in rad/s, by default the design's own (Eq. 16). points: crank angles from 0, uniform, by
    default turn_points. Raises InputError for a batch of designs, a cadence that is none, or joints that never enter
    the moments' range, AssemblyError if the linkage does not turn.

    >>> fes_mj.quasi_static(fes_mj.load_design("d1"), fes_mj.load_moments("p1p2"))
    <QuasiStatic d1 p1p2: 31.14 W at 96.4 rpm>
    """
    speed = valid_speed(design, moments, cadence)
    motion = kinematics.solve(design, kinematics.uniform_turn(turn_points(design) if points is None else points))
    torque = torque_map(moments)
    joint_moment = torque.along(motion, speed)
    return QuasiStatic(motion, speed, joint_moment, *equilibrium(motion, joint_moment), torque)


def difference_sd(one: QuasiStatic, other: QuasiStatic, factor: float = 1.0) -> float | None:
    """Standard deviation of one's mean power less `factor` times the other's, W; None where no error is known.

    Both must have been solved with the same moments (InputError otherwise).
    """
    covariance, theirs = one.moments.covariance, other.moments.covariance
    if covariance is None or theirs is None:
        return None
    if covariance is not theirs and not np.array_equal(covariance, theirs):
        raise InputError(f"{one.moments.name} and {other.moments.name} are different moments: nothing correlates them")
    by_moments = standard_deviation(one.power_weights - factor * other.power_weights, covariance)
    return math.hypot(by_moments, one.extrapolation.sd, factor * other.extrapolation.sd)


def ratio_sd(one: QuasiStatic, other: QuasiStatic) -> float | None:
    """Standard deviation of one's mean power per the other's, to first order; otherwise as difference_sd."""
    deviation = difference_sd(one, other, one.power_mean / other.power_mean)
    return None if deviation is None else deviation / abs(other.power_mean)


@dataclass(frozen=True, eq=False)
class LegTurns:
    """The turns of all legs on one crank.

    turns: of each leg with moments of its own, right first; one if all do the same. legs: how many there are.
    """

    turns: tuple[QuasiStatic, ...]
    legs: int

    @classmethod
    def solve(
        cls, design: Design, moments: JointMoments, cadence: float, legs: int = 1, points: int | None = None
    ) -> "LegTurns":
        """Solve so many legs at a cadence in rad/s. Raises InputError as quasi_static."""
        of_legs = moments.of_legs[:legs]
        return cls(tuple(quasi_static(design, leg, cadence, points) for leg in of_legs), legs)

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
        of_legs = self.turns * (self.legs // len(self.turns))
        shifted = [delayed(turn.power, leg.lag) for turn, leg in zip(of_legs, LEGS[self.legs], strict=True)]
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
            "work_per_turn_J": work_per_turn(self.power_mean, self.first.cadence),
            **power_characteristics(self.power),
        }


def _of_mean(deviations: list[float | None]) -> float | None:
    """Standard deviation of a mean of independent numbers; None where one is not known."""
    known = [deviation for deviation in deviations if deviation is not None]
    return math.hypot(*known) / len(known) if len(known) == len(deviations) else None
