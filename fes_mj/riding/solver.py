"""The reduced equation of motion of a ride, integrated from event to event.

Crank angle a with speed w, and the tricycle's speed v, which recoils with the legs. With the kinetic energy
I(a) w^2 / 2 - X(a) w v + m v^2 / 2, where X = sum of m dx/da over both legs' bodies, and their potential energy V(a),

    I w' - X v' = Q - V'(a) - I'(a) w^2 / 2 - T        (crank)
    m v' - X w' = X'(a) w^2 - F(v) + T / c             (tricycle)

Q is the virtual work of the joint moments, or of muscles (muscle_table), whose activations are states as well. F is
the road's force and T the moment that the transmission takes from the
crank. A fixed gear keeps v = c w. A freewheel does while T is positive, and otherwise lets v run ahead of c w with
T = 0: no impact, no memory. Rolling resistance is dry friction: it holds a tricycle that stands.
"""

import math
from typing import Any, NamedTuple, TypeAlias

from fes_mj.common.machine_code import kept_machine_code, machine_code, sources
from fes_mj.linkage.inertia import CrankInertia
from fes_mj.muscles.step import stimulation
from fes_mj.riding.leg_table import LegTable, leg_table
from fes_mj.riding.lookup import between, place
from fes_mj.riding.muscle_table import MuscleTable, driven_by
from fes_mj.riding.ride import Load, Ride
from fes_mj.riding.stimulated import NO_STIMULATOR, StimulatedRider, Stimulator, lead

TOUCH = 1e-12  # m/s: rounding, by which a crank that has just caught up may be too fast or too slow
STANDING = 1e-9  # rad/s: a crank that is slower takes no step by its angle
NEAR = 1e-9  # rad: rounding, by which a step may miss the end of a cell
LONGEST, LONGEST_FREE = 0.016, math.radians(1.0)  # s, of a step: where the crank is slow; rad: where it runs free
HALVINGS = 14  # of a step, to find an event in it
QUICK = 0.25  # of the time constant of a rise, that no step is longer than


class System(NamedTuple):
    """All that the equation of motion knows of a ride. travel: c, m/rad. longest: step, s, and free: of a crank that
    runs free, rad.
    """

    table: LegTable
    stimulator: Stimulator
    load: Load
    fixed: bool
    travel: float
    longest: float
    free: float


Activation: TypeAlias = tuple[float, float, float, float, float, float]


class State(NamedTuple):
    """Angles in rad, speeds in rad/s and m/s, work since the start in J; activation of the right, then the left leg."""

    crank_angle: float
    crank_speed: float
    distance: float
    speed: float
    muscle_work: float
    road_work: float
    activation: Activation


# What is kept of a state at each step: fields of a Trace.
SAMPLE = ("time", "coasting", *State._fields[:-1])


class Mode(NamedTuple):
    """Whether the crank drives the wheel, and in which direction the tricycle moves; 0 if dry friction holds it."""

    engaged: bool
    direction: int


def system(ride: Ride, fineness: int) -> System:
    """The equation of motion of a ride. fineness: divides steps and the table's cells."""
    table = leg_table(ride.design, ride.drive, fineness)
    stimulator = ride.drive.stimulator if isinstance(ride.drive, StimulatedRider) else NO_STIMULATOR
    longest = min(LONGEST, QUICK * stimulator.rise)
    return System(table, stimulator, ride.load, ride.fixed, ride.travel, longest / fineness, LONGEST_FREE / fineness)


@machine_code
def moved(state: State, rates: State, time: float) -> State:
    """A state, and so much time along its rates."""
    old, new = state.activation, rates.activation
    return State(
        state.crank_angle + time * rates.crank_angle,
        state.crank_speed + time * rates.crank_speed,
        state.distance + time * rates.distance,
        state.speed + time * rates.speed,
        state.muscle_work + time * rates.muscle_work,
        state.road_work + time * rates.road_work,
        (
            old[0] + time * new[0],
            old[1] + time * new[1],
            old[2] + time * new[2],
            old[3] + time * new[3],
            old[4] + time * new[4],
            old[5] + time * new[5],
        ),
    )


