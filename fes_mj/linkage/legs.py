"""The two legs of a rider: half a turn apart, side by side."""

import math
from dataclasses import dataclass
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from fes_mj.common.arrays import FloatArray
from fes_mj.common.errors import InputError

Scalar = TypeVar("Scalar", bound=np.generic)


@dataclass(frozen=True)
class Leg:
    """One leg with its linkage: name prefix, how far its crank arm trails the first leg's (rad), plane's y (m)."""

    prefix: str
    lag: float
    lateral: float

    @property
    def outwards(self) -> int:
        """Sign of y away from the rider's middle."""
        return -1 if self.lateral < 0 else 1


ONE_LEG = (Leg("", 0.0, 0.0),)
TWO_LEGS = (Leg("right_", 0.0, 0.17), Leg("left_", math.pi, -0.17))


class _Legs(dict[int, tuple[Leg, ...]]):
    def __missing__(self, count: int) -> tuple[Leg, ...]:
        raise InputError(f"legs is {count!r}; a rider pedals with 1 or 2")


LEGS = _Legs({1: ONE_LEG, 2: TWO_LEGS})


def delayed(curve: NDArray[Scalar], lag: float) -> NDArray[Scalar]:
    """A curve over uniform crank angles of a whole turn, the last axis, `lag` (rad) of crank later.

    The lag is rounded to whole samples.
    """
    return np.roll(curve, round(curve.shape[-1] * lag / (2 * math.pi)), axis=-1)


def all_legs(curve: FloatArray, legs: int = 2) -> FloatArray:
    """Sum over so many legs that all do what one of them does over its own crank angle; curve: as for `delayed`."""
    return np.asarray(sum(delayed(curve, leg.lag) for leg in LEGS[legs]))
