"""The reduced equation of motion of a ride.

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
from typing import NamedTuple, TypeAlias

from fes_mj.common.machine_code import inlined_machine_code, machine_code
from fes_mj.muscles.step import stimulation
from fes_mj.riding.leg_table import LegTable, leg_table
from fes_mj.riding.lookup import between, place
from fes_mj.riding.muscle_table import driven_by
from fes_mj.riding.ride import Load, Ride
from fes_mj.riding.stimulated import NO_STIMULATOR, StimulatedRider, Stimulator, lead

SPEED_ROUNDING = 1e-12  # m/s: rounding, by which a crank that has just caught up may be too fast or too slow
LONGEST, LONGEST_FREE = 0.016, math.radians(2.0)  # s, of a step: where the crank is slow; rad: where it runs free
RISE_SHARE = 0.25  # of the time constant of a rise, that no step is longer than
# A crank that runs free where the legs' inertia grows or falls many times within a degree: what the table chooses its
# steps by, a crank that turns evenly, knows nothing of it. Of the crank's speed in a step, per itself.
SPEED_TOLERANCE = 1e-5


class System(NamedTuple):
    """All that the equation of motion knows of a ride. travel: c, m/rad. longest: step, s, and free: of a crank that
    runs free, rad. tolerance: of a Step's error.
    """

    table: LegTable
    stimulator: Stimulator
    load: Load
    fixed: bool
    travel: float
    longest: float
    free: float
    tolerance: float


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


class Mode(NamedTuple):
    """Whether the crank drives the wheel, and in which direction the tricycle moves; 0 if dry friction holds it."""

    engaged: bool
    direction: int


def system(ride: Ride, fineness: int) -> System:
    """The equation of motion of a ride. fineness: divides steps and the table's cells."""
    table = leg_table(ride.design, ride.drive, fineness)
    stimulator = ride.drive.stimulator if isinstance(ride.drive, StimulatedRider) else NO_STIMULATOR
    longest = min(LONGEST, RISE_SHARE * stimulator.rise)
    return System(
        table=table,
        stimulator=stimulator,
        load=ride.load,
        fixed=ride.fixed,
        travel=ride.travel,
        longest=longest / fineness,
        free=LONGEST_FREE / fineness,
        tolerance=SPEED_TOLERANCE / fineness**4,
    )


@machine_code
def state_after(state: State, rates: State, time: float) -> State:
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


@inlined_machine_code
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
        turning = (mass * crank + recoil * wheel) / determinant
        rolling = (recoil * crank + inertia * wheel) / determinant
        push = 0.0
    else:
        turning, rolling = crank / inertia, 0.0
        push = recoil * turning + wheel
    return State(speed, turning, travelling, rolling, drive * speed, resistance * travelling, activating), push


@machine_code
def mode_margins(system: System, state: State, mode: Mode, push: float) -> tuple[float, float]:
    """What is left of a mode before the freewheel opens or closes (N m, m/s), and before the tricycle comes to rest or
    is moved (m/s, N): one of them is below zero once the mode is over.
    """
    transmission, road = 1.0, mode.direction * state.speed
    if not mode.engaged:
        transmission = state.speed + SPEED_ROUNDING - state.crank_speed * system.travel
    elif not system.fixed:
        transmission = push
    if mode.direction == 0:
        force = push / system.travel - system.load.climb if mode.engaged else push
        road = system.load.rolling - abs(force)
    return transmission, road


@machine_code
def breakaway_direction(force: float, friction: float) -> int:
    """Direction in which a force (N) moves what dry friction would hold; 0 if it holds."""
    return 1 if force > friction else -1 if force < -friction else 0


@machine_code
def mode_of(system: System, state: State) -> Mode:
    """The mode in which a state goes on."""
    fixed, travel, load = system.fixed, system.travel, system.load
    direction = breakaway_direction(state.speed, 0.0)
    together = fixed or state.crank_speed * travel >= state.speed - SPEED_ROUNDING
    if together and direction != 0:
        _, push = rates_of(system, state, Mode(True, direction))
        return Mode(fixed or push >= 0, direction)
    if together:  # and stands
        _, push = rates_of(system, state, Mode(True, 0))
        if fixed or push >= 0:
            return Mode(True, breakaway_direction(push / travel - load.climb, load.rolling))
    if direction == 0:
        _, force = rates_of(system, state, Mode(False, 0))
        direction = breakaway_direction(force, load.rolling)
        if together and direction < 0:  # it rolls back, perhaps faster than the crank falls
            rates, _ = rates_of(system, state, Mode(False, direction))
            if rates.crank_speed * travel > rates.speed:
                return Mode(True, direction)
    return Mode(False, direction)