@machine_code
def answering(system: System, group: int, felt: float, active: float) -> float:
    """Rate of an activation, 1/s; felt: crank angle of its leg whose stimulation it feels, rad."""
    missing = stimulation(system.stimulator.stimulus, group, felt) - active
    return missing / (system.stimulator.rise if missing > 0 else system.stimulator.fall)


@machine_code
def muscles(system: System, state: State, row: int, part: float) -> tuple[float, Activation]:
    """Virtual work of both legs' muscles, N m, and the rates of their activations."""
    table, angle, speed, active = system.table, state.crank_angle, state.crank_speed, state.activation
    half, ahead = len(table.ahead) // 2, lead(system.stimulator, speed)
    other = row + half if row < half else row - half
    felt, behind = angle + ahead, angle - math.pi + ahead
    drive = driven_by(table.muscles, row, part, speed, (active[0], active[1], active[2]))
    drive += driven_by(table.muscles, other, part, speed, (active[3], active[4], active[5]))
    rates = (
        answering(system, 0, felt, active[0]),
        answering(system, 1, felt, active[1]),
        answering(system, 2, felt, active[2]),
        answering(system, 0, behind, active[3]),
        answering(system, 1, behind, active[4]),
        answering(system, 2, behind, active[5]),
    )
    return drive, rates


@machine_code
def rates_of(system: System, state: State, mode: Mode) -> tuple[State, float]:
    """Rates of a state, and T where the transmission is engaged (N m), elsewhere the wheel's push (N)."""
    table, load = system.table, system.load
    masses, speed, travelling = table.masses, state.crank_speed, state.speed
    row, part = place(state.crank_angle, len(table.ahead))
    inertia, recoil = between(masses.inertia, row, part), between(masses.recoil, row, part)
    drive, activating = 0.0, state.activation
    if len(table.muscles.group) > 0:
        drive, activating = muscles(system, state, row, part)
    for joint in range(len(table.moment)):
        drive += between(table.joint_rate[joint], row, part) * between(table.moment[joint], row, part)
    # the road is tilted by tilting gravity: backwards along it, and upright on it
    weight = load.upright * between(masses.height_rate, row, part) - load.along * recoil
    crank = drive - weight - between(masses.inertia_rate, row, part) / 2 * speed * speed
    resistance = load.rolling * mode.direction + load.climb + load.drag * travelling * abs(travelling)
    wheel = between(masses.recoil_rate, row, part) * speed * speed - resistance
    travel, mass = system.travel, load.inertia
    if mode.engaged:
        turning = 0.0
        if mode.direction != 0:
            turning = (crank + travel * wheel) / (inertia - 2 * travel * recoil + travel * travel * mass)
        rolling = travel * turning
        push = crank - (inertia - travel * recoil) * turning
    elif mode.direction != 0:
        determinant = inertia * mass - recoil * recoil
        turning, rolling = (
            (mass * crank + recoil * wheel) / determinant,
            (recoil * crank + inertia * wheel) / determinant,
        )
        push = 0.0
    else:
        turning, rolling = crank / inertia, 0.0
        push = recoil * turning + wheel
    return State(speed, turning, travelling, rolling, drive * speed, resistance * travelling, activating), push


@machine_code
def ended(system: System, state: State, mode: Mode, push: float) -> bool:
    """Whether a mode is over: the tricycle comes to rest or is moved, the freewheel opens or closes."""
    if mode.engaged and not system.fixed and push < 0:
        return True
    if not mode.engaged and state.crank_speed * system.travel > state.speed + TOUCH:
        return True
    if mode.direction != 0:
        return mode.direction * state.speed < 0
    force = push / system.travel - system.load.climb if mode.engaged else push
    return abs(force) > system.load.rolling


@machine_code
def driven(force: float, friction: float) -> int:
    """Direction in which a force (N) moves what dry friction would hold; 0 if it holds."""
    return 1 if force > friction else -1 if force < -friction else 0


