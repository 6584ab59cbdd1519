"""How the faults of rides in data/faults.toml are made, each in one of a ride's two solvers."""

import math
from collections.abc import Callable
from dataclasses import replace
from functools import cached_property
from typing import Any

import mujoco
import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.crosscheck.ride_case import RideCase
from fes_mj.linkage.legs import TWO_LEGS
from fes_mj.riding.ride import Ride
from fes_mj.riding.trace import ride as ride_by_equation
from fes_mj.simulation.road import RoadRun
from fes_mj.simulation.road_control import RoadControl
from fes_mj.simulation.road_mjcf import DRIVETRAIN, ROAD
from fes_mj.verification.faults import Steps, in_model


def in_equation(change: Callable[[Ride], Ride]) -> Steps:
    """The reduced equation of motion is that of a changed ride."""
    return {"reference": cached_property(lambda case: ride_by_equation(change(case.ride)))}


def in_control(**changes: Callable[[Any], Any]) -> Steps:
    """The control in MuJoCo has changed fields."""

    def control(case: RideCase, model: mujoco.MjModel) -> RoadControl:
        known = RideCase.control(case, model)
        return known._replace(**{name: change(getattr(known, name)) for name, change in changes.items()})

    return {"control": control}


class OneLegCounted(RoadRun):
    legs = TWO_LEGS[:1]


class RollingUnsigned(RoadRun):
    def resistance(self, speed: FloatArray) -> FloatArray:
        load = self.ride.load
        return np.asarray(load.rolling + load.climb + load.drag * speed * np.abs(speed))


def other_way(limits: FloatArray) -> FloatArray:
    """A range that ends where it began."""
    return np.array([-limits[1], limits[0]])


# Step of a RideCase -> what takes its place, by the name of the fault in data/faults.toml.
RIDE_STEPS: dict[str, Steps] = {
    "freewheel_reversed": in_model("tendons", DRIVETRAIN, range=other_way) | in_control(fixed=lambda _: True),
    "rims_once": in_model("joints", ROAD, armature=0.0),
    "slope_reversed": in_equation(lambda ride: replace(ride, road=replace(ride.road, slope=-ride.road.slope))),
    "air_twice": in_model("joints", ROAD, damping=lambda damping: 2 * np.asarray(damping)),
    "left_leg_unshifted": in_control(leg_lag=np.zeros_like),
    "moments_late": in_control(leg_lag=lambda lag: lag + math.radians(10)),
    "one_leg_counted": {"record": OneLegCounted},
    "rolling_unsigned": {"record": RollingUnsigned},
}
