"""What becomes of a ride: its trace, whoever solved it, and the ride by the reduced equation of motion (solver)."""

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from scipy.interpolate import CubicSpline

from fes_mj.common.arrays import BoolArray, FloatArray
from fes_mj.common.brief import Brief
from fes_mj.common.errors import UnstableError
from fes_mj.common.machine_code import readable
from fes_mj.common.units import KMH, RPM
from fes_mj.riding.ride import Ride

LAST_TURNS = 5  # whole turns at the end, over which a ride is described
# A tricycle that is no faster than this at the end, or this far back from where it had come, does not ride. Dry
# friction stops it within a hundredth of a second of the former.
LEAST_SPEED, LEAST_ADVANCE = 1e-3, 1e-5  # m/s, m
SPLINE = 4  # samples on either side of a crank angle at which speeds are read
STANDS = 2.0  # s, after which a tricycle that stands does so for good: no muscle takes that long to answer
ROWS = 16384  # samples that are made before Python looks at them
MOST_ROWS = 2**21  # an hour of fast riding; beyond it something is wrong


@dataclass(frozen=True, eq=False, repr=False)
class Trace(Brief):
    """What became of a ride, sampled in time; arrays of shape (samples,).

    time: s. crank_angle: rad, running on. crank_speed: rad/s. distance: m. speed: of the tricycle, m/s. coasting:
    whether the freewheel lets the wheel run ahead. muscle_work: by all joint moments since the start, J. road_work:
    against rolling resistance, air and slope since the start, J.
    """

    ride: Ride
    time: FloatArray
    crank_angle: FloatArray
    crank_speed: FloatArray
    distance: FloatArray
    speed: FloatArray
    coasting: BoolArray
    muscle_work: FloatArray
    road_work: FloatArray

    @property
    def brief(self) -> str:
        if self.stopped_at is not None:
            return f"{self.ride.name}: stops after {self.stopped_at:.1f} s"
        return f"{self.ride.name}: rides at {self.speed[-1] / KMH:.2f} km/h after {self.time[-1]:.0f} s"

    @cached_property
    def rides(self) -> bool:
        """Whether the tricycle still goes forward at the end, farther than it ever was."""
        return bool(self.speed[-1] > LEAST_SPEED and self.distance[-1] > self.distance.max() - LEAST_ADVANCE)

    @cached_property
    def stop(self) -> int | None:
        """Sample at which it had come as far as it ever came; None if it rides."""
        return None if self.rides else int(np.argmax(self.distance > self.distance.max() - LEAST_ADVANCE))

    @property
    def stopped_at(self) -> float | None:
        """The time of this, s."""
        return None if self.stop is None else float(self.time[self.stop])

    @property
    def turns(self) -> float:
        """Turns of the crank until the end, or until it stopped."""
        end = -1 if self.stop is None else self.stop
        return float(self.crank_angle[end] - self.crank_angle[0]) / (2 * np.pi)

    @property
    def coasting_share(self) -> float:
        """Share of the time in which the freewheel runs free, until it stopped."""
        moving = self.time[: self.stop] if self.stop else self.time
        if len(moving) < 2:
            return 0.0
        steps = np.diff(moving)
        return float(steps @ self.coasting[: len(steps)] / steps.sum())

    @cached_property
    def whole_turns(self) -> int:
        """Turns at the end over which a ride is described; 0 if it stopped, made none or turned backwards."""
        return min(LAST_TURNS, max(0, math.floor(self.turns))) if self.rides else 0

    @cached_property
    def last_turns(self) -> slice:
        """The samples of these turns."""
        begin = self.crank_angle[-1] - 2 * np.pi * self.whole_turns
        return slice(int(np.argmax(self.crank_angle >= begin)), None)

    def ends(self, column: FloatArray) -> tuple[float, float]:
        """Values of a column at the begin of these turns, between two samples, and at their end."""
        begin, first = self.crank_angle[-1] - 2 * np.pi * self.whole_turns, self.last_turns.start
        near = slice(max(0, first - 1), first + 1)
        return float(np.interp(begin, self.crank_angle[near], column[near])), float(column[-1])

    def mean(self, cumulative: FloatArray) -> float | None:
        """Mean rate of something that adds up, over these turns; None without any."""
        if not self.whole_turns:
            return None
        (began, ended), (first, last) = self.ends(self.time), self.ends(cumulative)
        return (last - first) / (ended - began)

    @property
    def mean_speed(self) -> float | None:
        """Of the tricycle over the last whole turns, m/s."""
        return self.mean(self.distance)

    @property
    def cadence(self) -> float | None:
        """Mean crank speed over the last whole turns, rad/s."""
        return self.mean(self.crank_angle)

    @property
    def ripple(self) -> float | None:
        """Largest less smallest crank speed over the last whole turns, per its mean."""
        cadence = self.cadence
        return None if cadence is None else float(np.ptp(self.crank_speed[self.last_turns])) / cadence

    @property
    def muscle_power(self) -> float | None:
        """Mean power of all joint moments over the last whole turns, W."""
        return self.mean(self.muscle_work)

    @property
    def road_power(self) -> float | None:
        """Mean power that the road takes over the last whole turns, W."""
        return self.mean(self.road_work)

    @property
    def gained_power(self) -> float | None:
        """Rate at which kinetic energy grows over the last whole turns, W; height returns. None without any turn."""
        if not self.whole_turns:
            return None
        masses, end = self.ride.table.masses, self.crank_angle[-1]
        turn = np.linspace(0, 2 * np.pi, len(masses.inertia))
        inertia, recoil = (np.interp(end % (2 * np.pi), turn, curve) for curve in (masses.inertia, masses.recoil))
        # a straight line between two samples would be off by a third of a percent of the power where the crank jerks
        first = self.last_turns.start
        near = slice(max(0, first - SPLINE), first + SPLINE)
        angle, kept = np.unique(self.crank_angle[near], return_index=True)
        speeds = np.stack([self.crank_speed, self.speed], axis=1)
        begun = CubicSpline(angle, speeds[near][kept])(end - 2 * np.pi * self.whole_turns)
        crank, speed = np.stack([begun, speeds[-1]], axis=1)
        kinetic = (inertia * crank**2 + self.ride.load.inertia * speed**2) / 2 - recoil * crank * speed
        began, ended = self.ends(self.time)
        return float(kinetic[1] - kinetic[0]) / (ended - began)

    def summary(self) -> dict[str, Any]:
        """The result as JSON names and units it."""
        speed, cadence = self.mean_speed, self.cadence
        return {
            "ended_s": float(self.time[-1]),
            "rides": self.rides,
            "speed_kmh": None if speed is None else speed / KMH,
            "cadence_rpm": None if cadence is None else cadence / RPM,
            "speed_ripple": self.ripple,
            "distance_m": float(self.distance.max()),
            "freewheel_share": self.coasting_share,
            "stopped_at_s": self.stopped_at,
            "turns": self.turns,
            "power_muscle_W": self.muscle_power,
            "power_road_W": self.road_power,
        }


