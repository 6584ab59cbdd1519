"""Work of joints over a turn as a table of their angle, for one or several sets of joint moments."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from typing import TypeAlias

import numpy as np
from scipy.integrate import cumulative_trapezoid
from scipy.sparse import csr_array

from fes_mj.common.arrays import FloatArray, IntArray
from fes_mj.common.errors import InputError
from fes_mj.linkage.joints import JOINTS, PerJoint
from fes_mj.moments.fourier import fourier
from fes_mj.moments.joint_moments import JointMoments
from fes_mj.moments.reference_tricycle import ReferenceTricycle
from fes_mj.moments.torque_map import torque_map

# Joint, crank angles of the measurement from top dead centre, rad, shape (m,) -> N m, shape (m, sets).
MomentSets: TypeAlias = Callable[[str, FloatArray], FloatArray]
_STEPS = 5400  # over the 1.5 turns that source_angle returns


@dataclass(frozen=True, eq=False)
class WorkTable:
    """Work of each joint, for one or several sets of joint moments side by side, ready to be read at reversals.

    measured_on: the tricycle of all the sets. integral: by joint, from the first of uniform crank angles over
    [-pi, 2 pi] from top dead centre, J, shape (5401, sets). spread: N m, by which the first set of moments varies
    inside the range: what is not known of it outside.
    """

    measured_on: ReferenceTricycle
    integral: PerJoint[FloatArray]
    spread: PerJoint[float]

    @classmethod
    def tabulated(cls, moments: MomentSets, measured_on: ReferenceTricycle) -> "WorkTable":
        """Table of moments that were measured on this tricycle."""
        crank_angle = np.linspace(-np.pi, 2 * np.pi, _STEPS + 1)
        rate, values = measured_on.joint_rates(crank_angle), PerJoint.of(lambda joint: moments(joint, crank_angle))
        integral = PerJoint.of(
            lambda joint: cumulative_trapezoid(values[joint] * rate[joint][:, None], crank_angle, axis=0, initial=0)
        )
        return cls(measured_on, integral, values.map(lambda sets: float(sets[crank_angle >= 0][:-1, 0].std())))

    @classmethod
    def of(cls, *moments: JointMoments) -> "WorkTable":
        """Table of the given joint moments, a set each, all measured on the same tricycle.

        Of legs with moments of their own a set is the mean, as power is that of a leg on average. Raises InputError
        for legs that were measured on different tricycles.
        """
        maps = [[torque_map(leg) for leg in one.of_legs] for one in moments]
        if len({tuple(torque.reference.parameters(joint) for joint in JOINTS) for legs in maps for torque in legs}) > 1:
            names = ", ".join(leg.name for one in moments for leg in one.of_legs)
            raise InputError(f"{names}: moments measured on different tricycles have no angles in common; give one")
        return cls.tabulated(
            lambda joint, angle: np.stack(
                [np.mean([torque.at_source(joint, angle) for torque in legs], axis=0) for legs in maps], axis=-1
            ),
            moments[0].measured_on,
        )

    @property
    def sets(self) -> int:
        return int(self.integral.knee.shape[1])

    def work(self, joint: str, angle: FloatArray, sign: FloatArray, counts: IntArray) -> FloatArray:
        """Work of a joint that turns round at these angles, J a turn, shape (designs, sets).

        angle: rad, and sign: 1 for a maximum, -1 for a minimum, shape (m,), design by design. counts: reversals of each
        design, shape (designs,).
        """
        # work of extending to an angle and flexing back, up to a constant: linear in four entries of the table
        index, weight = np.empty((len(angle), 4), np.int64), np.empty((len(angle), 4))
        for column, direction in ((0, 1.0), (2, -1.0)):
            source = self.measured_on.source_angle(joint, angle, direction)
            position = (source + np.pi) * (_STEPS / (3 * np.pi))
            index[:, column] = np.minimum(position.astype(np.int64), _STEPS - 1)
            index[:, column + 1] = index[:, column] + 1
            weight[:, column + 1] = direction * sign * (position - index[:, column])
            weight[:, column] = direction * sign - weight[:, column + 1]
        ends = np.concatenate([[0], 4 * np.cumsum(counts)])
        shape = (len(counts), _STEPS + 1)
        return np.asarray(csr_array((weight.ravel(), index.ravel(), ends), shape) @ self.integral[joint])


@lru_cache(maxsize=32)
def uncertain_table(moments: JointMoments) -> WorkTable:
    """Table whose first set of moments is the given one, the others its deviations along independent directions.

    A power p, shape (sets,), has the mean p[0] and the norm of p[1:] as its standard deviation. Raises InputError for
    moments whose covariance is not known.
    """
    deviations, torque = moments.deviations, torque_map(moments)

    def sets(joint: str, angle: FloatArray) -> FloatArray:
        # not a product of matrices, the last bits of which depend on threads: a worker process has fewer
        return np.column_stack(
            [torque.at_source(joint, angle), np.einsum("ij,jk->ik", fourier(angle), deviations[joint])]
        )

    return WorkTable.tabulated(sets, moments.measured_on)
