"""What a muscle makes of its stimulation: first order, with a rise and a slower fall, over a turn that repeats."""

from typing import Any

import numpy as np

from fes_mj.common.arrays import FloatArray

_CLOSED = 1e-7  # of an activation, by which a turn may end beside where it began
_BLOCK = 2048  # cases at once: more leave the processor's cache


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
    shares = (constant * (len(here) / turn) for constant in (rise, fall))  # of a time constant, in steps
    *share, start = (np.broadcast_to(values, here[0].shape).reshape(-1) for values in (*shares, start))
    flat = here.reshape(len(here), -1)
    result = np.empty_like(flat)
    for first in range(0, flat.shape[1], _BLOCK):
        block = slice(first, first + _BLOCK)
        result[:, block] = _closed(flat[:, block], np.stack(share)[:, block], start[block])
    return np.ascontiguousarray(np.moveaxis(result.reshape(here.shape), 0, -1)).reshape(stimulation.shape)


def _closed(here: FloatArray, share: FloatArray, start: FloatArray) -> FloatArray:
    """Activation in cases that end a turn where they begin it, shape (angles, cases), by Newton's method.

    share: of the time constants of rise and fall, in steps, shape (2, cases).
    """
    # da/dt = (u - a) / constant with linear u: what is kept of a over a step, and what is added by u at either end
    kept = np.exp(-1 / share)
    follows = share * (1 - kept)
    kept, before, after = (weight.astype(here.dtype) for weight in (kept, follows - kept, 1 - follows))
    added = here[:, None] * before
    added += np.roll(here, -1, axis=0)[:, None] * after
    result, both = np.empty((len(here) + 1, *start.shape), here.dtype), np.empty_like(kept)
    rising, falling = both
    result[0] = start
    while True:
        for change, now, then in zip(added, result, result[1:], strict=False):
            np.multiply(kept, now, out=both)
            np.add(both, change, out=both)
            np.maximum(rising, falling, out=then)
        apart = result[-1] - result[0]
        if np.max(np.abs(apart), initial=0.0) < _CLOSED:
            return result[:-1]
        risen = np.sum(here > result[:-1], axis=0)
        result[0] += apart / (1 - kept[0] ** risen * kept[1] ** (len(here) - risen))