def ride(ride: Ride, fineness: int = 1) -> Trace:
    """Ride without MuJoCo, by the reduced equation of motion.

    It ends early where nothing more can come (nothing_more). fineness: divides the steps, which leg_table chooses.

    Raises InputError for a linkage that does not turn and for joints that never enter the moments' range, UnstableError
    where the equation cannot be integrated.

    >>> fes_mj.ride(fes_mj.Ride(fes_mj.load_design("d1"), fes_mj.load_moments("p1p2")))
    <Trace d1 p1p2 freewheel 0 %: rides at 30.36 km/h after 60 s>
    """
    from fes_mj.riding import equation, solver  # with numba, which takes a second to import

    ride.require_possible()
    system = readable(equation.system(ride, fineness))
    start = float(ride.start), ride.launch / ride.travel, 0.0, float(ride.launch), 0.0, 0.0, (0.0,) * 6
    state, mode, clock, until = equation.State(*start), equation.Mode(True, 0), 0.0, float(ride.duration)
    samples = np.empty((0, len(solver.SAMPLE)))
    while clock < until:
        rows = np.empty((ROWS, len(solver.SAMPLE)))
        count, state, mode, clock = solver.fill_samples(system, state, mode, clock, until, rows)
        samples = np.vstack([samples, rows[:count]])
        if len(samples) > MOST_ROWS or not math.isfinite(state.speed):
            raise UnstableError(f"{ride.name}: the reduced equation of motion could not be integrated")
        columns = dict(zip(solver.SAMPLE, samples.T, strict=True))
        over = nothing_more(ride, *(columns[name] for name in ("time", "crank_angle", "crank_speed", "speed")))
        if over.any():
            columns, clock = {name: column[: int(np.argmax(over)) + 1] for name, column in columns.items()}, until
    coasting = columns.pop("coasting") > 0
    return Trace(ride, coasting=coasting, **columns)


def nothing_more(
    ride: Ride, time: FloatArray, crank_angle: FloatArray, crank_speed: FloatArray, speed: FloatArray
) -> BoolArray:
    """Whether a ride is over: the crank has turned back by a whole turn, or everything has stood still for long.

    After that turn, driven by wheel or legs, it is again where it was, only faster.
    """
    back = np.maximum.accumulate(crank_angle) - crank_angle > 2 * np.pi
    moved = np.maximum.accumulate(np.where((speed != 0) | (crank_speed != 0), time, 0.0))
    return np.asarray(back | (time - moved > STANDS))
