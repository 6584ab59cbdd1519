"""What muscles pull with along a motion, per activation: forces, joint moments, power."""

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.linkage.design import Rider
from fes_mj.linkage.joints import PerJoint
from fes_mj.linkage.kinematics import Motion
from fes_mj.muscles.anatomy import Anatomy, anatomy
from fes_mj.muscles.contraction import tension
from fes_mj.muscles.geometry import Flexion, Values
from fes_mj.muscles.riders import Riders


@dataclass(frozen=True, eq=False)
class Pull:
    """Fully activated muscles of every member along the motion of every design.

    Shape (muscles, members, designs, angles): force, N; lengths, m, and speed, m/s, at which they grow, of muscles as
    large as the anatomy's. scale: by which the rider's are larger, shape (muscles, members or 1, designs, 1).
    """

    anatomy: Anatomy
    force: FloatArray
    lengths: Values
    speed: FloatArray
    scale: FloatArray

    @cached_property
    def power(self) -> FloatArray:
        """Crank power per activation of each group, W, shape (groups, members, designs, angles)."""
        return -self.of_groups(self.force * self.speed)

    @cached_property
    def moment(self) -> PerJoint[FloatArray]:
        """Joint moment per activation of each group, N m, positive in extension, of the shape of `power`.

        A muscle's moment arm is the change of its length with flexion.
        """
        arms = PerJoint(self.lengths.by_knee, self.lengths.by_hip)
        return arms.map(lambda arm: self.of_groups(self.force * arm))

    def alone(self, member: int) -> "Pull":
        """That of one of the riders."""
        lengths = Values(*(values[:, [member]] for values in self.lengths))
        return Pull(self.anatomy, self.force[:, [member]], lengths, self.speed[:, [member]], self.scale)

    def of_groups(self, values: FloatArray) -> FloatArray:
        """Sums over the muscles of each group, each as much longer as the rider's is."""
        longer = self.scale * values
        return np.stack([longer[muscles].sum(axis=0) for muscles in self.anatomy.of_group])


def pull(riders: Riders, motion: Motion, cadence: Any, muscles: Anatomy | None = None) -> Pull:
    """Of riders along a motion of one design or of a batch; cadence: rad/s, or of each design, shape (designs, 1).

    muscles: those that ship by default.
    """
    flexion = riders.flexion(motion)
    rate = motion.joint_rate.map(lambda rate: -cadence * np.atleast_2d(rate))
    return pull_at(riders, flexion, Flexion(rate.hip, rate.knee), motion.design.rider, muscles)


def pull_each(riders: Riders, motion: Motion, cadence: float) -> Pull:
    """Of every member along the motion of a design of its own, of a batch as large; the Pull has one design."""
    rate = motion.joint_rate.map(lambda rate: -cadence * rate[:, None])
    pulled = pull_at(riders, riders.flexion_each(motion), Flexion(rate.hip, rate.knee), motion.design.rider)
    return replace(pulled, scale=pulled.scale.swapaxes(1, 2))


def pull_at(riders: Riders, flexion: Flexion, rate: Flexion, rider: Rider, muscles: Anatomy | None = None) -> Pull:
    """The same at angles and rates of flexion (rad, rad/s) of shape (members or 1, designs, angles)."""
    muscles = muscles or anatomy()
    lengths = muscles.lengths.at(flexion)
    speed = lengths.by_hip * rate.hip + lengths.by_knee * rate.knee
    slack, strength = riders.slack(muscles), riders.strength(muscles)
    force, columns = np.empty_like(speed), (muscles.optimal, muscles.pennation, muscles.force)
    # one after the other, as all of an ensemble do not fit the processor's cache
    for muscle, (optimal, pennation, strongest) in enumerate(zip(*columns, strict=True)):
        # length, fibre and tendon grow alike with the rider, so that relative lengths and speeds are the anatomy's
        relative, _ = tension(
            lengths.value[muscle], speed[muscle], optimal, slack[muscle], pennation, riders["max_speed"]
        )
        np.multiply(relative, strength[muscle] * strongest, out=force[muscle])
    return Pull(muscles, force, lengths, speed, muscles.length_scale(rider)[:, None])
