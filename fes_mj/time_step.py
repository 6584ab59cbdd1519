"""How many time steps a turn takes, chosen before anything is simulated."""

from __future__ import annotations

import math

from fes_mj.design import Design

TARGET_TIMESTEP = 0.25e-3  # s; the loop gap grows with (speed * step)^2, the error of the torque reading with the step
# The power that masses swing to and fro grows with the cube of the cadence, and the error of reading it with the step:
# above FAST the number of steps in a turn grows with that cube from FEWEST_STEPS.
FAST, FEWEST_STEPS = 10.5, 2400  # rad/s (100 rpm), per turn


def steps_per_turn(design: Design, cadence: float, timestep: float | None = None) -> int:
    """Whole number of time steps in a turn at `cadence` (rad/s), for a step near `timestep` (s) if given."""
    turn = 2 * math.pi / cadence
    if timestep is None:
        return max(round(turn / TARGET_TIMESTEP), round(FEWEST_STEPS * (cadence / FAST) ** 3))
    return max(1, round(turn / timestep))
