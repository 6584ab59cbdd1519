"""The exact massive reference at constant crank speed: d'Alembert loads on the quasi-static model. No MuJoCo."""

from fes_mj.common.arrays import FloatArray
from fes_mj.linkage.kinematics import Motion
from fes_mj.linkage.loads import body_loads
from fes_mj.linkage.segments import GRAVITY
from fes_mj.moments.torque_map import TorqueMap
from fes_mj.statics.turn import virtual_work


def crank_moment(
    motion: Motion, torque: TorqueMap, cadence: float, mass_scale: float = 1.0, gravity: float = GRAVITY
) -> FloatArray:
    """Crank moment of one leg along a motion, N m; over a turn its mean is the quasi-static one. cadence: rad/s."""
    loads = body_loads(motion, cadence, mass_scale, gravity)
    return virtual_work(motion, torque.along(motion, cadence), loads)
