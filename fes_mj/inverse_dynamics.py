"""The exact massive reference at constant crank speed: d'Alembert loads on the quasi-static model. No MuJoCo."""

from fes_mj.arrays import FloatArray
from fes_mj.kinematics import Motion
from fes_mj.segments import GRAVITY, inertias
from fes_mj.statics import Load, virtual_work
from fes_mj.torque_map import TorqueMap


def body_loads(motion: Motion, cadence: float, mass_scale: float = 1.0, gravity: float = GRAVITY) -> dict[str, Load]:
    """Weight and inertia of every moving body at constant crank speed (rad/s), as loads on it."""
    loads = {}
    for body, inertia in inertias(motion.design).items():
        centre = motion.body_point(body, inertia.centre)
        loads[body] = Load(
            force=-mass_scale * inertia.mass * (cadence**2 * centre.second + 1j * gravity),
            point=centre,
            couple=-mass_scale * inertia.moment * cadence**2 * motion.rotation[body].second,
        )
    return loads


def crank_moment(
    motion: Motion, torque: TorqueMap, cadence: float, mass_scale: float = 1.0, gravity: float = GRAVITY
) -> FloatArray:
    """Crank moment of one leg along a motion, N m; over a turn its mean is the quasi-static one. cadence: rad/s."""
    loads = body_loads(motion, cadence, mass_scale, gravity)
    return virtual_work(motion, torque.along(motion, cadence), loads)
