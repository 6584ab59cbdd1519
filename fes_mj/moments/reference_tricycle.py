"""The tricycle that joint moments were measured on: which crank angle had this joint at this angle, moving this way?

A traditional tricycle is a four-bar of frame, crank, shank and thigh, so the question has a closed-form answer for
knee and hip, and the torque map needs no table over joint angle.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from types import ModuleType
from typing import Any, TypeAlias

import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.linkage import kinematics
from fes_mj.linkage.design import Design, Linkage, Rider
from fes_mj.linkage.joints import PerJoint

# Geometry of a joint's inverse, joint angle, direction (1 extension, -1 flexion) -> crank angle, rad.
Inverse: TypeAlias = Callable[[Any, Any, Any], Any]


@dataclass(frozen=True)
class ReferenceTricycle:
    """A traditional tricycle with its rider, and the cadence (rad/s) at which the moments were measured."""

    design: Design
    cadence: float

    @cached_property
    def top_dead_centre(self) -> float:
        """Crank angle of the most bent leg, rad: the crank points from its centre to the hip."""
        return float(np.angle(-self.design.linkage.crank_centre))

    @cached_property
    def ranges(self) -> PerJoint[tuple[float, float]]:
        """Smallest and largest joint angle, rad: beyond them there are no moments.

        The knee turns round where the crank lies in line with hip and crank centre, the hip where with the shank.
        """
        crank, thigh, shank, frame, frame_angle = self._lengths
        at_hip = frame_angle % (2 * math.pi) - self.design.linkage.seat_angle
        boot = float(self.design.boot_angle)
        bent, straight = (_opposite(frame + sign * crank, thigh, shank) - boot for sign in (-1, 1))
        back, forth = (at_hip - _opposite(shank + sign * crank, thigh, frame) for sign in (1, -1))
        return PerJoint((bent, straight), (back, forth))

    @cached_property
    def inverse_geometry(self) -> PerJoint[tuple[float, ...]]:
        """What the inverse of each joint must know of the four-bar; see INVERSES."""
        crank, thigh, shank, frame, frame_angle = self._lengths
        level = (thigh**2 + shank**2 - frame**2 - crank**2) / (2 * frame * crank)
        knee = (level, thigh * shank / (frame * crank), float(self.design.boot_angle))
        hip = (crank, thigh, frame, crank**2 - shank**2, self.design.linkage.seat_angle - frame_angle)
        return PerJoint(knee, hip)

    def source_angle(self, joint: str, angle: Any, rate: Any) -> FloatArray:
        """Crank angle at which this tricycle had `joint` at `angle` moving the same way.

        angle: rad, any shape; beyond the range its end that is nearer, round the circle, is used. rate: its sign is
        the direction, zero is extension. Returns rad from top dead centre in (-pi, 2 pi].
        """
        angle = np.clip(self.around(joint, angle), *self.ranges[joint])
        inverse = INVERSES[joint](np, lambda value: np.acos(np.clip(value, -1.0, 1.0)))
        direction = np.where(np.asarray(rate) >= 0, 1.0, -1.0)
        return np.asarray(inverse(self.inverse_geometry[joint], angle, direction))

    def parameters(self, joint: str) -> tuple[tuple[float, ...], float, float]:
        """What torque_map.scalar_source must know of this tricycle."""
        return (self.inverse_geometry[joint], *self.ranges[joint])

    def around(self, joint: str, angle: Any) -> FloatArray:
        """Angles, rad, any shape, by whole turns so that they lie within half a turn of the range's middle."""
        middle = sum(self.ranges[joint]) / 2
        return np.asarray(angle - 2 * np.pi * np.floor((angle - middle) / (2 * np.pi) + 0.5))

    def turns_to_range(self, joint: str, low: Any, high: Any) -> FloatArray:
        """Whole turns, rad, that bring the middle of a path from `low` to `high` (any shape) nearest to the range's.

        A path goes as a whole, so that it does not jump where it is far outside.
        """
        middle = (low + high) / 2
        return np.asarray(self.around(joint, middle) - middle)

    def excess(self, joint: str, angle: Any) -> FloatArray:
        """How far angles (rad, any shape) lie beyond the nearer end of the range, rad; negative below it, 0 inside."""
        angle = self.around(joint, angle)
        return np.asarray(angle - np.clip(angle, *self.ranges[joint]))

    def half_range(self, joint: str) -> float:
        """Half the width of the range, rad."""
        low, high = self.ranges[joint]
        return (high - low) / 2

    def joint_rates(self, crank_angle: FloatArray) -> PerJoint[FloatArray]:
        """Joint speed per crank speed at crank angles from top dead centre, rad."""
        return kinematics.solve(self.design, crank_angle + self.top_dead_centre).joint_rate

    @property
    def _lengths(self) -> tuple[float, float, float, float, float]:
        """Crank, thigh, knee to pedal, hip to crank centre (m), and the direction of the last (rad)."""
        design, centre = self.design, self.design.linkage.crank_centre
        return (
            design.linkage.crank,
            design.rider.thigh,
            float(design.knee_to_pedal),
            abs(centre),
            float(np.angle(centre)),
        )


def _opposite(side: float, first: float, second: float) -> float:
    """Angle opposite to `side` in a triangle with the other sides `first` and `second` (law of cosines), rad."""
    return math.acos((first**2 + second**2 - side**2) / (2 * first * second))


def _knee_inverse(xp: ModuleType, acos: Callable[[Any], Any]) -> Inverse:
    """xp: numpy for arrays, or math for floats. acos: takes a rounding error beyond -1 or 1."""
    cos, pi = xp.cos, math.pi

    def source(geometry: Any, angle: Any, direction: Any) -> Any:
        # cos(crank angle from the hip line) = level - gain cos(angle at the knee): the law of cosines, twice
        level, gain, boot = geometry
        return pi - direction * acos(level - gain * cos(angle + boot))

    return source


def _hip_inverse(xp: ModuleType, acos: Callable[[Any], Any]) -> Inverse:
    """Arguments as _knee_inverse."""
    atan2, cos, sin, sqrt = xp.atan2, xp.cos, xp.sin, xp.sqrt

    def source(geometry: Any, angle: Any, direction: Any) -> Any:
        # the knee seen from the crank centre, x towards the hip; crank and shank close the triangle to it
        crank, thigh, frame, excess, offset = geometry
        thigh_angle = angle + offset
        x, y = frame - thigh * cos(thigh_angle), thigh * sin(thigh_angle)
        distance2 = x * x + y * y
        return direction * acos((excess + distance2) / (2 * crank * sqrt(distance2))) - atan2(y, x)

    return source


# Each builds the inverse of its joint for arrays or for floats.
INVERSES = PerJoint(_knee_inverse, _hip_inverse)

_PAPER = Design(
    "reference TRT",
    Linkage("trt", ground=-0.736 - 0.304j, crank=0.15, foot=0.069, seat_angle=math.radians(60)),
    Rider(thigh=0.52, shank=0.52),
)
# The paper's Section 3: what moments were measured on unless they say otherwise.
PAPER_TRICYCLE = ReferenceTricycle(_PAPER, _PAPER.linkage.cadence)
