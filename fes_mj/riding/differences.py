"""How far two rides are apart, and with what their errors are compared."""

import math

import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.common.checks import LEAST_POWER
from fes_mj.riding.trace import LEAST_ADVANCE, Trace

DISTANCES = 2000  # at which two speeds are compared


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
    """Of the tricycle when it first comes to these distances, m^2/s^2, between the two samples there."""
    after = np.searchsorted(np.maximum.accumulate(trace.distance), distance)
    before = np.maximum(after - 1, 0)  # not the farthest so far: it may have rolled back since
    near, far = trace.distance[before], trace.distance[after]
    part = (distance - near) / np.where(far > near, far - near, 1.0)
    slow, fast = trace.speed[before] ** 2, trace.speed[after] ** 2
    return np.asarray(slow + part * (fast - slow))


def work_scale(trace: Trace) -> float:
    """Work of a ride that losses are compared with, J: the muscles', and at least that of LEAST_POWER."""
    return max(float(np.ptp(trace.muscle_work)), LEAST_POWER * float(trace.time[-1]))
