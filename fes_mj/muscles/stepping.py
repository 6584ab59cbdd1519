"""One leg's stimulator and muscles, stepped through time: what they do in a simulation, by its own joint angles."""

from collections import deque
from collections.abc import Callable, Sequence
from typing import NamedTuple, TypeAlias

from fes_mj.muscles.anatomy import GROUPS
from fes_mj.muscles.instant import LegMuscles, activated, weights

# Crank, knee and hip angle, rad, speeds of knee and hip, rad/s -> stimulation of each group that the muscles are asked
# for there and then.
Stimulator: TypeAlias = Callable[[float, float, float, float, float], Sequence[float]]
_SETTLED = 1e-7  # of an activation, by which a turn may end beside where it began


class Memory(NamedTuple):
    """What the muscles of a leg know of the steps before: stimulation on its way, the last that arrived, activation."""

    asked: tuple[Sequence[float], ...]
    arrived: Sequence[float]
    activation: tuple[float, ...]


class MuscleStepper:
    """Activation of the groups of a leg from step to step.

    Stimulation arrives `leg.delay` after it was asked for, between two steps as a straight line between both.
    """

    def __init__(self, leg: LegMuscles, timestep: float, memory: Memory | None = None) -> None:
        """memory: by default that of muscles at rest."""
        steps = leg.delay / timestep
        self._part, self._rising, self._falling = steps % 1, weights(timestep, leg.rise), weights(timestep, leg.fall)
        rest = (0.0,) * len(GROUPS)
        memory = memory or Memory((rest,) * (int(steps) + 2), rest, rest)
        self._asked = deque(memory.asked, maxlen=len(memory.asked))
        self._arrived, self.activation = memory.arrived, memory.activation

    @property
    def memory(self) -> Memory:
        """From which another stepper goes on."""
        return Memory(tuple(self._asked), self._arrived, self.activation)

    def advance(self, asked: Sequence[float]) -> tuple[float, ...]:
        """Activation of each group a step later, where this stimulation is asked for."""
        self._asked.append(asked)
        part, before = self._part, self._arrived
        self._arrived = [part * old + (1 - part) * new for old, new in zip(self._asked[0], self._asked[1], strict=True)]
        self.activation = tuple(
            activated(*state, self._rising, self._falling)
            for state in zip(self.activation, before, self._arrived, strict=True)
        )
        return self.activation


def steady(leg: LegMuscles, timestep: float, turn: Sequence[Sequence[float]]) -> Memory:
    """What muscles remember at the end of a turn that has always been the same.

    turn: stimulation that is asked for in each of its steps.
    """
    stepper, before = MuscleStepper(leg, timestep), (1.0,) * len(GROUPS)
    while max(abs(one - other) for one, other in zip(stepper.activation, before, strict=True)) > _SETTLED:
        before = stepper.activation
        for asked in turn:
            stepper.advance(asked)
    return stepper.memory
