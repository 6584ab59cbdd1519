"""The torque map: joint moments over joint angle and direction, from moments over a tricycle's crank angle.

The map (paper, Section 4) answers: at which crank angle did the tricycle of the measurement have this joint at this
angle, moving in this direction? The moment measured there is the moment delivered here.
"""

import math
from collections.abc import Callable
from functools import cache, cached_property, lru_cache, partial
from typing import Any

import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.common.brief import Brief
from fes_mj.linkage.joints import PerJoint
from fes_mj.linkage.kinematics import Motion
from fes_mj.linkage.legs import Leg
from fes_mj.linkage.torque_source import LegControl
from fes_mj.moments.fourier import fourier
from fes_mj.moments.joint_moments import JointMoments
from fes_mj.moments.reference_tricycle import INVERSES

TABLE_SIZE = 3600  # moments are interpolated linearly on a uniform grid of 0.1 deg
GRID = np.arange(TABLE_SIZE + 2) * (2 * np.pi / TABLE_SIZE)  # from top dead centre; two more for rounding at the end


class TorqueMap(Brief):
    """Moment of the knee or the hip at a joint angle, in extension or flexion."""

    def __init__(self, moments: JointMoments) -> None:
        self.moments, self.reference = moments, moments.measured_on

    @property
    def brief(self) -> str:
        return self.moments.name

    def of(self, name: str) -> "TorqueMap":
        """The map of the leg that a name or its prefix (linkage.legs) belongs to: the left leg may have its own."""
        moments = self.moments.of_leg(name)
        return self if moments is self.moments else torque_map(moments)

    @cached_property
    def table(self) -> PerJoint[FloatArray]:
        """Moment at every crank angle of GRID, N m."""
        return self.moments.along(_grid_terms())

    def source_angle(self, joint: str, angle: Any, rate: Any) -> FloatArray:
        """Crank angle of the measurement, rad from top dead centre; see ReferenceTricycle.source_angle."""
        return self.reference.source_angle(joint, angle, rate)

    def moment(self, joint: str, angle: Any, rate: Any) -> FloatArray:
        """Moment in N m, any shape. angle: rad. rate: its sign alone, the direction, counts; zero is extension."""
        return self.at_source(joint, self.source_angle(joint, angle, rate))

    def along(self, motion: Motion, cadence: Any) -> PerJoint[FloatArray]:
        """Knee and hip moment along a motion at a crank speed in rad/s, of which only the size counts, N m."""
        angle, rate = motion.joint_angle, motion.joint_rate
        return PerJoint.of(lambda joint: self.moment(joint, angle[joint], np.abs(cadence) * rate[joint]))

    def at_source(self, joint: str, source: Any) -> FloatArray:
        """Moment in N m at crank angles of the measurement, rad from top dead centre, any shape."""
        table, position = self.table[joint], np.mod(source, 2 * np.pi) * (TABLE_SIZE / (2 * np.pi))
        index = np.nan_to_num(position).astype(np.int64)
        return np.asarray(table[index] + (position - index) * (table[index + 1] - table[index]))

    def feedback(self, joint: str) -> Callable[[float, float], float]:
        """The same map for plain floats, (angle, rate) -> moment; twenty times faster for one value at a time."""
        return partial(scalar_map(joint, _acos), self.reference.parameters(joint), self.table[joint].tolist())

    def control(self, leg: Leg, timestep: float = 0.0) -> LegControl:
        """The moments of a leg by its state alone (TorqueSource.control)."""
        torque = self.of(leg.prefix)
        knee_moment, hip_moment = torque.feedback("knee"), torque.feedback("hip")
        return LegControl(
            lambda _, knee, hip, knee_rate, hip_rate: (knee_moment(knee, knee_rate), hip_moment(hip, hip_rate))
        )


@cache
def _grid_terms() -> FloatArray:
    return fourier(GRID)


@lru_cache(maxsize=32)
def torque_map(moments: JointMoments) -> TorqueMap:
    """The map of these moments, built once."""
    return TorqueMap(moments)


def _acos(value: float) -> float:
    try:
        return math.acos(value)
    except ValueError:  # a rounding error beyond an end of the range
        return 0.0 if value > 0 else math.pi


def scalar_source(
    joint: str, acos: Callable[[float], float] = _acos, compiled: Callable[[Any], Any] = lambda function: function
) -> Callable[[Any, float, float], float]:
    """ReferenceTricycle.source_angle for plain floats: (its parameters, angle, rate) -> rad.

    acos: takes a rounding error beyond -1 or 1. compiled: what turns Python functions into machine code.
    """
    inverse = compiled(INVERSES[joint](math, acos))

    def source(where: Any, angle: float, rate: float) -> float:
        geometry, low, high = where
        if not low <= angle <= high:  # as ReferenceTricycle.around, and the nearer end
            angle -= 2 * math.pi * math.floor((angle - (low + high) / 2) / (2 * math.pi) + 0.5)
            angle = low if angle < low else high if angle > high else angle
        there: float = inverse(geometry, angle, 1.0 if rate >= 0 else -1.0)
        return there

    result: Callable[[Any, float, float], float] = compiled(source)
    return result


def scalar_map(
    joint: str, acos: Callable[[float], float], compiled: Callable[[Any], Any] = lambda function: function
) -> Callable[[Any, Any, float, float], float]:
    """The map for plain floats: (parameters, table, angle, rate) -> moment; the rest as for scalar_source."""
    source, scale = scalar_source(joint, acos, compiled), TABLE_SIZE / (2 * math.pi)

    def moment(where: Any, table: Any, angle: float, rate: float) -> float:
        position = source(where, angle, rate) * scale
        if position < 0:
            position += TABLE_SIZE
        index = int(position)
        value: float = table[index] + (position - index) * (table[index + 1] - table[index])
        return value

    result: Callable[[Any, Any, float, float], float] = compiled(moment)
    return result
