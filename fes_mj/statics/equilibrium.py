"""What holds a leg and its linkage in balance: free-body equilibrium, and virtual work beside it.

With the loads of weight and inertia (d'Alembert) both are the exact massive reference at constant crank speed: inverse
dynamics without MuJoCo.
"""

from collections.abc import Callable, Mapping

import numpy as np

from fes_mj.common.arrays import ComplexArray, FloatArray
from fes_mj.linkage.design import BODIES
from fes_mj.linkage.inertia import GRAVITY, BodyLoad, body_loads
from fes_mj.linkage.joints import PerJoint
from fes_mj.linkage.kinematics import Motion
from fes_mj.linkage.torque_source import TorqueSource


def crank_moment(
    motion: Motion, torque: TorqueSource, cadence: float, mass_scale: float = 1.0, gravity: float = GRAVITY
) -> FloatArray:
    """Crank moment of one leg with its masses along a motion, N m; over a turn its mean is the quasi-static one.

    cadence: rad/s, held. mass_scale: factor on all masses. gravity: m/s^2.
    """
    loads = body_loads(motion, cadence, mass_scale, gravity)
    return virtual_work(motion, torque.along(motion, cadence), loads)


def virtual_work(
    motion: Motion, joint_moment: PerJoint[FloatArray], loads: Mapping[str, BodyLoad] | None = None
) -> FloatArray:
    """Crank moment, N m, by which moments and loads do no net virtual work: exact for any single-crank linkage."""
    rate = motion.joint_rate
    moment = joint_moment.knee * rate.knee + joint_moment.hip * rate.hip
    for body, load in (loads or {}).items():
        moment = moment + (np.conj(load.force) * load.point.first).real + load.couple * motion.rotation[body].first
    return moment


def joint_couples(joint_moment: PerJoint[FloatArray]) -> dict[str, FloatArray]:
    """Couple of the joint moments on each body, N m: extension turns the thigh forwards, the shank back against it."""
    return {"thigh": joint_moment.hip + joint_moment.knee, "shank": -joint_moment.knee}


def moment_arm(motion: Motion, body: str, point: str) -> ComplexArray:
    """From a body's origin to one of its points, m."""
    return motion.points[point].value - motion.points[BODIES[body][0]].value


def equilibrium(
    motion: Motion,
    joint_moment: PerJoint[FloatArray],
    loads: Mapping[str, BodyLoad] | None = None,
    *,
    couples: Callable[[PerJoint[FloatArray]], dict[str, FloatArray]] = joint_couples,
    arm: Callable[[Motion, str, str], ComplexArray] = moment_arm,
) -> tuple[FloatArray, dict[str, ComplexArray]]:
    """Crank moment and joint reactions from three equilibrium equations a body, solved at every crank angle.

    The equations are those of the free-body diagrams of the paper (Eq. 4, 9, 14), with its misprints corrected and the
    bearings kept as unknowns; couples and arm are the two places of the misprints. Returns as in QuasiStatic.
    """
    architecture = motion.design.linkage.architecture
    bodies, joints = architecture.bodies, architecture.joints
    size, count = 3 * len(bodies), np.size(motion.crank_angle)
    matrix, right = np.zeros((count, size, size)), np.zeros((count, size))
    couple = couples(joint_moment)
    for row, body in enumerate(bodies):
        for column, (point, pair) in enumerate(joints.items()):
            if body in pair:
                sign = 1.0 if pair[1] == body else -1.0
                lever = arm(motion, body, point)
                xy = slice(2 * column, 2 * column + 2)
                matrix[:, 3 * row : 3 * row + 2, xy] = sign * np.eye(2)
                matrix[:, 3 * row + 2, xy] = sign * np.stack([-lever.imag, lever.real], axis=-1)
        if body in couple:
            right[:, 3 * row + 2] = -couple[body]
        if loads:
            load, origin = loads[body], motion.points[BODIES[body][0]].value
            right[:, 3 * row] -= load.force.real
            right[:, 3 * row + 1] -= load.force.imag
            right[:, 3 * row + 2] -= load.couple + (np.conj(load.point.value - origin) * load.force).imag
    matrix[:, 3 * bodies.index("crank") + 2, -1] = -1.0  # the load's moment on the crank is minus ours
    solution: FloatArray = np.linalg.solve(matrix, right[..., None])[..., 0].astype(float)
    reactions = {
        point: solution[:, 2 * column] + 1j * solution[:, 2 * column + 1] for column, point in enumerate(joints)
    }
    return solution[:, -1], reactions
