"""How far two rides are apart, and how much of the muscles' work a ride may lose before its speed changes."""

import math
from dataclasses import replace
from functools import lru_cache

import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.common.checks import LEAST_POWER
from fes_mj.riding.trace import LEAST_ADVANCE, Trace, ride as ride_by_equation

DISTANCES = 2000  # at which two speeds are compared
LOSS = 1e-4  # of the work, that is taken from a ride to see what becomes of it


def speed_difference(one: Trace, other: Trace) -> float:
    """Root mean square difference of the tricycle's kinetic energy at equal distances, per twice that mean energy.

    In a steady ride that is the relative difference of the speeds. Where a tricycle stops, energies at equal distances
    differ by as little as before, speeds by the root of it. Distances are those that both reach; speeds at equal times
    would differ by what little one is ahead. Of rides that came nowhere there is nothing to compare.
    """
    reach = min(float(trace.distance.max()) for trace in (one, other))
    if reach < LEAST_ADVANCE:
        return 0.0
    at = np.linspace(0, reach, DISTANCES)
    mine, theirs = (_speed_squared(trace, at) for trace in (one, other))
    return math.sqrt(float(np.mean((mine - theirs) ** 2))) / (2 * float(np.mean(theirs)))


def _speed_squared(trace: Trace, distance: FloatArray) -> FloatArray:
    """Of the tricycle when it first comes to these distances, m^2/s^2."""
    farthest = np.maximum.accumulate(trace.distance)
    first = np.concatenate([[True], np.diff(farthest) > 0])
    return np.asarray(np.interp(distance, farthest[first], trace.speed[first] ** 2))


def work_scale(trace: Trace) -> float:
    """Work of a ride that losses are compared with, J: the muscles', and at least that of LEAST_POWER."""
    return max(float(np.ptp(trace.muscle_work)), LEAST_POWER * float(trace.time[-1]))


@lru_cache(maxsize=1)
def sensitivity(trace: Trace) -> float:
    """Relative change of a ride's speed (speed_difference) per part of its work that something takes from it.

    By riding again, by the reduced equation of motion, with so much more rolling resistance.
    """
    ride, way = trace.ride, float(np.abs(np.diff(trace.distance)).sum())
    if not way:
        return 0.0
    resistance = LOSS * work_scale(trace) / way / (ride.load.weight * math.cos(ride.road.angle))
    braked = replace(ride.road, rolling_resistance=ride.road.rolling_resistance + resistance)
    return speed_difference(ride_by_equation(replace(ride, road=braked)), trace) / LOSS
