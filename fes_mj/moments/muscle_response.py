"""What the muscles of a ride make of their commands, a number at a time: the steps that both solvers of a ride take."""

import math
from typing import Any, NamedTuple

from fes_mj.common.machine_code import machine_code
from fes_mj.linkage.joints import JOINTS
from fes_mj.linkage.legs import TWO_LEGS
from fes_mj.moments.joint_moments import JointMoments
from fes_mj.moments.torque_velocity import AT_ANY_SPEED, hill_factor

MUSCLES = tuple((leg, joint) for leg in TWO_LEGS for joint in JOINTS)  # one for each joint
TURN = 2 * math.pi
_hill = machine_code(hill_factor)


class Response(NamedTuple):
    """How they answer. lag: time constant, s. cadence: crank speed at which the moments were measured, rad/s.

    curvature, eccentric_plateau: of Hill's relation. max_speed: by MUSCLES, rad/s.
    """

    lag: float
    cadence: float
    curvature: float
    eccentric_plateau: float
    max_speed: tuple[float, ...]

    @classmethod
    def of(cls, moments: JointMoments, lag: float) -> "Response":
        """Those that deliver these moments, with a lag in s."""
        hill = moments.torque_velocity or AT_ANY_SPEED
        speeds = tuple(float(hill.max_speed[joint]) for _, joint in MUSCLES)
        return cls(float(lag), float(moments.measured_on.cadence), hill.curvature, hill.eccentric_plateau, speeds)


@machine_code
def lead(response: Response, crank_speed: float) -> float:
    """How far ahead of its crank angle a command is given at a crank speed (rad/s), rad.

    What the first harmonic lags at this speed, less what the command itself makes good: its lag in the measurement.
    """
    return math.atan(crank_speed * response.lag) - math.atan(response.cadence * response.lag)


@machine_code
def place(angle: float, count: int) -> tuple[int, float]:
    """Where a crank angle (rad) lies in a curve of so many cells over a turn: cell, and part of it."""
    position = (angle % TURN) * (count / TURN)
    row = min(int(position), count - 1)  # a turn less a rounding error
    return row, position - row


@machine_code
def between(curve: Any, row: int, part: float) -> float:
    """Value of a curve in a cell, between its two ends."""
    value: float = curve[row] + part * (curve[row + 1] - curve[row])
    return value


@machine_code
def delivered(response: Response, muscle: int, moment: float, rate: float) -> float:
    """Moment of a muscle whose moment at rest is `moment` (N m), at a joint speed in rad/s."""
    shortening = (rate if moment > 0 else -rate) / response.max_speed[muscle]
    return moment * float(_hill(response.curvature, response.eccentric_plateau, shortening))
