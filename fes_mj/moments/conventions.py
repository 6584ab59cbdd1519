"""How laboratories count angles and moments of knee and hip, by name, and how a joint's angles tell it themselves."""

import math
from typing import NamedTuple

from fes_mj.common.arrays import FloatArray
from fes_mj.linkage.joints import PerJoint
from fes_mj.moments.reference_tricycle import ReferenceTricycle

SIGNS = {"positive": 1.0, "negative": -1.0}


class Convention(NamedTuple):
    """Sign of extension in the angles and in the moments of knee and hip; 0 where nothing says it."""

    angle: PerJoint[float]
    moment: PerJoint[float]


# OpenSim's models gait2354 and gait2392 count knee extension positive, Rajagopal's (2016) and those made of it (Lai's
# 2017 among them) knee flexion; in all of them inverse dynamics gives each moment the sense of its angle. Winter's
# textbook, and Visual3D's and Vicon's exports, have flexion angles and extending moments.
CONVENTIONS = {
    "gait2392": Convention(PerJoint(1.0, -1.0), PerJoint(1.0, -1.0)),
    "rajagopal": Convention(PerJoint(-1.0, -1.0), PerJoint(-1.0, -1.0)),
    "winter": Convention(PerJoint(-1.0, -1.0), PerJoint(1.0, 1.0)),
}


class AngleSense(NamedTuple):
    """A way to count a joint's angle: extending angle = zero + sign x angle, rad."""

    words: str
    sign: float
    zero: float

    def extending(self, angle: FloatArray) -> FloatArray:
        """The angle as a design has it (phi), rad."""
        return self.zero + self.sign * angle


_SENSES = (
    AngleSense("flexion positive", -1.0, math.pi),
    AngleSense("extension positive", 1.0, math.pi),
    AngleSense("angle between the segments", 1.0, 0.0),
)
# Rad: a hip's angle counts from pelvis or trunk, whose tilt is not that of the seat.
LARGEST_TILT = math.radians(20)


def angle_sense(joint: str, angle: FloatArray, declared: float, measured_on: ReferenceTricycle) -> AngleSense:
    """How the angles (rad, shape (n,)) of a joint are counted: so that they lie nearest to those of the tricycle.

    declared: sign of extension, which counts unless another sense brings them nearer by over LARGEST_TILT; 0 if unsaid.
    """
    middle = sum(measured_on.ranges[joint]) / 2

    def distance(sense: AngleSense) -> float:
        extending = sense.extending(angle)
        away = abs(float(extending.max() + extending.min()) / 2 - middle)
        return away + LARGEST_TILT * (sense.sign == -declared)

    return min(_SENSES, key=distance)
