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


def periodic_activation(
    stimulation: FloatArray, turn: Any, rise: Any, fall: Any, start: Any = 0.0, step: FloatArray | None = None
) -> FloatArray:
    """Activation over a turn under a stimulation that repeats, both over crank angles, the last axis.

    Activation goes to the stimulation with the time constant `rise` from below and `fall`, which is not shorter, from
    above: always as the constant says that leaves it the higher. Exact over each step for a stimulation that is linear
    between the angles, but for the one in which they cross. turn, rise, fall: s, of the stimulation's shape but for the
    last axis. start: activation at the first angle, as well as it is known; it saves turns. step: share of the turn
    from each angle to the next, of the stimulation's shape; by default they are uniform.
    """
    here = _first(np.atleast_2d(stimulation))
    shares = (constant / turn for constant in (rise, fall))
    *share, start = (np.broadcast_to(values, here[0].shape).reshape(-1) for values in (*shares, start))
    flat = here.reshape(len(here), -1)
    steps = np.full((1, flat.shape[1]), 1 / len(here)) if step is None else _first(step).reshape(flat.shape)
    result = np.empty_like(flat)
    for first in range(0, flat.shape[1], _BLOCK):
        block = slice(first, first + _BLOCK)
        result[:, block] = _closed(flat[:, block], np.stack(share)[:, block], start[block], steps[:, block])
    return np.ascontiguousarray(np.moveaxis(result.reshape(here.shape), 0, -1)).reshape(stimulation.shape)


def _first(values: FloatArray) -> FloatArray:
    """With the last axis in front."""
    return np.ascontiguousarray(np.moveaxis(values, -1, 0))


def _closed(here: FloatArray, share: FloatArray, start: FloatArray, step: FloatArray) -> FloatArray:
    """Activation in cases that end a turn where they begin it, shape (angles, cases), by Newton's method.

    share: of the turn, of the time constants of rise and fall, shape (2, cases). step: of the turn, shape (angles or
    1, cases).
    """
    # da/dt = (u - a) / constant with linear u: what is kept of a over a step, and what is added by u at either end
    spent = np.maximum(step[:, None] / share, np.finfo(float).tiny)  # a jump takes no time
    kept = np.exp(-spent)
    follows = -np.expm1(-spent) / spent
    kept, before, after = (weight.astype(here.dtype) for weight in (kept, follows - kept, 1 - follows))
    added = here[:, None] * before
    added += np.roll(here, -1, axis=0)[:, None] * after
    kept = np.broadcast_to(kept, added.shape)
    result, both = np.empty((len(here) + 1, *start.shape), here.dtype), np.empty_like(added[0])
    rising, falling = both
    result[0] = start
    while True:
        for part, change, now, then in zip(kept, added, result, result[1:], strict=False):
            np.multiply(part, now, out=both)
            np.add(both, change, out=both)
            np.maximum(rising, falling, out=then)
        apart = result[-1] - result[0]
        if np.max(np.abs(apart), initial=0.0) < _CLOSED:
            return result[:-1]
        risen = np.sum(step * (here > result[:-1]), axis=0)
        result[0] += apart / (1 - np.exp(-risen / share[0] - (1 - risen) / share[1]))
