"""What a muscle makes of its stimulation: first order, with a rise and a slower fall, over a turn that repeats."""

from typing import Any

import numpy as np

from fes_mj.common.arrays import FloatArray

_CLOSED = 1e-10  # of an activation, by which a turn may end beside where it began


def trapezium(since_on: Any, width: Any, ramp: Any) -> FloatArray:
    """Stimulation in [0, 1]: from 0 at the on-angle it grows linearly within `ramp`, and so it ends at the off-angle.

    All in rad of crank angle; since_on: since the on-angle, by any whole turns.
    """
    passed = np.mod(since_on, 2 * np.pi)
    return np.asarray(np.clip(np.minimum(passed, width - passed) / ramp, 0.0, 1.0))


def answer(stimulation: FloatArray, turn: Any, rise: Any, fall: Any) -> FloatArray:
    """Activation over a turn under a stimulation that repeats, both over uniform crank angles, the last axis.

    Exact for a stimulation that is linear between the angles: over each step activation goes to it with the time
    constant `rise` where the step's middle is above, else `fall`. turn, rise, fall: s, of the stimulation's shape but
    for the last axis.
    """
    points = stimulation.shape[-1]
    here = np.moveaxis(stimulation, -1, 0)
    there = np.roll(here, -1, axis=0)
    middle = (here + there) / 2
    steps = [_step(np.asarray(turn) / points, np.asarray(constant)) for constant in (rise, fall)]
    kept = [step[0] for step in steps]
    added = [step[1] * here + step[2] * there for step in steps]
    result = np.empty_like(middle)
    activation = np.zeros(middle.shape[1:])
    while True:
        start = activation
        for point in range(points):
            result[point] = activation
            upwards = middle[point] > activation
            activation = np.where(
                upwards, kept[0] * activation + added[0][point], kept[1] * activation + added[1][point]
            )
        if np.max(np.abs(activation - start), initial=0.0) < _CLOSED:
            return np.moveaxis(result, 0, -1)


def _step(seconds: Any, constant: Any) -> tuple[Any, Any, Any]:
    """Of da/dt = (u - a) / constant over a step with linear u: what is kept of a, and the weights of u at its ends."""
    kept = np.exp(-seconds / constant)
    part = (1 - kept) * constant / seconds
    return kept, part - kept, 1 - part
