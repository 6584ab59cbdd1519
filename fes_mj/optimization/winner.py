"""What a found design is worth: simulated, compared with the design it had to beat, sampled for tolerance."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fes_mj.design import Design
from fes_mj.optimization.confidence import Gain
from fes_mj.optimization.cycles import WorkTable, cycles, joint_speeds
from fes_mj.optimization.tolerance import Tolerance, to_manufacturing, to_rider
from fes_mj.statics import quasi_static
from fes_mj.torque import JointMoments
from fes_mj.uncertainty import difference_sd

if TYPE_CHECKING:
    from fes_mj.crosscheck import CrossCheck


@dataclass(frozen=True)
class Winner:
    """A design with everything that was found out about it.

    speeds: mean absolute joint speed, deg/s. reversals: of each joint in a turn. gain: over `rival` under the same
    moments, None for moments without error bars.
    """

    design: Design
    rival: Design
    check: CrossCheck
    speeds: dict[str, float]
    reversals: dict[str, int]
    gain: Gain | None
    manufacturing: Tolerance
    rider: Tolerance


def assess(design: Design, rival: Design, moments: JointMoments, seed: int = 0) -> Winner:
    """Simulate a design against statics, compare it with a rival, sample its tolerances."""
    from fes_mj.crosscheck import refined_cross_check

    table, random = WorkTable.of(moments), np.random.default_rng(seed)
    turn = cycles(design, table)
    return Winner(
        design=design,
        rival=rival,
        check=refined_cross_check(design, moments),
        speeds=joint_speeds(design, table),
        reversals={joint: int(count[0]) for joint, count in turn.reversals.items()},
        gain=gain_over(design, rival, moments),
        manufacturing=to_manufacturing(design, table, random),
        rider=to_rider(design, table, random),
    )


def gain_over(design: Design, rival: Design, moments: JointMoments) -> Gain | None:
    """Power gained over a rival, each at its own cadence; None for moments whose error is not known."""
    own, other = quasi_static(design, moments), quasi_static(rival, moments)
    deviation = difference_sd(own, other)
    return None if deviation is None else Gain(own.power_mean - other.power_mean, deviation)
