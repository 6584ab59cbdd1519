"""A ride on a road: what is ridden, and against what."""

import math
from dataclasses import dataclass, field, replace
from typing import Any, NamedTuple

import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.common.brief import Brief
from fes_mj.common.errors import InputError, require_one_of, require_within
from fes_mj.common.units import KMH
from fes_mj.linkage.design import TRICYCLE_SPEED, WHEEL_DIAMETER, Design
from fes_mj.linkage.inertia import GRAVITY, CrankInertia, inertias
from fes_mj.linkage.legs import TWO_LEGS
from fes_mj.moments.joint_moments import JointMoments
from fes_mj.riding.leg_table import LegTable, leg_table
from fes_mj.riding.stimulated import StimulatedRider
from fes_mj.statics.turn import LegTurns
from fes_mj.statics.validity import turning_in_range

TRANSMISSIONS = ("freewheel", "fixed")
SHORTEST_RIDE = 1e-6  # s, of a ride
AIR_DENSITY = 1.2  # kg/m^3, at 20 deg C and sea level


@dataclass(frozen=True)
class Road:
    """The tricycle's masses and what holds it back.

    slope: rise per horizontal run. tricycle_mass: kg, wheels included, without crank and linkage. rolling_mass: kg, of
    the rims, which turn as well as move and so count twice as inertia. rolling_resistance: force per weight, a dry
    friction. drag_area: m^2, drag coefficient times frontal area.

    >>> road = fes_mj.Road(slope=0.01)
    >>> fes_mj.Ride(fes_mj.load_design("r2"), fes_mj.load_moments(), road, transmission="fixed")
    <Ride r2 p1p2 fixed 1 %>
    """

    slope: float = 0.0
    tricycle_mass: float = 20.0
    rolling_mass: float = 3.0
    rolling_resistance: float = 0.008
    drag_area: float = 0.4

    def require_possible(self) -> None:
        """Raise InputError for numbers that no road has."""
        require_within("slope", self.slope, -1, 1)
        for name in ("tricycle_mass", "rolling_mass", "rolling_resistance", "drag_area"):
            require_within(name, getattr(self, name), 0)

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
    upright: float  # m/s^2, gravity's part across the road
    along: float  # m/s^2, and down it


@dataclass(frozen=True, eq=False, repr=False)
class Ride(Brief):
    """A design with both legs on a road, driven by stimulated muscles, or joint moments that follow the crank angle.

    transmission: one of TRANSMISSIONS. launch: speed at the start, m/s; 0 is a start from rest. start: crank angle
    there, rad. duration: s.

    >>> fes_mj.Ride(fes_mj.load_design("d1"), fes_mj.load_moments("p1p2"), duration=20)
    <Ride d1 p1p2 freewheel 0 %>
    """

    design: Design
    drive: JointMoments | StimulatedRider
    road: Road = field(default_factory=Road)
    transmission: str = "freewheel"
    launch: float = TRICYCLE_SPEED
    start: float = 0.0
    duration: float = 60.0

    @property
    def brief(self) -> str:
        return self.name

    @property
    def fixed(self) -> bool:
        return self.transmission == "fixed"

    @property
    def name(self) -> str:
        """Design, drive, transmission and slope."""
        return f"{self.design.name} {self.drive.name} {self.transmission} {100 * self.road.slope:.3g} %"

    @property
    def travel(self) -> float:
        """Road per crank angle, m/rad."""
        return WHEEL_DIAMETER / 2 / self.design.linkage.gear_ratio

    def require_possible(self) -> None:
        """Raise AssemblyError if the linkage does not turn, InputError for joints that the drive knows nothing of.

        InputError also for a transmission that is none, and numbers that are.
        """
        require_within("duration", self.duration, SHORTEST_RIDE, unit="s")
        require_within("launch", self.launch, 0, unit="m/s")
        require_within("start", self.start, -math.inf, unit="rad")
        self.road.require_possible()
        require_one_of("transmission", self.transmission, TRANSMISSIONS)
        if isinstance(self.drive, JointMoments):
            for leg in TWO_LEGS:
                turning_in_range(self.design, self.drive.of_leg(leg.prefix).measured_on)
        else:
            self.drive.require_range(self.design)

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
            upright=GRAVITY * math.cos(road.angle),
            along=GRAVITY * math.sin(road.angle),
        )

    @property
    def table(self) -> LegTable:
        """Masses and drive of both legs over the crank angle."""
        return leg_table(self.design, self.drive)

    def summary(self) -> dict[str, Any]:
        """What is ridden as JSON names and units it."""
        drive = self.drive
        return {
            "design": self.design.name,
            **({"drive": "moments", "group": drive.name} if isinstance(drive, JointMoments) else drive.summary()),
            "transmission": self.transmission,
            "slope_percent": 100 * self.road.slope,
            "launch_kmh": self.launch / KMH,
            "start_deg": math.degrees(self.start),
            "duration_s": self.duration,
        }


def balancing_slope(ride: Ride, speed: float = TRICYCLE_SPEED) -> float:
    """Slope (rise per run) on which the mean power just keeps a steady speed (m/s).

    Statics of a crank at constant speed: what the mean power of both legs leaves after rolling resistance and air.
    Raises InputError as quasi_static, and where that power would climb a wall.
    """
    cadence = speed / ride.travel
    drive = ride.drive
    if isinstance(drive, JointMoments):
        of_a_leg = LegTurns.solve(ride.design, drive, cadence, len(TWO_LEGS)).power_mean
    else:
        of_a_leg = drive.power_mean(ride.design, cadence)
    power = len(TWO_LEGS) * of_a_leg
    level = replace(ride, road=replace(ride.road, slope=0.0)).load
    rolling = ride.road.rolling_resistance
    # rolling cos b + sin b = sqrt(1 + rolling^2) sin(b + atan rolling)
    along = (power / speed - level.drag * speed**2) / (level.weight * math.hypot(1.0, rolling))
    if abs(along) >= 1:
        raise InputError(f"{ride.name}: no slope takes {power:.3g} W at {speed / KMH:.3g} km/h")
    return math.tan(math.asin(along) - math.atan(rolling))


_BISECTIONS = 40  # of the energy: what is left of the interval is rounding


def steady_ripple(ride: Ride) -> float:
    """Largest less smallest crank speed per its mean, once a fixed gear rides evenly at the ride's launch speed.

    Against a constant force that takes the mean power; see even_ripple.
    """
    table, turn = ride.table, slice(-1)
    return float(even_ripple(ride, table.push[turn], CrankInertia(*(curve[turn] for curve in table.masses))))


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
