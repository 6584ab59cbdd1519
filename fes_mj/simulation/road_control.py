"""What the rider's muscles and the freewheel do in each step of a ride: in Python, and in machine code."""

import math
from collections.abc import Callable
from functools import partial
from typing import Any

import mujoco
import numpy as np

from fes_mj.linkage.joints import JOINTS
from fes_mj.linkage.legs import TWO_LEGS
from fes_mj.moments.drive import POINTS, drive
from fes_mj.moments.torque_velocity import AT_ANY_SPEED, hill_factor
from fes_mj.riding.ride import Ride
from fes_mj.simulation.compiled import compiled_controlled_loop
from fes_mj.simulation.road_mjcf import ROAD
from fes_mj.simulation.stepping import Loop, controlled_loop, drive_addresses


def road_loop(ride: Ride) -> Loop:
    """Joint moments commanded by crank angle, and the freewheel's limit kept at the length reached; steps in Python."""
    control = make_control(lambda function: function)

    def bound(model: mujoco.MjModel, data: mujoco.MjData, speeds: Any) -> Callable[[], None]:
        arrays = [each.tolist() if isinstance(each, np.ndarray) else each for each in control_arguments(ride, model)]
        arguments = (memoryview(model.tendon_range.reshape(-1)), *arrays[1:])
        position, ctrl = memoryview(data.qpos), memoryview(data.ctrl)
        return partial(control, arguments, position, speeds, ctrl)

    return controlled_loop(bound)


def compiled_road_loop(ride: Ride) -> Loop:
    """The same in machine code. Raises MissingPartError without numba."""
    return compiled_controlled_loop(make_control, partial(control_arguments, ride), forces=False)


def control_arguments(ride: Ride, model: mujoco.MjModel) -> tuple[Any, ...]:
    """What the control of make_control needs beside the state: arrays, and memory from step to step."""
    told = {leg: drive(ride.design, ride.moments.of_leg(leg.prefix), ride.lag) for leg in TWO_LEGS}
    relation = ride.moments.torque_velocity or AT_ANY_SPEED
    muscles = [(leg, joint) for leg in TWO_LEGS for joint in JOINTS]
    addresses = [drive_addresses(model, leg.prefix + joint) for leg, joint in muscles]
    crank = model.joint("crank")
    lag, step = ride.lag, model.opt.timestep
    return (
        model.tendon_range.reshape(-1),
        np.array([model.joint(ROAD).qposadr[0], crank.qposadr[0], crank.dofadr[0]]),
        np.array([actuator for actuator, _, _ in addresses]),
        np.array([speed for _, _, speed in addresses]),
        np.array([POINTS / (2 * math.pi) * leg.lag for leg, _ in muscles]),
        np.array([relation.max_speed[joint] for _, joint in muscles]),
        np.array([np.append(told[leg].command[joint], told[leg].command[joint][0]) for leg, joint in muscles]),
        np.array(
            [
                float(ride.fixed),
                ride.travel,
                lag,
                ride.moments.measured_on.cadence,
                math.exp(-step / lag) if lag else 0.0,
                relation.curvature,
                relation.eccentric_plateau,
            ]
        ),
        np.full(2 * len(muscles), np.nan),  # answers and commands of the step before
    )


def make_control(compiled: Callable[[Any], Any]) -> Callable[..., None]:
    """Sets the moments and the freewheel. compiled: what makes machine code of Python functions, if anything."""
    hill, cells = compiled(hill_factor), POINTS / (2 * math.pi)

    @compiled
    def control(arguments: Any, qpos: Any, speeds: Any, ctrl: Any) -> None:
        limit, places, actuators, joints, behind, fastest, tables, constants, memory = arguments
        fixed, travel, lag, measured, kept, curvature, plateau = constants
        angle, count = qpos[places[1]], len(actuators)
        if not fixed:
            limit[0] = max(limit[0], qpos[places[0]] / travel - angle)
        if lag > 0:
            angle += math.atan(speeds[places[2]] * lag) - math.atan(measured * lag)
        for muscle in range(count):
            place = (cells * angle - behind[muscle]) % POINTS
            row = int(place)
            table = tables[muscle]
            told = table[row] + (place - row) * (table[row + 1] - table[row])
            moment = told
            if lag > 0:
                if memory[muscle] == memory[muscle]:  # exact for a command that stays at its mean over the step
                    mean = (memory[count + muscle] + told) / 2
                    moment = mean + kept * (memory[muscle] - mean)
                memory[muscle], memory[count + muscle] = moment, told
            relative = (speeds[joints[muscle]] if moment > 0 else -speeds[joints[muscle]]) / fastest[muscle]
            shortening, lengthening = min(max(relative, 0.0), 1.0), max(-relative, 0.0)
            ctrl[actuators[muscle]] = moment * hill(curvature, plateau, shortening, lengthening)

    result: Callable[..., None] = control
    return result
