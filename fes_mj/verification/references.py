"""Crank moment by methods that share as little as possible, over one turn, and how far they are apart.

Massive methods see masses and weight, massless ones do not; within each family all must agree.
"""

from collections.abc import Iterator
from itertools import combinations
from typing import TypeAlias

import mujoco
import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.common.checks import Check
from fes_mj.crosscheck.turn_case import Case
from fes_mj.linkage.joints import PerJoint
from fes_mj.linkage.kinematics import Motion, uniform_turn
from fes_mj.simulation.mjcf import REAL, Physics, joint_motion
from fes_mj.statics.equilibrium import virtual_work

MomentCurves: TypeAlias = dict[str, FloatArray]  # method -> crank moment, N m, shape (angles,)
EVERY_DEGREE = uniform_turn(360)
NEARLY_MASSLESS = Physics(mass_scale=1e-3, gravity=0.0)


def exact_curves(case: Case, crank_angle: FloatArray | None = None) -> dict[str, MomentCurves]:
    """Crank moment by every method that needs no simulation; families "massive" and "massless".

    crank_angle: rad, shape (angles,), by default every degree.
    """
    motion = case.steps.motion(EVERY_DEGREE if crank_angle is None else crank_angle)
    joint_moment, loads = case.steps.joint_moment(motion), case.steps.loads(motion)
    return {
        "massless": {
            "equilibrium": case.steps.equilibrium(motion, joint_moment)[0],
            "virtual work": virtual_work(motion, joint_moment),
        },
        "massive": {
            "equilibrium": case.steps.equilibrium(motion, joint_moment, loads)[0],
            "inverse dynamics": case.steps.crank_moment(motion),
            "mj_inverse": mujoco_inverse(case, motion, joint_moment),
        },
    }


def mujoco_inverse(
    case: Case, motion: Motion, joint_moment: PerJoint[FloatArray], physics: Physics = REAL
) -> FloatArray:
    """Crank moment from MuJoCo's inverse dynamics of the open tree, N m, shape (angles,).

    The loops are switched off and the exact constant-speed motion is put in; the forces it needs, less the joint
    motors, are projected on the closed linkage's one degree of freedom. Constraint softness has no part in it.
    """
    model = case.steps.spec(physics).compile()
    model.opt.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_EQUALITY | mujoco.mjtDisableBit.mjDSBL_ACTUATION)
    ones = np.ones(np.size(motion.crank_angle))
    joints = joint_motion(motion) | {"crank": (motion.crank_angle * ones, ones, 0 * ones)}
    names = [model.joint(i).name for i in range(model.njnt)]  # hinges only: one coordinate each
    position, rate, second = (np.column_stack([joints[name][part] * ones for name in names]) for part in range(3))
    motors = np.zeros_like(position)
    for joint, moment in joint_moment.items():
        motors[:, names.index(joint)] = moment
    data, needed = mujoco.MjData(model), np.empty_like(position)
    for row in range(len(ones)):
        data.qpos, data.qvel, data.qacc = position[row], case.cadence * rate[row], case.cadence**2 * second[row]
        mujoco.mj_inverse(model, data)
        needed[row] = data.qfrc_inverse
    return np.asarray(np.sum(rate * (motors - needed), axis=1))


def differences(curves: MomentCurves) -> dict[tuple[str, str], float]:
    """Largest difference of every pair of methods over the turn, N m."""
    return {(one, other): float(np.abs(curves[one] - curves[other]).max()) for one, other in combinations(curves, 2)}


def massless_difference(case: Case) -> float:
    """Largest difference over the turn between the two inverse dynamics of a leg almost without masses, N m."""
    motion = case.steps.motion(EVERY_DEGREE)
    mujoco = mujoco_inverse(case, motion, case.steps.joint_moment(motion), NEARLY_MASSLESS)
    computed = case.steps.crank_moment(motion, NEARLY_MASSLESS.mass_scale, NEARLY_MASSLESS.gravity)
    return float(np.abs(mujoco - computed).max())


def exact_checks(case: Case) -> Iterator[Check]:
    """Agreement of the methods that must agree to rounding."""
    curves = exact_curves(case)
    massless, massive = (differences(curves[family]) for family in ("massless", "massive"))
    yield case.check("virtual_work", massless["equilibrium", "virtual work"])
    yield case.check("massless_limit", massless_difference(case))
    yield case.check("massive_equilibrium", massive["equilibrium", "inverse dynamics"])
    yield case.check("mujoco_inverse", massive["inverse dynamics", "mj_inverse"])
