"""What drives the legs of a design, joint moments or muscles: when it can, and what moments it gives."""

from typing import TypeAlias

from fes_mj.linkage.design import Design
from fes_mj.linkage.torque_source import TorqueSource
from fes_mj.linkage.turning import turning
from fes_mj.linkage.variables import crank_speed
from fes_mj.moments.joint_moments import JointMoments
from fes_mj.moments.torque_map import torque_map
from fes_mj.muscles.drive import Muscles
from fes_mj.statics.validity import valid_speed

Drive: TypeAlias = JointMoments | Muscles


def driven_speed(design: Design, drive: Drive, cadence: float | None = None, legs: int = 1) -> float:
    """Crank speed of a run, rad/s, of a design that can be run: `cadence`, or if it is None that of Eq. 16.

    Raises InputError as validity.valid_speed for joint moments, and for muscles as rules.stimulated.
    """
    if isinstance(drive, JointMoments):
        return valid_speed(design, drive, cadence, legs)
    turning(design)
    speed = crank_speed(design, cadence)
    drive.stimulated(design, speed)
    return speed


def torque_source(drive: Drive, design: Design, cadence: float) -> TorqueSource:
    """What gives the joint moments of a design at a cadence in rad/s. Raises as driven_speed."""
    return torque_map(drive) if isinstance(drive, JointMoments) else drive.torque(design, cadence)
