"""The steps of a ride by the reduced equation of motion (fes_mj.riding.reduced), interpreted or in machine code."""

import math
from collections.abc import Callable
from functools import cache
from typing import Any

from fes_mj.common.arrays import FloatArray
from fes_mj.common.errors import require_extra
from fes_mj.linkage.segments import GRAVITY
from fes_mj.moments.drive import POINTS
from fes_mj.moments.torque_velocity import AT_ANY_SPEED, hill_factor
from fes_mj.riding.ride import Ride

# A step: so much of the crank, running free or engaged with the tricycle's inertia behind it, or of the time where it
# is slow. A quarter of it changes the speed of the paper's designs after a minute by less than 1e-4 of itself.
STEP_ANGLES, STEP_TIME = (math.radians(1.0), math.radians(2.0)), 0.008  # rad, s
TOUCH = 1e-12  # m/s: rounding, by which a crank that has just caught up may be too fast or too slow
HALVINGS = 30  # of a step, to find an event in it
ROWS = 4096  # samples that are made before Python looks at them

# Columns of the table over crank angle: of both legs together, then by leg and joint.
INERTIA, INERTIA_RATE, RECOIL, RECOIL_RATE, HEIGHT_RATE, RATES, COMMANDS = 0, 1, 2, 3, 4, 5, 9
AHEAD, BEHIND = 13, 14  # the next crank angles at which the moments break, rad
MUSCLES = 4  # knee and hip of the first leg, then of the other
# Components of the state; the muscles' answers follow.
ANGLE, CRANK, DISTANCE, SPEED, MUSCLE_WORK, ROAD_WORK, ANSWERS = 0, 1, 2, 3, 4, 5, 6
STATE = ANSWERS + MUSCLES
WORK = 8  # vectors that the solver works with


def constants(ride: Ride) -> tuple[float, ...]:
    """What the solver must know of a ride beside the table."""
    load, relation = ride.load, ride.moments.torque_velocity
    hill = relation or AT_ANY_SPEED
    return (
        float(ride.fixed),
        ride.travel,
        load.inertia,
        load.rolling,
        load.climb,
        load.drag,
        GRAVITY * math.cos(ride.road.angle),
        GRAVITY * math.sin(ride.road.angle),
        ride.lag,
        ride.moments.measured_on.cadence,
        hill.curvature,
        hill.eccentric_plateau,
        hill.max_speed["knee"],
        hill.max_speed["hip"],
        ride.duration,
    )


def as_floats(table: FloatArray) -> list[tuple[float, ...]]:
    """The table for Python, which reads plain numbers ten times faster than an array's."""
    return [tuple(row) for row in table.tolist()]


@cache
def interpreted() -> Callable[..., Any]:
    """The solver in Python."""
    return _solver(lambda function: function)


@cache
def compiled() -> Callable[..., Any]:
    """The solver in machine code. Raises MissingPartError without numba."""
    njit: Any = require_extra("optimize", "numba").njit
    return _solver(njit(nogil=True))


