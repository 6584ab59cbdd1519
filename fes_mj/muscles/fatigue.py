"""Fatigue: force falls with activation towards a floor, and comes back without it.

d(factor)/dt = (FLOOR - factor) a / FALL + (1 - factor) (1 - a) / recovery (Riener et al., J. Biomech. 29 (1996)
1157-1167, doi:10.1016/0021-9290(96)00012-7), with the activation a. A turn is short beside both times, so that the mean
activation over it counts; how activation follows stimulation stays (Sinclair et al. 2004).
"""

from typing import Any

import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.muscles.power import MuscleTurn

FLOOR = 0.2  # of the fresh force, which is left under activation that never ends
FALL, RECOVERY = 30.0, 50.0  # s
# What paralysed quadriceps keep after 180 contractions at half the time: -67 % (Bickel et al., JRRD 41 (2004) 33).
LEFT, AT = 0.33, 0.5
HALF_AN_HOUR = 1800.0  # s


def force_factor(activation: Any, time: Any, recovery: Any = RECOVERY, fall: Any = FALL) -> FloatArray:
    """Force per fresh force after a time (s) at a mean activation, of shapes that broadcast; recovery, fall: s."""
    falling, rising = np.asarray(activation) / fall, (1 - np.asarray(activation)) / recovery
    rate = falling + rising
    end = (FLOOR * falling + rising) / rate
    return np.asarray(end + (1 - end) * np.exp(-rate * np.asarray(time)))


def recovery_for(factor: float, activation: float) -> float:
    """Time constant of the recovery, s, with which this much force is left in the end at a mean activation."""
    return FALL * (1 - factor) * (1 - activation) / ((factor - FLOOR) * activation)


def recoveries() -> dict[str, float]:
    """Time constants of recovery, s: as published, and as it takes for what was measured."""
    return {"published": RECOVERY, "as Bickel measured": recovery_for(LEFT, AT)}


def power_over_time(turn: MuscleTurn, time: FloatArray, recovery: float = RECOVERY) -> FloatArray:
    """Mean crank power of one leg after a time (s) of pedalling at one cadence, W, shape (times, members, designs)."""
    factor = force_factor(turn.activation.mean(axis=-1), time[:, None, None, None], recovery)
    return np.asarray(np.einsum("tgmd,gmd->tmd", factor, turn.group_power))
