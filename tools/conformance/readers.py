"""The tools that read exported models, and what each can be held to."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

Answer = dict[str, Any]


@dataclass(frozen=True)
class Reader:
    """A tool that reads MJCF, and what it can be held to.

    beside: which of MuJoCo's accelerations its own are compared with: `acceleration`; `without_velocity_term`, if its
    loops do not know dJ/dt v; or `near_rigid`, if they are regularised as well. acceleration: limit in rad/s^2 from the
    reference answer. pedal: limit in m. without: motions that it does not know, and why. still: motions that it is only
    asked to begin. most: steps that it is asked for, where it is slow. parts: into how many its time steps are cut.
    """

    title: str
    anchors: str
    beside: str
    acceleration: Callable[[Answer], float]
    pedal: Callable[[Answer], float]
    reason: str
    requirements: tuple[str, ...] = ()  # where they are not a dependency group of this project
    without: dict[str, str] = field(default_factory=dict)
    still: tuple[str, ...] = ()
    most: int | None = None
    parts: int = 1


def _rounding(dtype: type[np.floating[Any]]) -> Callable[[Answer], float]:
    """A loop's two sides are rounded near 1 m; its stiffness makes an acceleration of that, and the linkage a turn."""
    return lambda reference: 2 * float(np.finfo(dtype).eps) * reference["stiffness"] * reference["loop_gain"]


def _softness(factor: float) -> Callable[[Answer], float]:
    return lambda reference: factor * float(reference["softness_change"])


def _regularisation(reference: Answer) -> float:
    """Half of what it changes: it is estimated loop by loop, without the effect of one loop on another."""
    return float(reference["near_rigid_change"]) / 2


def _steps(reference: Answer) -> float:
    """What an integrator of first order may err by, twice: each by about twice its change from half the step."""
    return 4 * float(reference["step_change"])


def _rounded_steps(reference: Answer) -> float:
    """And every step rounds a pose near 1 m to single precision."""
    return _steps(reference) + FEW * float(np.finfo(np.float32).eps)


FEW = 200  # steps, for a reader that takes 30 to 60 ms for one
READERS = {
    "mujoco": Reader(
        "MuJoCo",
        "sites",
        "acceleration",
        lambda _: 0.0,
        lambda _: 0.0,
        "the reference: another process must find the very same",
    ),
    "mjx": Reader(
        "MJX",
        "sites",
        "without_velocity_term",
        _rounding(np.float64),
        _steps,
        "loops without dJ/dt v, otherwise MuJoCo's equations in double precision; no `discrete` integrator",
        without={"ride": "leaves out air resistance, a damping that grows with the speed"},
        still=("two legs",),  # each motion takes it a minute to compile
        parts=2,  # without dJ/dt v RK4 is of third order: at the model's step D2 loses 0.4 % of its energy in 0.5 s
    ),
    "warp": Reader(
        "MuJoCo Warp",
        "sites",
        "without_velocity_term",
        _rounding(np.float32),
        _rounded_steps,
        "loops without dJ/dt v; single precision, whose rounding the stiff loops turn into accelerations",
        most=FEW,
    ),
    "pinocchio": Reader(
        "Pinocchio",
        "sites",
        "acceleration",
        _softness(2),
        _steps,
        "rigid loops, where MuJoCo's give way a little; it has no simulator",
        without={"ride": "drops the tendon that couples road and crank", "motors": "drops motors"},
    ),
    "drake": Reader(
        "Drake",
        "bodies",
        "near_rigid",
        _regularisation,
        _steps,
        "loops that hold the velocity of the next step, as soft as its regularisation makes them; it drops loops "
        "anchored at sites",
        without={"ride": "refuses air resistance, a damping that grows with the speed"},
    ),
    "dm_control": Reader(
        "dm_control",
        "sites",
        "acceleration",
        _rounding(np.float64),
        lambda _: 1e-9,
        "the same engine, but it needs MuJoCo below 4",
        ("dm-control==1.0.50", "mujoco==3.17.0"),
    ),
}
