"""One leg's stimulator and muscles, stepped through time: what they do in a simulation, by its own joint angles."""

import math
from collections import deque
from collections.abc import Callable, Sequence
from itertools import pairwise, repeat
from typing import NamedTuple, TypeAlias

from fes_mj.muscles.instant import LegMuscles, activated, weights

# Crank, knee and hip angle, rad, speeds of knee and hip, rad/s -> stimulation of each group that the muscles are asked
# for there and then.
StimulusLaw: TypeAlias = Callable[[float, float, float, float, float], Sequence[float]]
_SETTLED = 1e-9  # of an activation, by which a turn may end beside where it began


class MuscleMemory(NamedTuple):
    """What the muscles of a leg know of the steps before: stimulation on its way, the last that arrived, activation."""

    asked: tuple[Sequence[float], ...]
    arrived: Sequence[float]
    activation: tuple[float, ...]


class MuscleStepper:
    """Activation of the groups of a leg from step to step.

    Stimulation arrives `leg.delay` after it was asked for, between two steps as a straight line between both.
    """

    def __init__(self, leg: LegMuscles, timestep: float, memory: MuscleMemory) -> None:
        _, self._part = _delay(leg, timestep)
        self._rising, self._falling = weights(timestep, leg.rise), weights(timestep, leg.fall)
        self._asked = deque(memory.asked, maxlen=len(memory.asked))
        self._arrived, self.activation = memory.arrived, memory.activation

    def advance(self, asked: Sequence[float]) -> tuple[float, ...]:
        """Activation of each group a step later, where this stimulation is asked for."""
        self._asked.append(asked)
        part, before = self._part, self._arrived
        self._arrived = [part * old + (1 - part) * new for old, new in zip(self._asked[0], self._asked[1], strict=True)]
        self.activation = tuple(
            map(activated, self.activation, before, self._arrived, repeat(self._rising), repeat(self._falling))
        )
        return self.activation


def _delay(leg: LegMuscles, timestep: float) -> tuple[int, float]:
    """Of the stimulation: whole steps, and a part of one."""
    steps = leg.delay / timestep
    return int(steps), steps % 1


def steady(leg: LegMuscles, timestep: float, turn: Sequence[Sequence[float]], start: Sequence[float]) -> MuscleMemory:
    """What muscles remember at the end of a turn that has always been the same.

    turn: stimulation that is asked for in each of its steps. start: activation, as well as it is known; it saves turns.
    """
    whole, part = _delay(leg, timestep)
    rising, falling = weights(timestep, leg.rise), weights(timestep, leg.fall)
    count, arrived, activation = len(turn), [], []
    for value, *asked in zip(
        start, *turn, strict=True
    ):  # group after group: a fifth of the time of a stepper's own steps
        late = [asked[(row - whole - 1) % count] for row in range(count + 1)]
        felt = [part * old + (1 - part) * new for old, new in pairwise(late)]
        before = math.inf
        while abs(value - before) > _SETTLED:
            before = value
            for earlier, now in pairwise([felt[-1], *felt]):
                value = activated(value, earlier, now, rising, falling)
        arrived.append(felt[-1])
        activation.append(value)
    return MuscleMemory(tuple(turn[row % count] for row in range(-whole - 2, 0)), arrived, tuple(activation))
