"""Where a ride starts from rest, what launch it needs, what slope it climbs; by the reduced equation of motion."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from fes_mj.common.arrays import BoolArray, FloatArray
from fes_mj.common.brief import Brief
from fes_mj.common.errors import require_extra, require_within
from fes_mj.common.units import KMH
from fes_mj.linkage.design import TRICYCLE_SPEED
from fes_mj.riding.ride import Ride
from fes_mj.riding.trace import ride as solved

START_ANGLES = 72  # crank angles that are tried, over half a turn: the legs are alike, half a turn apart
FASTEST_LAUNCH = 25 * KMH  # m/s
STEEPEST = 0.3  # rise per run; the steepest streets there are have 0.35
LAUNCH_STEP, SLOPE_STEP = 0.05 * KMH, 1e-4  # to which launch and slope are sought


@dataclass(frozen=True, eq=False, repr=False)
class Starts(Brief):
    """How a ride begins and what it climbs.

    crank_angle: rad, over a turn, shape (2 * angles,). works: whether it still rides at the ride's end when started
    from rest there. launch: least speed with which it rides from each of them, m/s. slope: steepest that it still rides
    on at the end when launched at the ride's speed. Both None where nothing that was tried does.
    """

    ride: Ride
    crank_angle: FloatArray
    works: BoolArray
    launch: float | None
    slope: float | None

    @property
    def brief(self) -> str:
        launch = "no launch keeps it going" if self.launch is None else f"anywhere at {self.launch / KMH:.1f} km/h"
        return f"{self.ride.name}: from rest at {100 * self.share:.0f} % of the crank angles, {launch}"

    @property
    def share(self) -> float:
        """Part of all crank angles from which it starts."""
        return float(self.works.mean())

    def summary(self) -> dict[str, Any]:
        """The result as JSON names and units it."""
        return {
            "start_share": self.share,
            "launch_speed_kmh": None if self.launch is None else self.launch / KMH,
            "slope_limit_percent": None if self.slope is None else 100 * self.slope,
            "start_angles_deg": np.degrees(self.crank_angle[self.works]),
        }


def starts(ride: Ride, angles: int = START_ANGLES) -> Starts:
    """Try rides from rest, launches and slopes. angles: crank angles that are tried, over half a turn.

    A faster launch and a gentler slope are taken to do whatever a slower and a steeper one do. Raises InputError as
    trace.ride, MissingPartError without numba: hundreds of rides in Python would take an hour.

    >>> ride = fes_mj.Ride(fes_mj.load_design("r2"), fes_mj.load_moments("p1p2"), duration=5)
    >>> fes_mj.starts(ride, angles=4)
    <Starts r2 p1p2 freewheel 0 %: from rest at 50 % of the crank angles, anywhere at 1.4 km/h>
    """
    require_extra("optimize", "numba")
    require_within("angles", angles, 1)
    half_turn = np.linspace(0, np.pi, angles, endpoint=False)

    def rides(**changes: Any) -> bool:
        return solved(replace(ride, **changes)).rides

    works = np.array([rides(launch=0.0, start=angle) for angle in half_turn])
    order = [*half_turn[~works], *half_turn[works]]

    def everywhere(launch: float) -> bool:
        for place, angle in enumerate(order):
            if not rides(launch=launch, start=angle):
                order.insert(0, order.pop(place))  # the next launch will most likely fail there as well
                return False
        return True

    launch = 0.0 if works.all() else _boundary(everywhere, FASTEST_LAUNCH, 0.0, LAUNCH_STEP)
    start = {"launch": ride.launch or TRICYCLE_SPEED, "start": ride.start}
    slope = _boundary(lambda s: rides(road=replace(ride.road, slope=s), **start), -STEEPEST, STEEPEST, SLOPE_STEP)
    return Starts(ride, np.concatenate([half_turn, half_turn + np.pi]), np.tile(works, 2), launch, slope)


def _boundary(holds: Callable[[float], bool], good: float, bad: float, step: float) -> float | None:
    """The value nearest to `bad` at which something holds, within a step; None if it does not even at `good`."""
    if not holds(good):
        return None
    while abs(bad - good) > step:
        middle = (good + bad) / 2
        if holds(middle):
            good = middle
        else:
            bad = middle
    return good
