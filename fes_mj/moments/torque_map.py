"""The torque map: joint moments over joint angle and direction, from moments over a tricycle's crank angle.

The map (paper, Section 4) answers: at which crank angle did the tricycle of the measurement have this joint at this
angle, moving in this direction? The moment measured there is the moment delivered here.
"""

import math
from collections.abc import Callable
from functools import cached_property, lru_cache, partial
from typing import Any

import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.linkage.joints import PerJoint
from fes_mj.linkage.kinematics import Motion
from fes_mj.moments.joint_moments import JointMoments
from fes_mj.moments.reference_tricycle import INVERSES

TABLE_SIZE = 3600  # moments are interpolated linearly on a uniform grid of 0.1 deg
GRID = np.arange(TABLE_SIZE + 2) * (2 * np.pi / TABLE_SIZE)  # from top dead centre; two more for rounding at the end


class TorqueMap:
    """Moment of the knee or the hip at a joint angle, in extension or flexion."""

    def __init__(self, moments: JointMoments) -> None:
        self.moments, self.reference = moments, moments.measured_on

    def of(self, name: str) -> "TorqueMap":
        """The map of the leg that a name or its prefix (linkage.legs) belongs to: the left leg may have its own."""
        own = self.moments.of_leg(name)
        return self if own is self.moments else torque_map(own)

    @cached_property
    def table(self) -> PerJoint[FloatArray]:
        """Moment at every crank angle of GRID, N m."""
        return self.moments.at(GRID)

    @cached_property
    def reference_speed(self) -> PerJoint[FloatArray]:
        """Joint speed that the tricycle of the measurement had at every crank angle of GRID, rad/s."""
        return self.reference.joint_rates(GRID).map(lambda rate: self.reference.cadence * rate)

    def source_angle(self, joint: str, angle: Any, rate: Any) -> FloatArray:
        """Crank angle of the measurement, rad from top dead centre; see ReferenceTricycle.source_angle."""
        return self.reference.source_angle(joint, angle, rate)

    def moment(self, joint: str, angle: Any, rate: Any) -> FloatArray:
        """Moment in N m, any shape. angle: rad. rate: rad/s, zero is extension.

        Without a torque-velocity relation only the sign of the rate, the direction, counts.
        """
        source = self.source_angle(joint, angle, rate)
        moment = self.at_source(joint, source)
        return moment if self.moments.torque_velocity is None else moment * self.speed_factor(joint, source, rate)

    def along(self, motion: Motion, cadence: Any) -> PerJoint[FloatArray]:
        """Knee and hip moment along a motion at a crank speed in rad/s, of which only the size counts, N m."""
        angle, rate = motion.joint_angle, motion.joint_rate
        return PerJoint.of(lambda joint: self.moment(joint, angle[joint], np.abs(cadence) * rate[joint]))

    def at_source(self, joint: str, source: Any) -> FloatArray:
        """Moment in N m at crank angles of the measurement, rad from top dead centre, any shape; speed-free."""
        return _interpolated(self.table[joint], source)

    def speed_factor(self, joint: str, source: FloatArray, rate: Any) -> FloatArray:
        """Moment at this rate (rad/s) per moment at that of the measurement, at its crank angles `source` (rad).

        1 without a torque-velocity relation.
        """
        relation, sign = self.moments.torque_velocity, np.sign(self.at_source(joint, source))
        if relation is None:
            return np.ones_like(sign)
        then = _interpolated(self.reference_speed[joint], source)
        return np.asarray(relation.factor(joint, sign * rate) / relation.factor(joint, sign * then))

    def feedback(self, joint: str) -> Callable[[float, float], float]:
        """The same map for plain floats, (angle, rate) -> moment; twenty times faster for one value at a time."""
        lookup, relation = scalar_map(joint, _acos), self.moments.torque_velocity
        where = self.parameters(joint)
        mapped = partial(lookup, where, self.table[joint].tolist())
        if relation is None:
            return mapped
        then, factor = partial(lookup, where, self.reference_speed[joint].tolist()), relation.factor

        def moment(angle: float, rate: float) -> float:
            measured = mapped(angle, rate)
            sign = math.copysign(1.0, measured)
            return float(measured * factor(joint, sign * rate) / factor(joint, sign * then(angle, rate)))

        return moment

    def parameters(self, joint: str) -> tuple[tuple[float, ...], float, float]:
        """What scalar_map must know of the tricycle of the measurement."""
        return (self.reference.inverse_geometry[joint], *self.reference.ranges[joint])


@lru_cache(maxsize=32)
def torque_map(moments: JointMoments) -> TorqueMap:
    """The map of these moments, built once."""
    return TorqueMap(moments)


def scalar_map(
    joint: str, acos: Callable[[float], float], compiled: Callable[[Any], Any] = lambda function: function
) -> Callable[[Any, Any, float, float], float]:
    """The map for plain floats: (TorqueMap.parameters, table, angle, rate) -> moment.

    acos: takes a rounding error beyond -1 or 1. compiled: what turns Python functions into machine code.
    """
    source, scale = compiled(INVERSES[joint](math, acos)), TABLE_SIZE / (2 * math.pi)

    def moment(where: Any, table: Any, angle: float, rate: float) -> float:
        geometry, low, high = where
        if not low <= angle <= high:  # as ReferenceTricycle.around, and the nearer end
            angle -= 2 * math.pi * math.floor((angle - (low + high) / 2) / (2 * math.pi) + 0.5)
            angle = low if angle < low else high if angle > high else angle
        position = source(geometry, angle, 1.0 if rate >= 0 else -1.0) * scale
        if position < 0:
            position += TABLE_SIZE
        index = int(position)
        value: float = table[index] + (position - index) * (table[index + 1] - table[index])
        return value

    result: Callable[[Any, Any, float, float], float] = compiled(moment)
    return result


def _acos(value: float) -> float:
    try:
        return math.acos(value)
    except ValueError:  # a rounding error beyond an end of the range
        return 0.0 if value > 0 else math.pi


def _interpolated(table: FloatArray, source: Any) -> FloatArray:
    """Value of a table over GRID at crank angles of the measurement, rad from top dead centre."""
    position = np.mod(source, 2 * np.pi) * (TABLE_SIZE / (2 * np.pi))
    index = np.nan_to_num(position).astype(np.int64)
    return np.asarray(table[index] + (position - index) * (table[index + 1] - table[index]))
