"""The reduced equation of motion of a ride, integrated from event to event."""

import math
from typing import Any, NamedTuple

from fes_mj.common.machine_code import inlined_machine_code, kept_machine_code, machine_code
from fes_mj.linkage.inertia import CrankInertia
from fes_mj.riding.equation import Mode, State, System, mode_margins, mode_of, rates_of, state_after
from fes_mj.riding.leg_table import LegTable
from fes_mj.riding.lookup import place
from fes_mj.riding.muscle_table import MuscleTable
from fes_mj.riding.ride import Load

STANDING = 1e-9  # rad/s: a crank that is slower takes no step by its angle
ANGLE_ROUNDING = 1e-9  # rad: rounding, by which a step may miss the end of a cell
SHORTEST_STEP = 1e-7  # s, of a step that is made shorter for this
EVENT = 2.0**-14  # of a step, within which an event in it is found

# What is kept of a state at each step: fields of a Trace.
SAMPLE = ("time", "coasting", *State._fields[:-1])


class Step(NamedTuple):
    """A step's end, the rates there, and `mode_margins` in its middle and at its end. error: of the crank's speed, per
    itself, where rates at the end instead of the fourth would give it at third order.
    """

    end: State
    rates: State
    middle_margins: tuple[float, float]
    end_margins: tuple[float, float]
    error: float


@inlined_machine_code
def stepped(system: System, start: State, first: State, mode: Mode, time: float) -> Step:
    """A step of Runge and Kutta from a state with these rates."""
    second, _ = rates_of(system, state_after(start, first, time / 2), mode)
    halfway = state_after(start, second, time / 2)
    third, push = rates_of(system, halfway, mode)
    middle = mode_margins(system, halfway, mode, push)
    fourth, _ = rates_of(system, state_after(start, third, time), mode)
    two_thirds = state_after(state_after(state_after(start, first, time / 6), second, time / 3), third, time / 3)
    end = state_after(two_thirds, fourth, time / 6)
    rates, push = rates_of(system, end, mode)
    error = time / 6 * abs(fourth.crank_speed - rates.crank_speed)
    scale = abs(start.crank_speed) + time * abs(first.crank_speed)
    return Step(end, rates, middle, mode_margins(system, end, mode, push), error / max(scale, STANDING))


@machine_code
def lowest(begin: float, middle: float, end: float) -> float:
    """Part of a step at which a parabola through three margins is lowest, if it is below zero there; elsewhere all."""
    slope, bend = 4 * middle - 3 * begin - end, 2 * (begin - 2 * middle + end)
    if slope < 0 and 2 * bend > -slope and slope * slope > 4 * bend * begin:
        return -slope / (2 * bend)
    return 1.0


@machine_code
def fitting(excess: float) -> float:
    """Factor by which to change a step whose error is so many tolerances; it goes with the fourth power of the step."""
    return 0.9 / math.sqrt(math.sqrt(min(max(excess, 1 / 256), 256.0)))


@inlined_machine_code
def tried(
    system: System, start: State, first: State, mode: Mode, margins: tuple[float, float], longest: float, trusted: float
) -> tuple[Step, float, float]:
    """A step that is exact enough and misses no event, its time and how long the next one may be, s.

    margins: at the start.
    """
    time, whole = min(longest, trusted), True
    while True:
        step = stepped(system, start, first, mode, time)
        if step.error > system.tolerance and time > SHORTEST_STEP:
            time *= fitting(step.error / system.tolerance)
            trusted = time
            continue
        part = 1.0
        if whole and min(step.end_margins) >= 0:  # yet a mode may have been over, and be on again
            middle, end = step.middle_margins, step.end_margins
            part = min(lowest(margins[0], middle[0], end[0]), lowest(margins[1], middle[1], end[1]))
        if part == 1:
            break
        time, whole = part * time, False
    trusted *= fitting(step.error / system.tolerance)
    return step, time, trusted


@machine_code
def to_event(
    system: System, start: State, first: State, mode: Mode, margins: tuple[float, float], step: Step, latest: float
) -> tuple[State, float]:
    """The state at which a mode is over within a step, and the time until then, s; by false positions, of which one
    that stays is halved (Illinois).

    margins: at the start.
    """
    earliest, near, end = 0.0, EVENT * latest, step.end
    above, below, side = max(min(margins), 0.0), min(step.end_margins), 0
    while latest - earliest > 2 * near:
        time = earliest + (latest - earliest) * above / (above - below)
        time = min(max(time, earliest + near), latest - near)
        step = stepped(system, start, first, mode, time)
        margin = min(step.end_margins)
        if margin < 0:
            latest, below, end = time, margin, step.end
            above, side = above / 2 if side < 0 else above, -1
        else:
            earliest, above = time, margin
            below, side = below / 2 if side > 0 else below, 1
    crank_speed, speed = end.crank_speed, end.speed
    if mode.direction * speed < 0:
        speed = 0.0
        if mode.engaged:
            crank_speed = 0.0
    if not mode.engaged and crank_speed * system.travel > speed:
        crank_speed = speed / system.travel
    still = (end.distance, speed, end.muscle_work, end.road_work, end.activation)
    return State(end.crank_angle, crank_speed, *still), latest


@machine_code
def longest_step(system: System, state: State, rates: State, mode: Mode) -> float:
    """Time of the next step, s: to where the table ends it, at the acceleration at its begin."""
    table, angle, speed = system.table, state.crank_angle % (2 * math.pi), state.crank_speed
    row, _ = place(angle, len(table.ahead))
    reach: float = max(table.ahead[row] - angle if speed > 0 else angle - table.behind[row], ANGLE_ROUNDING)
    if not mode.engaged:
        reach = min(reach, system.free)
    change = rates.crank_speed if speed > 0 else -rates.crank_speed
    fastest = abs(speed) + math.sqrt(max(speed * speed + 2 * change * reach, 0.0))
    return min(system.longest, 2 * reach / max(fastest, STANDING))


@kept_machine_code(CrankInertia, LegTable, MuscleTable, Load)
def fill_samples(
    system: System, state: State, mode: Mode, clock: float, until: float, rows: Any
) -> tuple[int, State, Mode, float]:
    """Fill rows with SAMPLE at the start of each step, and at last at the end of the ride.

    clock: s; at 0 the ride begins. Returns how many rows there are, state, mode and clock at their end.
    """
    if clock == 0:
        mode = mode_of(system, state)
    rates, push = rates_of(system, state, mode)
    margins, count, trusted = mode_margins(system, state, mode, push), 0, math.inf
    while count < len(rows):
        rows[count, 0], rows[count, 1] = clock, not mode.engaged
        rows[count, 2], rows[count, 3], rows[count, 4] = state.crank_angle, state.crank_speed, state.distance
        rows[count, 5], rows[count, 6], rows[count, 7] = state.speed, state.muscle_work, state.road_work
        count += 1
        if clock >= until:
            break
        longest = min(longest_step(system, state, rates, mode), until - clock)
        step, time, trusted = tried(system, state, rates, mode, margins, longest, trusted)
        if min(step.end_margins) < 0:
            state, time = to_event(system, state, rates, mode, margins, step, time)
            mode = mode_of(system, state)
            rates, push = rates_of(system, state, mode)
            margins = mode_margins(system, state, mode, push)
        else:
            state, rates, margins = step.end, step.rates, step.end_margins
        clock += time
    return count, state, mode, clock
