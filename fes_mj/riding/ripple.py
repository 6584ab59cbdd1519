"""How evenly a fixed gear rides: the ripple of the crank speed on a tricycle, in closed form."""

import math

import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.linkage.inertia import CrankInertia
from fes_mj.linkage.segments import GRAVITY
from fes_mj.riding.ride import Ride

_BISECTIONS = 40  # of the energy: what is left of the interval is rounding


def steady_ripple(ride: Ride) -> float:
    """Largest less smallest crank speed per its mean, once a fixed gear rides evenly at the ride's launch speed.

    Against a constant force that takes the mean power, and with moments as they are at rest; see even_ripple.
    """
    table = ride.table
    drive = (table.joint_rate * table.command).sum(axis=0)
    turn = slice(-1)
    return float(even_ripple(ride, drive[turn], CrankInertia(*(curve[turn] for curve in table.masses))))


def even_ripple(ride: Ride, drive: FloatArray, legs: CrankInertia) -> FloatArray:
    """The ripple of steady_ripple, of a ride or of a batch of designs.

    drive: virtual work of the moments of both legs, N m, over uniform crank angles of a turn, last axis. legs:
    masses of both, over the same. The energy at a crank angle is an integral up to it:
    I_t(a) w^2 / 2 = E + integral of Q - V' less their mean, I_t = I - 2 c X + m c^2, and E what gives the mean speed.
    """
    load, travel, road = ride.load, ride.travel, ride.road.angle
    push = drive - GRAVITY * (math.cos(road) * legs.height_rate - math.sin(road) * legs.recoil)
    inertia = legs.inertia - 2 * travel * legs.recoil + travel**2 * load.inertia
    cadence = ride.launch / travel
    step = 2 * np.pi / push.shape[-1]
    push = push - push.mean(axis=-1, keepdims=True)
    surplus = (np.cumsum(push, axis=-1) - push / 2) * step  # by trapezoids, up to a constant
    low = -surplus.min(axis=-1, keepdims=True) * (1 + 1e-9) + 1e-12
    high = low + inertia.max(axis=-1, keepdims=True) * cadence**2 + np.ptp(surplus, axis=-1, keepdims=True)
    for _ in range(_BISECTIONS):
        energy = (low + high) / 2
        speed = np.sqrt(2 * (energy + surplus) / inertia)
        slow = np.mean(1 / speed, axis=-1, keepdims=True) * cadence > 1  # the mean over time
        low, high = np.where(slow, energy, low), np.where(slow, high, energy)
    return np.asarray(np.ptp(speed, axis=-1, keepdims=True) / cadence)[..., 0]
