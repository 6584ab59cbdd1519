"""Quasi-static crank moment and joint reactions: free-body equilibrium, and virtual work beside it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from fes_mj import kinematics
from fes_mj.design import BODIES, Design
from fes_mj.kinematics import Jet, Motion
from fes_mj.torque import JointMoments, TorqueMap, joint_angles
from fes_mj.uncertainty import power_weights, standard_deviation

# Trapezium rule over a turn; against 36,000 points the mean power changes by less than 1e-5 of itself.
TURN_POINTS = 3600


class Load(NamedTuple):
    """A force (N, complex) at a point of a body, and a couple (N m) on that body, over crank angle."""

    force: Any
    point: Jet
    couple: Any


@dataclass(frozen=True)
class QuasiStatic:
    """One turn of the massless model; arrays over crank angle, shape (n,).

    crank_moment (N m, on the load) and reactions come from free-body equilibrium. A reaction is the complex
    force in N that the first body named by Architecture.joints exerts on the second, by point name.
    """

    design: Design
    moments: JointMoments
    cadence: float  # rad/s
    crank_angle: NDArray[np.float64]  # rad, uniform over one turn
    knee_angle: NDArray[np.float64]  # rad
    hip_angle: NDArray[np.float64]  # rad
    knee_moment: NDArray[np.float64]  # N m, extension positive
    hip_moment: NDArray[np.float64]
    crank_moment: NDArray[np.float64]
    reactions: dict[str, NDArray[np.complex128]]
    motion: Motion

    @property
    def power(self) -> NDArray[np.float64]:
        """Crank power of one leg, W, shape (n,)."""
        return self.crank_moment * self.cadence

    @property
    def power_mean(self) -> float:
        """Mean crank power of one leg over the turn, W (paper, Eq. 1)."""
        return float(self.power.mean())

    @property
    def work_per_turn(self) -> float:
        """Work of one leg on the crank in one turn, J; without a torque-velocity relation the same at any cadence."""
        return float(2 * np.pi * self.crank_moment.mean())

    @property
    def power_weights(self) -> NDArray[np.float64]:
        """Mean power per Fourier coefficient of knee, then hip moment, W/(N m), shape (98,)."""
        return power_weights(self.motion, self.cadence, self.moments)

    @property
    def power_sd(self) -> float | None:
        """Standard deviation of power_mean, W, by the error of recovered moments; None for a user's own moments."""
        covariance = self.moments.covariance
        return None if covariance is None else standard_deviation(self.power_weights, covariance)


def quasi_static(
    design: Design, moments: JointMoments, cadence: float | None = None, points: int = TURN_POINTS
) -> QuasiStatic:
    """Solve one turn of the massless, gravity-free model.

    cadence: crank speed in rad/s, by default the design's own (Eq. 16). points: crank angles from 0, uniform.
    Raises AssemblyError if the linkage does not close over the whole turn.
    """
    kinematics.require_assembly(design)
    crank_angle = np.linspace(0, 2 * np.pi, points, endpoint=False)
    motion = kinematics.solve(design, crank_angle)
    cadence = design.linkage.cadence if cadence is None else cadence
    knee, hip = joint_moments(motion, moments, cadence)
    crank_moment, reactions = equilibrium(motion, knee, hip)
    return QuasiStatic(
        design=design,
        moments=moments,
        cadence=cadence,
        crank_angle=crank_angle,
        knee_angle=motion.knee_angle,
        hip_angle=motion.hip_angle,
        knee_moment=knee,
        hip_moment=hip,
        crank_moment=crank_moment,
        reactions=reactions,
        motion=motion,
    )


def joint_moments(motion: Motion, moments: JointMoments, cadence: Any = None) -> tuple[Any, Any]:
    """Knee and hip moment, N m, that the torque map gives along a motion at forward crank speed.

    cadence: rad/s, by default the design's own; only its size counts, and only with a torque-velocity relation.
    """
    speed = abs(motion.design.linkage.cadence if cadence is None else cadence)
    torque_map, angles = TorqueMap(moments), joint_angles(motion)
    knee, hip = (torque_map.moment(joint, angle, speed * rate) for joint, (angle, rate) in angles.items())
    return knee, hip


def virtual_work(motion: Motion, knee: Any, hip: Any, loads: Mapping[str, Load] | None = None) -> Any:
    """Crank moment, N m, by which moments and loads do no net virtual work: exact for any single-crank linkage."""
    moment = knee * motion.knee_rate + hip * motion.hip_rate
    for body, load in (loads or {}).items():
        moment = moment + (np.conj(load.force) * load.point.first).real + load.couple * motion.turning[body][0]
    return moment


def joint_couples(knee: Any, hip: Any) -> dict[str, Any]:
    """Couple of the joint moments on each body, N m: extension turns the thigh forwards, the shank back against it."""
    return {"thigh": hip + knee, "shank": -knee}


def moment_arm(motion: Motion, body: str, point: str) -> Any:
    """From a body's origin to one of its points, m, complex."""
    return motion.points[point].value - motion.points[BODIES[body][0]].value


def equilibrium(
    motion: Motion, knee: Any, hip: Any, loads: Mapping[str, Load] | None = None
) -> tuple[NDArray[np.float64], dict[str, NDArray[np.complex128]]]:
    """Crank moment and joint reactions from three equilibrium equations a body, solved at every crank angle.

    The equations are those of the free-body diagrams of the paper (Eq. 4, 9, 14), with its misprints
    corrected and the bearings kept as unknowns. Returns as in QuasiStatic.
    """
    architecture = motion.design.linkage.architecture
    bodies, joints = architecture.bodies, architecture.joints
    size, count = 3 * len(bodies), np.size(motion.crank_angle)
    matrix, right = np.zeros((count, size, size)), np.zeros((count, size))
    couples = joint_couples(knee, hip)
    for row, body in enumerate(bodies):
        for column, (point, pair) in enumerate(joints.items()):
            if body in pair:
                sign = 1.0 if pair[1] == body else -1.0
                arm = moment_arm(motion, body, point)
                matrix[:, 3 * row, 2 * column] = sign
                matrix[:, 3 * row + 1, 2 * column + 1] = sign
                matrix[:, 3 * row + 2, 2 * column] = -sign * arm.imag
                matrix[:, 3 * row + 2, 2 * column + 1] = sign * arm.real
        right[:, 3 * row + 2] = -np.asarray(couples.get(body, 0.0))
        if loads:
            load, origin = loads[body], motion.points[BODIES[body][0]].value
            right[:, 3 * row] -= load.force.real
            right[:, 3 * row + 1] -= load.force.imag
            right[:, 3 * row + 2] -= load.couple + (np.conj(load.point.value - origin) * load.force).imag
    matrix[:, 3 * bodies.index("crank") + 2, -1] = -1.0  # the load's moment on the crank is minus ours
    solution: NDArray[np.float64] = np.linalg.solve(matrix, right[..., None])[..., 0].astype(float)
    reactions = {
        point: solution[:, 2 * column] + 1j * solution[:, 2 * column + 1] for column, point in enumerate(joints)
    }
    return solution[:, -1], reactions
