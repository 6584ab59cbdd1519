"""What a muscle makes of its stimulation: first order, with a rise and a slower fall, over a turn that repeats."""

from typing import Any

import numpy as np

from fes_mj.common.arrays import FloatArray

_CLOSED = 1e-7  # of an activation, by which a turn may end beside where it began


def trapezium(since_on: Any, width: Any, ramp: Any) -> FloatArray:
    """Stimulation in [0, 1]: from 0 at the on-angle it grows linearly within `ramp`, and so it ends at the off-angle.

    All in rad of crank angle; since_on: since the on-angle, by any whole turns.
    """
    passed = np.mod(since_on, 2 * np.pi)
    return np.asarray(np.clip(np.minimum(passed, width - passed) / ramp, 0.0, 1.0))


def answer(stimulation: FloatArray, turn: Any, rise: Any, fall: Any, start: Any = 0.0) -> FloatArray:
    """Activation over a turn under a stimulation that repeats, both over uniform crank angles, the last axis.

    Activation goes to the stimulation with the time constant `rise` from below and `fall`, which is not shorter, from
    above: always as the constant says that leaves it the higher. Exact over each step for a stimulation that is linear
    between the angles, but for the one in which they cross. turn, rise, fall: s, of the stimulation's shape but for the
    last axis. start: activation at the first angle, as well as it is known; it saves turns.
    """
    here = np.ascontiguousarray(np.moveaxis(np.atleast_2d(stimulation), -1, 0))
    rise, fall, _ = np.broadcast_arrays(rise, fall, here[0])
    constant = np.stack([rise, fall]).astype(here.dtype)
    # da/dt = (u - a) / constant with linear u: what is kept of a over a step, and what is added by u at either end
    share = constant * len(here) / np.asarray(turn, here.dtype)
    kept = np.exp(-1 / share)
    added = here[:, None] * (share * (1 - kept) - kept)
    added += np.roll(here, -1, axis=0)[:, None] * (1 - share * (1 - kept))
    result, both = np.zeros((len(here) + 1, *here.shape[1:]), here.dtype), np.empty_like(kept)
    result[0] = start
    while True:
        for change, now, then in zip(added, result, result[1:], strict=False):
            np.multiply(kept, now, out=both)
            both += change
            np.maximum(both[0], both[1], out=then)
        if np.max(np.abs(result[-1] - result[0]), initial=0.0) < _CLOSED:
            return np.ascontiguousarray(np.moveaxis(result[:-1], 0, -1)).reshape(stimulation.shape)
        result[0] = result[-1]
