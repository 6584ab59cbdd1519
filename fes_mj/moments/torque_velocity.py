"""How a joint's moment changes with its speed: Hill's hyperbola. Off by default, as in the paper."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cache
from typing import Any

import numpy as np

from fes_mj.common.reading import DATA, read_toml
from fes_mj.linkage.joints import JOINTS

_NUMBERS = ("curvature", "eccentric_plateau")


@dataclass(frozen=True)
class TorqueVelocity:
    """Moment at a joint speed per moment at rest, by one muscle for the joint.

    curvature: Hill's a / F0. eccentric_plateau: moment of fast lengthening. max_speed: by joint, rad/s, at which
    nothing is left of a shortening muscle's moment. Of a batch (stacked) arrays of shape (relations, 1).
    """

    name: str
    curvature: float
    eccentric_plateau: float
    max_speed: dict[str, float]

    def factor(self, joint: str, speed: Any) -> Any:
        """Moment per moment at rest; speed: rad/s along the moment, negative as the muscle lengthens."""
        return hill_factor(self.curvature, self.eccentric_plateau, speed / self.max_speed[joint])

    def taken(self, rows: Any) -> "TorqueVelocity":
        """The relations of a batch at `rows` (an index array)."""
        numbers: dict[str, Any] = {name: np.asarray(getattr(self, name))[rows] for name in _NUMBERS}
        speeds: Any = {joint: np.asarray(speed)[rows] for joint, speed in self.max_speed.items()}
        return replace(self, max_speed=speeds, **numbers)


def hill_factor(curvature: float, eccentric_plateau: float, speed: Any) -> Any:
    """Hill (1938) while shortening, a hyperbola of the same slope at rest while lengthening (negative speed).

    speed: per the largest, beyond which nothing is left. For arrays, floats and machine code alike.
    """
    shortening, lengthening = (abs(speed) + speed) / 2, (abs(speed) - speed) / 2
    excess = eccentric_plateau - 1
    steepness = (1 + 1 / curvature) / excess
    concentric = (1 - shortening) / (1 + shortening / curvature)
    return (concentric + abs(concentric)) / 2 + excess * (1 - 1 / (1 + steepness * lengthening))


# No dependence on speed, as a relation: muscles that are infinitely fast.
AT_ANY_SPEED = TorqueVelocity("none", 1.0, 2.0, {"knee": np.inf, "hip": np.inf})


@cache
def load_torque_velocity(name: str) -> TorqueVelocity:
    """A relation ("hill") with its parameters of data/torque_velocity.toml."""
    row = _row(name)
    return TorqueVelocity(name, row["curvature"], row["eccentric_plateau"], row["max_speed_rad_s"])


def drawn_relations(name: str, count: int, seed: int) -> list[TorqueVelocity]:
    """Relations drawn from the prior on parameters and shape of the one with this name."""
    random, prior, best = np.random.default_rng(seed), _row(name)["prior"], load_torque_velocity(name)
    relations = []
    for faster, flatter, *even in zip(*random.standard_normal((2, count)), *random.random((3, count)), strict=True):
        factor = math.exp(prior["max_speed_log_sd"] * faster)
        curvature = best.curvature * math.exp(prior["curvature_log_sd"] * flatter)
        if even[1] < prior["straight_share"]:
            factor = math.radians(_between(prior["straight_end_deg_s"], even[2])) / best.max_speed["knee"]
            curvature = math.inf  # Hill's hyperbola is straight then
        speeds = {joint: factor * speed for joint, speed in best.max_speed.items()}
        relations.append(TorqueVelocity(name, curvature, _between(prior["eccentric_plateau"], even[0]), speeds))
    return relations


def stacked(relations: Sequence[TorqueVelocity]) -> TorqueVelocity:
    """A batch of relations: its numbers are arrays of shape (relations, 1)."""
    numbers: dict[str, Any] = {
        name: np.array([[getattr(relation, name)] for relation in relations]) for name in _NUMBERS
    }
    speeds: Any = {joint: np.array([[relation.max_speed[joint]] for relation in relations]) for joint in JOINTS}
    return replace(relations[0], max_speed=speeds, **numbers)


def _between(ends: list[float], part: float) -> float:
    return ends[0] + part * (ends[1] - ends[0])


def _row(name: str) -> dict[str, Any]:
    path = DATA / "torque_velocity.toml"
    return read_toml(path, "torque-velocity relations").section(name).content
