"""Predictions, as in cranking.py, of rides on a road."""

from collections.abc import Sequence

import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.common.units import KMH
from fes_mj.moments.files import load_moments, sampled_moments
from fes_mj.moments.joint_moments import JointMoments
from fes_mj.muscles.fatigue import power_over_time
from fes_mj.muscles.power import best_turn
from fes_mj.muscles.riders import Riders
from fes_mj.riding.ride import Ride
from fes_mj.riding.stimulated import StimulatedRider
from fes_mj.riding.trace import ride
from fes_mj.validation.cranking import TRICYCLE, CrankingSetup

_SPEEDS = np.linspace(1.0, 31.0, 13)  # km/h, between which the surplus of power is interpolated
_RIDES = 10  # of a rider group, with either transmission


def speed(riders: Riders, setup: CrankingSetup) -> FloatArray:
    """At which the muscles' power, after `minutes` of fatigue, is what a level road takes, km/h; 0 where it never is.

    A steady crank: what a ride loses by not being one is left out.
    """
    ride, surplus = Ride(TRICYCLE, load_moments()), []
    for speed in _SPEEDS * KMH:
        cadence = speed / ride.travel
        turn, _ = best_turn(riders, TRICYCLE, cadence)
        power = power_over_time(turn, np.array([60 * setup["minutes"]]))[0, :, 0]
        surplus.append(2 * power - (ride.load.rolling + ride.load.drag * speed**2) * speed)
    left_over = np.array(surplus)
    last = len(_SPEEDS) - 2 - (left_over[:-1] > 0)[::-1].argmax(axis=0)  # beyond it there is none left
    rows = np.arange(len(riders))
    before, after = left_over[last, rows], left_over[last + 1, rows]
    reached = _SPEEDS[last] + (_SPEEDS[1] - _SPEEDS[0]) * before / (before - after)
    return np.where((left_over > 0).any(axis=0), reached, 0.0)


def _farther(drives: Sequence[JointMoments | StimulatedRider]) -> FloatArray:
    """By how much faster each settles on the flat with a fixed gear than with a freewheel, %, shape (drives,)."""

    def speed(transmission: str) -> FloatArray:
        rides = (Ride(TRICYCLE, drive, transmission=transmission) for drive in drives)
        return np.array([ride(one).mean_speed or 0.0 for one in rides])

    return 100 * (speed("fixed") / speed("freewheel") - 1)


def farther_in_fixed_gear(riders: Riders, setup: CrankingSetup) -> FloatArray:
    """By how much faster the standard tricycle settles with a fixed gear than with a freewheel, a few riders, %.

    Distance till exhaustion grows as speed does if a rider tires by the time of stimulation.
    """
    cadence = TRICYCLE.linkage.cadence
    _, windows = best_turn(riders, TRICYCLE, cadence)
    few = np.linspace(0, len(riders) - 1, _RIDES).astype(int)
    return _farther([StimulatedRider(riders.taken([row]), windows, cadence) for row in few])


def farther_by_moments(riders: Riders, setup: CrankingSetup) -> FloatArray:
    """The same by recovered moments that may be."""
    return _farther(sampled_moments(riders.name, _RIDES))
