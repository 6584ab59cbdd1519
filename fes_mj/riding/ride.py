"""A ride on a road: what is ridden, against what, and the trace that comes out, whoever solved it."""

import math
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from fes_mj.common.arrays import BoolArray, FloatArray
from fes_mj.common.errors import InputError
from fes_mj.common.units import KMH, RPM
from fes_mj.linkage.design import TRICYCLE_SPEED, WHEEL_DIAMETER, Design
from fes_mj.linkage.legs import TWO_LEGS
from fes_mj.linkage.segments import GRAVITY, inertias
from fes_mj.moments.joint_moments import JointMoments
from fes_mj.statics.turn import quasi_static

TRANSMISSIONS = ("freewheel", "fixed")
AIR_DENSITY = 1.2  # kg/m^3, at 20 deg C and sea level
LAST_TURNS = 5  # whole turns at the end, over which a ride is described
# A tricycle that is no faster than this at the end, or this far back from where it had come, does not ride. Dry
# friction stops it within a hundredth of a second of the former.
LEAST_SPEED, LEAST_ADVANCE = 1e-3, 1e-5  # m/s, m


@dataclass(frozen=True)
class Road:
    """The tricycle's masses and what holds it back.

    slope: rise per horizontal run. tricycle_mass: kg, wheels included, without crank and linkage. rolling_mass: kg, of
    the rims, which turn as well as move and so count twice as inertia. rolling_resistance: force per weight, a dry
    friction. drag_area: m^2, drag coefficient times frontal area.
    """

    slope: float = 0.0
    tricycle_mass: float = 20.0
    rolling_mass: float = 3.0
    rolling_resistance: float = 0.008
    drag_area: float = 0.4

    @property
    def angle(self) -> float:
        """Of the slope, rad."""
        return math.atan(self.slope)

    @property
    def drag(self) -> float:
        """Air's force per speed squared, N s^2/m^2."""
        return AIR_DENSITY * self.drag_area / 2


class Load(NamedTuple):
    """What a ride's tricycle weighs and what the road does to it."""

    body_mass: float  # kg: rider without legs, and tricycle
    weight: float  # N, of all that moves
    inertia: float  # kg: all that moves along the road, the rims twice
    rolling: float  # N, against any motion
    climb: float  # N, downhill
    drag: float  # N s^2/m^2


@dataclass(frozen=True, eq=False)
class Ride:
    """A design with both legs on a road, driven by joint moments that follow the crank angle.

    transmission: one of TRANSMISSIONS. lag: time constant of the muscles' answer, s. launch: speed at the start, m/s; 0
    is a start from rest. start: crank angle there, rad. duration: s. Whether the moments depend on joint speed is up
    to moments.torque_velocity.
    """

    design: Design
    moments: JointMoments
    road: Road = field(default_factory=Road)
    transmission: str = "freewheel"
    lag: float = 0.0
    launch: float = TRICYCLE_SPEED
    start: float = 0.0
    duration: float = 60.0

    @property
    def fixed(self) -> bool:
        return self.transmission == "fixed"

    @property
    def name(self) -> str:
        """Design, moments, transmission and slope."""
        return f"{self.design.name} {self.moments.name} {self.transmission} {100 * self.road.slope:.3g} %"

    @property
    def travel(self) -> float:
        """Road per crank angle, m/rad."""
        return WHEEL_DIAMETER / 2 / self.design.linkage.gear_ratio

    @property
    def load(self) -> Load:
        """The tricycle's masses with this rider and linkage, and the forces of the road."""
        parts, road, rider = inertias(self.design), self.road, self.design.rider
        limbs = len(TWO_LEGS) * sum(parts[body].mass for body in ("thigh", "shank"))
        moving = len(TWO_LEGS) * sum(part.mass for part in parts.values())
        body = rider.mass - limbs + road.tricycle_mass
        weight = GRAVITY * (body + moving)
        return Load(
            body_mass=body,
            weight=weight,
            inertia=body + moving + road.rolling_mass,
            rolling=road.rolling_resistance * weight * math.cos(road.angle),
            climb=weight * math.sin(road.angle),
            drag=road.drag,
        )


def balancing_slope(ride: Ride, speed: float = TRICYCLE_SPEED) -> float:
    """Slope (rise per run) on which the mean power of speed-free muscles just keeps a steady speed (m/s).

    Statics of a crank at constant speed: what the mean power of both legs leaves after rolling resistance and air.
    Raises InputError as quasi_static, and where that power would climb a wall.
    """
    cadence = speed / ride.travel
    legs = (replace(ride.moments.of_leg(leg.prefix), torque_velocity=None) for leg in TWO_LEGS)
    power = sum(quasi_static(ride.design, moments, cadence).power_mean for moments in legs)
    level = replace(ride, road=replace(ride.road, slope=0.0)).load
    rolling = ride.road.rolling_resistance
    # rolling cos b + sin b = sqrt(1 + rolling^2) sin(b + atan rolling)
    along = (power / speed - level.drag * speed**2) / (level.weight * math.hypot(1.0, rolling))
    if abs(along) >= 1:
        raise InputError(f"{ride.name}: no slope takes {power:.3g} W at {speed / KMH:.3g} km/h")
    return math.tan(math.asin(along) - math.atan(rolling))


@dataclass(frozen=True, eq=False)
class Trace:
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
        """Turns at the end over which a ride is described; 0 if it stopped or made none."""
        return min(LAST_TURNS, math.floor(self.turns)) if self.rides else 0

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

    def summary(self) -> dict[str, Any]:
        """The result as JSON names and units it."""
        ride, relation = self.ride, self.ride.moments.torque_velocity
        speed, cadence = self.mean_speed, self.cadence
        return {
            "design": ride.design.name,
            "group": ride.moments.name,
            "torque_velocity": relation.name if relation else None,
            "transmission": ride.transmission,
            "slope_percent": 100 * ride.road.slope,
            "lag_s": ride.lag,
            "launch_kmh": ride.launch / KMH,
            "start_deg": math.degrees(ride.start),
            "duration_s": ride.duration,
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