@machine_code
def mode_of(system: System, state: State) -> Mode:
    """The mode in which a state goes on."""
    fixed, travel, load = system.fixed, system.travel, system.load
    direction = driven(state.speed, 0.0)
    together = fixed or state.crank_speed * travel >= state.speed - TOUCH
    if together and direction != 0:
        _, push = rates_of(system, state, Mode(True, direction))
        return Mode(fixed or push >= 0, direction)
    if together:  # and stands
        _, push = rates_of(system, state, Mode(True, 0))
        if fixed or push >= 0:
            return Mode(True, driven(push / travel - load.climb, load.rolling))
    if direction == 0:
        _, force = rates_of(system, state, Mode(False, 0))
        direction = driven(force, load.rolling)
        if together and direction < 0:  # it rolls back, perhaps faster than the crank falls
            rates, _ = rates_of(system, state, Mode(False, direction))
            if rates.crank_speed * travel > rates.speed:
                return Mode(True, direction)
    return Mode(False, direction)


@machine_code
def stepped(system: System, start: State, first: State, mode: Mode, time: float) -> tuple[State, State, float]:
    """A step of Runge and Kutta from a state with these rates: the state at its end, and what rates_of says there."""
    second, _ = rates_of(system, moved(start, first, time / 2), mode)
    third, _ = rates_of(system, moved(start, second, time / 2), mode)
    fourth, _ = rates_of(system, moved(start, third, time), mode)
    middle = moved(moved(moved(start, first, time / 6), second, time / 3), third, time / 3)
    end = moved(middle, fourth, time / 6)
    rates, push = rates_of(system, end, mode)
    return end, rates, push


@machine_code
def to_event(system: System, start: State, first: State, mode: Mode, longest: float) -> tuple[State, float]:
    """The state at which a mode is over within a step, and the time until then, s."""
    earliest, latest = 0.0, longest
    for _ in range(HALVINGS):
        time = (earliest + latest) / 2
        end, _, push = stepped(system, start, first, mode, time)
        if ended(system, end, mode, push):
            latest = time
        else:
            earliest = time
    end, _, _ = stepped(system, start, first, mode, latest)
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
    reach: float = max(table.ahead[row] - angle if speed > 0 else angle - table.behind[row], NEAR)
    if not mode.engaged:
        reach = min(reach, system.free)
    change = rates.crank_speed if speed > 0 else -rates.crank_speed
    fastest = abs(speed) + math.sqrt(max(speed * speed + 2 * change * reach, 0.0))
    return min(system.longest, 2 * reach / max(fastest, STANDING))


@kept_machine_code
def advance(
    system: System,
    state: State,
    mode: Mode,
    clock: float,
    until: float,
    rows: Any,
    version: int = sources(CrankInertia, LegTable, MuscleTable, Load),
) -> tuple[int, State, Mode, float]:
    """Fill rows with SAMPLE at the start of each step, and at last at the end of the ride.

    clock: s; at 0 the ride begins. Returns how many rows there are, state, mode and clock at their end.
    """
    if clock == 0:
        mode = mode_of(system, state)
    rates, _ = rates_of(system, state, mode)
    count = 0
    while count < len(rows):
        rows[count, 0], rows[count, 1] = clock, not mode.engaged
        rows[count, 2], rows[count, 3], rows[count, 4] = state.crank_angle, state.crank_speed, state.distance
        rows[count, 5], rows[count, 6], rows[count, 7] = state.speed, state.muscle_work, state.road_work
        count += 1
        if clock >= until:
            break
        time = min(longest_step(system, state, rates, mode), until - clock)
        end, onward, push = stepped(system, state, rates, mode, time)
        if ended(system, end, mode, push):
            end, time = to_event(system, state, rates, mode, time)
            mode = mode_of(system, end)
            onward, _ = rates_of(system, end, mode)
        state, rates = end, onward
        clock += time
    return count, state, mode, clock
