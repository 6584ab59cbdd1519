"""Free riding without MuJoCo: the reduced equation of motion, integrated from event to event.

Crank angle a with speed w, and the tricycle's speed v, which recoils with the legs. With the kinetic energy
I(a) w^2 / 2 - X(a) w v + m v^2 / 2, where X = sum of m dx/da over both legs' bodies, and their potential energy V(a),

    I w' - X v' = Q - V'(a) - I'(a) w^2 / 2 - T        (crank)
    m v' - X w' = X'(a) w^2 - F(v) + T / c             (tricycle)

Q is the virtual work of the joint moments, F the road's force and T the moment that the transmission takes from the
crank. A fixed gear keeps v = c w. A freewheel does while T is positive, and otherwise lets v run ahead of c w with
T = 0: no impact, no memory. Rolling resistance is dry friction: it holds a tricycle that stands.
"""

import math
from functools import lru_cache
from typing import Any

import numpy as np

from fes_mj.common.arrays import BoolArray, FloatArray
from fes_mj.common.errors import UnstableError
from fes_mj.linkage.design import Design
from fes_mj.linkage.inertia import CrankInertia, crank_inertia
from fes_mj.linkage.joints import JOINTS
from fes_mj.linkage.legs import TWO_LEGS, delayed
from fes_mj.linkage.segments import GRAVITY
from fes_mj.moments.drive import POINTS, drive
from fes_mj.moments.joint_moments import JointMoments
from fes_mj.riding import solver
from fes_mj.riding.ride import Ride, Trace
from fes_mj.riding.solver import (
    AHEAD,
    ANGLE,
    BEHIND,
    COMMANDS,
    CRANK,
    DISTANCE,
    INERTIA,
    MUSCLE_WORK,
    MUSCLES,
    RATES,
    RECOIL,
    ROAD_WORK,
    ROWS,
    SPEED,
    STATE,
    WORK,
)
from fes_mj.statics.extrapolation import turning_in_range

_BISECTIONS = 40  # of the energy: what is left of the interval is rounding
MOST_ROWS = 2**21  # an hour of fast riding; beyond it something is wrong


@lru_cache(maxsize=32)
def leg_table(design: Design, moments: JointMoments, lag: float = 0.0) -> FloatArray:
    """What the equation of motion must know at each crank angle, shape (POINTS + 1, 15): a turn and its first row.

    I (kg m^2) and dI/da, X (kg m) and dX/da, sum of m dy/da (kg m) of both legs; joint rates per crank speed and joint
    moments commanded (N m, Drive.command) of knee and hip of the first leg, then of the other; AHEAD and BEHIND.
    """
    columns, breaks = np.zeros((POINTS, BEHIND + 1)), np.zeros(POINTS, bool)
    for number, leg in enumerate(TWO_LEGS):
        told = drive(design, moments.of_leg(leg.prefix), lag)
        for column, curve in enumerate(crank_inertia(told.motion)):
            columns[:, column] += delayed(curve, leg.lag)
        for place, joint in enumerate(JOINTS, len(JOINTS) * number):
            columns[:, RATES + place] = delayed(told.motion.joint_rate[joint], leg.lag)
            columns[:, COMMANDS + place] = delayed(told.command[joint], leg.lag)
        breaks |= delayed(told.breaks, leg.lag)
    columns[:, AHEAD], columns[:, BEHIND] = _next_breaks(breaks)
    table = np.vstack([columns, columns[:1]])
    table.setflags(write=False)
    return table


def _next_breaks(breaks: BoolArray) -> tuple[FloatArray, FloatArray]:
    """Crank angles of the first break beyond the cells beside each row, ahead and behind, rad."""
    cells = np.flatnonzero(breaks)
    around = np.concatenate([cells - POINTS, cells, cells + POINTS])
    rows, cell = np.arange(POINTS), 2 * np.pi / POINTS
    ahead, behind = np.searchsorted(around, rows, "right"), np.searchsorted(around, rows, "left") - 1
    return cell * (around[ahead] + 0.5), cell * (around[behind] + 0.5)


def ride(ride: Ride, compiled: bool = False) -> Trace:
    """Ride without MuJoCo.

    compiled: in machine code, which takes seconds to make and pays from some ten rides on. Raises InputError for a
    linkage that does not turn and for joints that never enter the moments' range, MissingPartError without numba.
    """
    for leg in TWO_LEGS:
        turning_in_range(ride.design, ride.moments.of_leg(leg.prefix).measured_on)
    table, constants = leg_table(ride.design, ride.moments, ride.lag), solver.constants(ride)
    advance = solver.compiled() if compiled else solver.interpreted()
    columns: Any = table if compiled else solver.as_floats(table)
    blank: Any = np.zeros(STATE) if compiled else [0.0] * STATE
    state, work = blank.copy(), tuple(blank.copy() for _ in range(WORK))
    state[ANGLE], state[CRANK], state[SPEED] = ride.start, ride.launch / ride.travel, ride.launch
    blocks, engaged, way, clock, begin = [], 1, 0, 0.0, True
    while clock < ride.duration:
        rows = np.empty((ROWS, STATE + 2))
        count, clock, engaged, way = advance(columns, constants, state, clock, engaged, way, begin, work, rows)
        blocks.append(rows[:count])
        begin = False
        if len(blocks) * ROWS > MOST_ROWS or not math.isfinite(state[SPEED]):
            raise UnstableError(f"{ride.name}: the reduced equation of motion could not be integrated")
    rows = np.vstack(blocks)
    return Trace(
        ride=ride,
        time=rows[:, 0],
        crank_angle=rows[:, 2 + ANGLE],
        crank_speed=rows[:, 2 + CRANK],
        distance=rows[:, 2 + DISTANCE],
        speed=rows[:, 2 + SPEED],
        coasting=rows[:, 1] == 0,
        muscle_work=rows[:, 2 + MUSCLE_WORK],
        road_work=rows[:, 2 + ROAD_WORK],
    )


def gained_power(trace: Trace) -> float | None:
    """Rate at which kinetic energy grows over the last whole turns, W; height returns. None without any turn."""
    ride = trace.ride
    row = leg_table(ride.design, ride.moments, ride.lag)[
        int(trace.crank_angle[-1] % (2 * np.pi) * POINTS / (2 * np.pi))
    ]
    crank, speed = (np.array(trace.ends(column)) for column in (trace.crank_speed, trace.speed))
    kinetic = (row[INERTIA] * crank**2 + ride.load.inertia * speed**2) / 2 - row[RECOIL] * crank * speed
    began, ended = trace.ends(trace.time)
    return float(kinetic[1] - kinetic[0]) / (ended - began) if trace.whole_turns else None


def steady_ripple(ride: Ride) -> float:
    """Largest less smallest crank speed per its mean, once a fixed gear rides evenly at the ride's launch speed.

    Against a constant force that takes the mean power, and with moments as they are at rest; see even_ripple.
    """
    table = leg_table(ride.design, ride.moments, ride.lag)[:-1]
    muscles = np.arange(MUSCLES)
    drive = (table[:, RATES + muscles] * table[:, COMMANDS + muscles]).sum(axis=1)
    return float(even_ripple(ride, drive, CrankInertia(*table[:, :RATES].T)))


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
