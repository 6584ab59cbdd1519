"""The loop that steps a ride in machine code, kept on disk. Importing this raises MissingPartError without numba."""

from collections.abc import Callable
from typing import Any

import mujoco

from fes_mj.common.machine_code import kept_machine_code, sources
from fes_mj.simulation.compiled import Fields, compiled_controlled_loop, lead, record, step
from fes_mj.simulation.road_control import Memory, RoadControl, act, memory_of
from fes_mj.simulation.stepping import Loop


def compiled_road_loop(make_control: Callable[[mujoco.MjModel], RoadControl]) -> Loop:
    """The loop under the control of a ride in its model."""
    return compiled_controlled_loop(_advance, lambda model: (make_control(model), memory_of(model)), forces=False)


@kept_machine_code
def _advance(
    half: float,
    pointers: tuple[int, int],
    arguments: tuple[RoadControl, Memory],
    fields: Fields,
    sensor_rows: Any,
    force_rows: Any,
    version: int = sources(),
) -> None:
    control, memory = arguments
    for row in range(len(sensor_rows) - 1):
        lead(half, fields)
        act(control, memory, fields.qpos, fields.lead, fields.ctrl)
        step(pointers, fields)
        record(row, fields, sensor_rows, force_rows)
