"""The exact massive reference at constant crank speed: d'Alembert loads on the quasi-static model. No MuJoCo."""

from fes_mj.arrays import FloatArray
from fes_mj.kinematics import Motion
from fes_mj.loads import body_loads
from fes_mj.segments import GRAVITY
from fes_mj.statics import virtual_work
from fes_mj.torque_map import TorqueMap


def crank_moment(
    motion: Motion, torque: TorqueMap, cadence: float, mass_scale: float = 1.0, gravity: float = GRAVITY
) -> FloatArray:
    """Crank moment of one leg along a motion, N m; over a turn its mean is the quasi-static one. cadence: rad/s."""
    loads = body_loads(motion, cadence, mass_scale, gravity)
    return virtual_work(motion, torque.along(motion, cadence), loads)
