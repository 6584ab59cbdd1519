"""The loop that steps a ride: in machine code where numba is installed, elsewhere in Python."""

from collections.abc import Callable
from typing import Any, TypeAlias

import mujoco
import numpy as np

from fes_mj.common.machine_code import COMPILED, readable
from fes_mj.simulation.road_control import RoadControl, act, memory_of
from fes_mj.simulation.stepping import Loop, controlled_loop

MakeControl: TypeAlias = Callable[[mujoco.MjModel], RoadControl]  # the control of a ride in its model


def road_loop(make_control: MakeControl) -> Loop:
    """The loop under a control."""
    if COMPILED:
        from fes_mj.simulation.road_compiled import compiled_road_loop

        return compiled_road_loop(make_control)
    return interpreted_road_loop(make_control)


def interpreted_road_loop(make_control: MakeControl) -> Loop:
    """The loop in Python."""

    def bound(model: mujoco.MjModel, data: mujoco.MjData, speeds: Any) -> Callable[[], None]:
        control, memory = readable(make_control(model)), memory_of(model)
        position, ctrl, rates = data.qpos, data.ctrl, np.asarray(speeds)
        return lambda: act(control, memory, position, rates, ctrl)

    return controlled_loop(bound)