def _solver(compiled: Callable[[Any], Any]) -> Callable[..., Any]:
    """Steps a ride until its end or until its rows are full. compiled: what makes machine code of Python functions."""
    hill, turn = compiled(hill_factor), 2 * math.pi
    cells = POINTS / turn

    @compiled
    def commanded(table: Any, constants: Any, angle: float, speed: float, into: Any) -> None:
        """Moments that the muscles are told, as at rest, N m; with a lag, ahead of its phase at this crank speed."""
        lag, measured = constants[8], constants[9]
        if lag > 0:  # what is left of the first harmonic's lag is what the command itself makes good
            angle += math.atan(speed * lag) - math.atan(measured * lag)
        place = (angle % turn) * cells
        row = int(place)
        part = place - row
        low, high = table[row], table[row + 1]
        for muscle in range(MUSCLES):
            command = low[COMMANDS + muscle]
            into[muscle] = command + part * (high[COMMANDS + muscle] - command)

    @compiled
    def rates(table: Any, constants: Any, state: Any, engaged: int, way: int, told: Any, out: Any) -> Any:
        """Rates of the state; returns T where the transmission is engaged, elsewhere the wheel's push, N.

        way: in which the tricycle moves, 0 if dry friction holds it.
        """
        angle, speed, travelling = state[ANGLE], state[CRANK], state[SPEED]
        _, travel, mass, rolling, climb, drag, upright, along, lag, _, curvature, plateau, knee, hip, _ = constants
        place = (angle % turn) * cells
        row = int(place)
        part = place - row
        low, high = table[row], table[row + 1]
        inertia = low[INERTIA] + part * (high[INERTIA] - low[INERTIA])
        half_change = (low[INERTIA_RATE] + part * (high[INERTIA_RATE] - low[INERTIA_RATE])) / 2
        recoil = low[RECOIL] + part * (high[RECOIL] - low[RECOIL])
        recoil_change = low[RECOIL_RATE] + part * (high[RECOIL_RATE] - low[RECOIL_RATE])
        rise = low[HEIGHT_RATE] + part * (high[HEIGHT_RATE] - low[HEIGHT_RATE])
        commanded(table, constants, angle, speed, told)
        drive = 0.0
        for muscle in range(MUSCLES):
            rate = low[RATES + muscle] + part * (high[RATES + muscle] - low[RATES + muscle])
            moment = told[muscle]
            if lag > 0:
                moment = state[ANSWERS + muscle]
                out[ANSWERS + muscle] = (told[muscle] - moment) / lag
            limit = hip if muscle % 2 else knee
            relative = (rate if moment > 0 else -rate) * speed / limit
            drive += moment * rate * hill(curvature, plateau, min(max(relative, 0.0), 1.0), max(-relative, 0.0))
        # the road is tilted by tilting gravity: backwards along it, and upright on it
        crank = drive - upright * rise + along * recoil - half_change * speed * speed
        resistance = rolling * way + climb + drag * travelling * abs(travelling)
        wheel = recoil_change * speed * speed - resistance
        if engaged:
            acceleration = 0.0
            if way != 0:
                whole = inertia - 2 * travel * recoil + travel * travel * mass
                acceleration = (crank + travel * wheel) / whole
            out[CRANK], out[SPEED] = acceleration, travel * acceleration
            push = crank - (inertia - travel * recoil) * acceleration
        elif way != 0:
            determinant = inertia * mass - recoil * recoil
            out[CRANK] = (mass * crank + recoil * wheel) / determinant
            out[SPEED] = (recoil * crank + inertia * wheel) / determinant
            push = 0.0
        else:
            out[CRANK], out[SPEED] = crank / inertia, 0.0
            push = recoil * out[CRANK] + wheel
        out[ANGLE], out[DISTANCE] = speed, travelling
        out[MUSCLE_WORK], out[ROAD_WORK] = drive * speed, resistance * travelling
        return push

    @compiled
    def left(constants: Any, state: Any, engaged: int, way: int, push: float) -> bool:
        """Whether a state has left its mode: the tricycle stands still or is moved, the freewheel opens or closes."""
        fixed, travel, _, rolling, climb = constants[:5]
        if engaged and not fixed and push < 0:
            return True
        if not engaged and state[CRANK] * travel > state[SPEED] + TOUCH:
            return True
        if way != 0:
            return bool(way * state[SPEED] < 0)
        force = push / travel - climb if engaged else push
        return bool(abs(force) > rolling)

    @compiled
    def choose(table: Any, constants: Any, state: Any, told: Any, out: Any) -> Any:
        """Mode of a state: (engaged, way)."""
        fixed, travel, _, rolling, climb = constants[:5]
        way = 1 if state[SPEED] > 0 else -1 if state[SPEED] < 0 else 0
        together = fixed or state[CRANK] * travel >= state[SPEED] - TOUCH
        if together and way != 0:
            push = rates(table, constants, state, 1, way, told, out)
            return (1, way) if fixed or push >= 0 else (0, way)
        if together:  # and stands
            push = rates(table, constants, state, 1, 0, told, out)
            force = push / travel - climb
            if fixed or push >= 0:
                return 1, (1 if force > rolling else -1 if force < -rolling else 0)
        if way == 0:
            force = rates(table, constants, state, 0, 0, told, out)
            way = 1 if force > rolling else -1 if force < -rolling else 0
            if together and way < 0:  # it rolls back, perhaps faster than the crank falls
                rates(table, constants, state, 0, way, told, out)
                if out[CRANK] * travel > out[SPEED]:
                    return 1, way
        return 0, way

    @compiled
    def step(table: Any, constants: Any, start: Any, engaged: int, way: int, time: float, work: Any, end: Any) -> Any:
        """A step of Runge and Kutta from `start` to `end`; returns what `rates` does there."""
        told, probe, first, second, third, fourth = work
        rates(table, constants, start, engaged, way, told, first)
        for i in range(STATE):
            probe[i] = start[i] + time / 2 * first[i]
        rates(table, constants, probe, engaged, way, told, second)
        for i in range(STATE):
            probe[i] = start[i] + time / 2 * second[i]
        rates(table, constants, probe, engaged, way, told, third)
        for i in range(STATE):
            probe[i] = start[i] + time * third[i]
        rates(table, constants, probe, engaged, way, told, fourth)
        for i in range(STATE):
            end[i] = start[i] + time / 6 * (first[i] + 2 * (second[i] + third[i]) + fourth[i])
        return rates(table, constants, end, engaged, way, told, first)

    @compiled
    def advance(
        table: Any, constants: Any, state: Any, clock: float, engaged: int, way: int, begin: bool, work: Any, rows: Any
    ) -> Any:
        """Fill rows: time, mode (1 engaged), state, at the start of each step and at last at the end of the ride."""
        travel, duration = constants[1], constants[14]
        told, end = work[0], work[1]
        if begin:
            commanded(table, constants, state[ANGLE], state[CRANK], told)
            for muscle in range(MUSCLES):
                state[ANSWERS + muscle] = told[muscle]
            engaged, way = choose(table, constants, state, told, work[2])
        count = 0
        while count < len(rows):
            rows[count, 0], rows[count, 1] = clock, engaged
            for i in range(STATE):
                rows[count, 2 + i] = state[i]
            count += 1
            if clock >= duration:
                break
            # to the next break of the moments, but not across it
            angle, speed = state[ANGLE] % turn, state[CRANK]
            row = table[int(angle * cells)]
            reach = min(STEP_ANGLES[engaged], row[AHEAD] - angle if speed > 0 else angle - row[BEHIND])
            time = min(STEP_TIME, reach / max(abs(speed), 1e-9), duration - clock)
            push = step(table, constants, state, engaged, way, time, work[2:], end)
            if left(constants, end, engaged, way, push):
                earliest, latest = 0.0, time
                for _ in range(HALVINGS):
                    time = (earliest + latest) / 2
                    push = step(table, constants, state, engaged, way, time, work[2:], end)
                    if left(constants, end, engaged, way, push):
                        latest = time
                    else:
                        earliest = time
                time = latest
                push = step(table, constants, state, engaged, way, time, work[2:], end)
                if way * end[SPEED] < 0:
                    end[SPEED] = 0.0
                    if engaged:
                        end[CRANK] = 0.0
                if not engaged and end[CRANK] * travel > end[SPEED]:
                    end[CRANK] = end[SPEED] / travel
                engaged, way = choose(table, constants, end, told, work[2])
            for i in range(STATE):
                state[i] = end[i]
            clock += time
        return count, clock, engaged, way

    result: Callable[..., Any] = advance
    return result
