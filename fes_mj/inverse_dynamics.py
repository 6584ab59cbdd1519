"""The exact massive reference at constant crank speed: d'Alembert loads on the quasi-static model. No MuJoCo."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from fes_mj import kinematics
from fes_mj.design import Design
from fes_mj.kinematics import Motion
from fes_mj.segments import GRAVITY, inertias
from fes_mj.statics import Load, joint_moments, virtual_work
from fes_mj.torque import JointMoments


def body_loads(motion: Motion, cadence: float, mass_scale: float = 1.0, gravity: float = GRAVITY) -> dict[str, Load]:
    """Weight and inertia of every moving body at constant crank speed (rad/s), as loads on it."""
    loads = {}
    for body, inertia in inertias(motion.design).items():
        centre = motion.body_point(body, inertia.centre)
        loads[body] = Load(
            force=-mass_scale * inertia.mass * (cadence**2 * centre.second + 1j * gravity),
            point=centre,
            couple=-mass_scale * inertia.moment * cadence**2 * motion.turning[body][1],
        )
    return loads


def crank_moment(
    design: Design,
    moments: JointMoments,
    cadence: float,
    crank_angle: Any,
    mass_scale: float = 1.0,
    gravity: float = GRAVITY,
) -> NDArray[np.float64]:
    """Crank moment of one leg, N m, at the given crank angles (rad, any order); its mean is the quasi-static one."""
    motion = kinematics.solve(design, crank_angle)
    knee, hip = joint_moments(motion, moments, cadence)
    return virtual_work(motion, knee, hip, body_loads(motion, cadence, mass_scale, gravity))
