"""What a turn of any design is like beside its mean power: evenness of the power, transmission, size.

All along the last axis: arrays of a single turn have shape (angles,), those of a batch (designs, angles).
"""

from functools import reduce
from typing import Any

import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.linkage.assembly import transmission_angles
from fes_mj.linkage.kinematics import Motion


def inactive_share(power: FloatArray) -> Any:
    """Share of the turn with negative power: where the muscles of one leg take power from the crank."""
    return np.mean(power < 0, axis=-1)


def energy_swing(power: FloatArray, cadence: Any) -> Any:
    """Largest less smallest energy stored over the turn, J, when the load takes the mean of `power` (whole turns)."""
    seconds = 2 * np.pi / cadence / power.shape[-1]
    return np.ptp(np.cumsum(power - power.mean(axis=-1, keepdims=True), axis=-1), axis=-1) * seconds


def energy_fluctuation(power: FloatArray, turns: int = 1) -> Any:
    """Coefficient of fluctuation of energy: energy_swing per work of a turn; power: W or N m, over so many turns."""
    mean = np.abs(power.mean(axis=-1))
    # at one turn a second the mean power is the work of a turn
    return turns * energy_swing(power, 2 * np.pi) / np.where(mean > 0, mean, np.nan)


def extent(motion: Motion) -> tuple[Any, Any]:
    """Length and height of the box around all joints over the turn, m."""
    points = np.stack(np.broadcast_arrays(*(jet.value for jet in motion.points.values())))
    return np.ptp(points.real, axis=(0, -1)), np.ptp(points.imag, axis=(0, -1))


def power_characteristics(power: FloatArray, turns: int = 1) -> dict[str, Any]:
    """Of crank power over so many whole turns, W, as JSON names and units it.

    The last two say nothing without a positive mean: NaN.
    """
    mean, highest = power.mean(axis=-1), power.max(axis=-1)
    positive = np.where(mean > 0, mean, np.nan)
    return {
        "inactive_zone_share": inactive_share(power),
        "power_peak_to_peak_W": highest - power.min(axis=-1),
        "power_peak_to_mean": highest / positive,
        "energy_fluctuation": np.where(mean > 0, energy_fluctuation(power, turns), np.nan),
    }


def motion_characteristics(motion: Motion) -> dict[str, Any]:
    """Of a motion over a turn, as JSON names and units it: smallest transmission angle of any dyad, box of joints."""
    length, height = extent(motion)
    smallest = reduce(np.minimum, transmission_angles(motion).values())
    return {"transmission_angle_min_deg": smallest, "length_m": length, "height_m": height}
