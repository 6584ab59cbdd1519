"""What a leg's muscles do to the crank, in a table over its angle: all that does not depend on crank speed.

At a crank speed w and an activation a a muscle drives the crank with a F(x) f(s(x) w): F is its force at rest times its
shortening per crank angle, s that shortening in largest speeds, f the force-velocity relation.
"""

from typing import Any, NamedTuple

import numpy as np

from fes_mj.common.arrays import FloatArray, IntArray
from fes_mj.common.machine_code import machine_code
from fes_mj.linkage.kinematics import Motion
from fes_mj.muscles.anatomy import anatomy
from fes_mj.muscles.contraction import CURVATURE, LENGTHENING, PLATEAU, tension
from fes_mj.muscles.riders import Riders


class MuscleTable(NamedTuple):
    """Over uniform crank angles of a turn of the own leg, the first repeated at its end.

    group: of each muscle, shape (muscles,). drive: N m per activation, at rest, and shortening: per crank speed, s/rad,
    in largest speeds, shape (cells + 1, muscles).
    """

    group: IntArray
    drive: FloatArray
    shortening: FloatArray


NO_MUSCLES = MuscleTable(np.zeros(0, int), *np.zeros((2, 1, 0)))


def muscle_table(riders: Riders, motion: Motion) -> MuscleTable:
    """Of one rider along a motion over uniform crank angles of a turn."""
    muscles, column = anatomy(), (slice(None), None, None, None)
    lengths = muscles.lengths.at(riders.flexion(motion))
    rate = motion.joint_rate.map(lambda rate: -np.atleast_2d(rate))  # of flexion
    growth = lengths.by_hip * rate.hip + lengths.by_knee * rate.knee
    parameters = (muscles.optimal[column], riders.slack(muscles), muscles.pennation[column], riders["max_speed"])
    relative, cosine = tension(lengths.value, np.zeros_like(growth), *parameters)
    scale = muscles.length_scale(motion.design.rider)[:, None]
    force = scale * relative * riders.strength(muscles) * muscles.force[column]
    largest = riders["max_speed"] * muscles.optimal[column]
    curves = (
        np.broadcast_to(values, growth.shape)[:, 0, 0] for values in (-force * growth, -growth * cosine / largest)
    )
    return MuscleTable(muscles.group, *(np.concatenate([curve, curve[:, :1]], axis=1).T.copy() for curve in curves))


@machine_code
def speed_factor(shortening: float) -> float:
    """Force per force at rest (contraction.force_velocity)."""
    if shortening >= 1:
        return 0.0
    if shortening >= 0:
        return (1 - shortening) / (1 + shortening / CURVATURE)
    lengthening = max(shortening, -1.0)
    return 1 + lengthening * (PLATEAU - 1) * (LENGTHENING + 1) / (LENGTHENING * lengthening - 1)


@machine_code
def driven_by(
    muscles: MuscleTable, row: int, part: float, crank_speed: float, activation: tuple[float, float, float]
) -> float:
    """Virtual work of a leg's muscles per crank angle, N m, in a cell and at a part of it; activation: by group."""
    drive, drive_then = muscles.drive[row], muscles.drive[row + 1]
    speed, speed_then = muscles.shortening[row], muscles.shortening[row + 1]
    total = 0.0
    for muscle in range(len(muscles.group)):
        active = activation[muscles.group[muscle]]
        if active > 0:
            shortening = (speed[muscle] + part * (speed_then[muscle] - speed[muscle])) * crank_speed
            total += active * (drive[muscle] + part * (drive_then[muscle] - drive[muscle])) * speed_factor(shortening)
    return total


def at_rest(muscles: MuscleTable, activation: Any) -> FloatArray:
    """The same at a stand over the turn, shape (cells,); activation: shape (groups, cells)."""
    return np.asarray((muscles.drive[:-1] * activation[muscles.group].T).sum(axis=1))
