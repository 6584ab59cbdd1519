"""Variants of the exported model: what drives the joints, what the crank meets, legs, anchors, and who reads it."""

import math
from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from fes_mj.common.errors import InputError, require_one_of
from fes_mj.common.units import RPM
from fes_mj.linkage.design import Design
from fes_mj.linkage.joints import JOINTS
from fes_mj.linkage.legs import LEGS, TWO_LEGS
from fes_mj.moments.joint_moments import JointMoments
from fes_mj.moments.torque_map import torque_map
from fes_mj.muscles.drive import Muscles
from fes_mj.simulation.appearance import Spec
from fes_mj.simulation.mjcf import INTEGRATORS, SERVO, ModelOptions, build_mjcf
from fes_mj.simulation.native_muscles import native_muscles
from fes_mj.simulation.road_mjcf import build_road_mjcf
from fes_mj.simulation.time_step import steps_per_turn
from fes_mj.statics.drive import Drive
from fes_mj.statics.turn import LegTurns

# Variant -> what it sets: what the crank meets (servo, if nothing is said), how the tricycle of the road is geared, how
# many legs, or a field of ModelOptions. Several may be combined unless they set the same thing differently.
VARIANTS: dict[str, dict[str, Any]] = {
    "sites": {"anchors": "sites"},
    "bodies": {"anchors": "bodies"},
    "passive": {"driven": False},
    "free": {"crank": "free"},
    "brake": {"crank": "brake"},
    "ride": {"crank": "road", "legs": len(TWO_LEGS)},  # nobody rides on one
    "fixed-gear": {"transmission": "fixed"},
    "two-legs": {"legs": len(TWO_LEGS)},
    "muscles": {"driven": True, "motors": False, "crank": "servo"},  # activations belong to a cadence that is held
    "compatible": {"compatible": True},
}
# Where the tricycle's inertia or its like rests on the crank, one evaluation a step keeps the energy well enough.
LADEN = "implicitfast"
# A motor's range per largest moment of the torque map: a controller may want more than that.
HEADROOM = 2.0
RANGE_STEP = 5.0  # N m, to which ranges are rounded up


def variant_options(variants: Iterable[str]) -> dict[str, Any]:
    """What a combination of variants sets. Raises InputError for unknown ones and for those that make no sense."""
    options: dict[str, Any] = {}
    variant_of: dict[str, str] = {}
    for name in variants:
        require_one_of("variant", name, VARIANTS)
        for key, value in VARIANTS[name].items():
            if options.setdefault(key, value) != value:
                raise InputError(f"the variants {variant_of[key]} and {name} exclude each other; give one of them")
            variant_of.setdefault(key, name)
    if "transmission" in options and options.get("crank") != "road":
        raise InputError("the variant fixed-gear is about the tricycle on the road; give it with ride")
    return options


def variant_model(design: Design, drive: Drive, cadence: float, options: Mapping[str, Any]) -> Spec:
    """The model at a cadence (rad/s) with what variant_options gives.

    Joint moments set the range of the motors and the strength of the brake; muscles are added as MuJoCo's own. Raises
    InputError as build_mjcf, for a brake where the moments deliver no power, and where the drive is not the variant's.
    """
    if isinstance(drive, Muscles) == options.get("motors", True):
        raise InputError("the variant muscles and stimulated muscles (load_muscles) belong together; give both or none")
    if isinstance(drive, Muscles):
        spec = _muscle_model(design, drive, cadence, dict(options))
    else:
        spec = _moment_model(design, drive, cadence, dict(options))
    for actuator in spec.actuators:
        if actuator.name == SERVO:
            actuator.ctrlrange, actuator.ctrllimited = (0.0, 2 * cadence), True
    return spec


def _muscle_model(design: Design, drive: Muscles, cadence: float, content: dict[str, Any]) -> Spec:
    muscles, legs = native_muscles(design, drive, cadence), content.pop("legs", 1)
    del content["crank"]  # held, as all of ModelOptions says already
    spec = build_mjcf(design, cadence=cadence, legs=legs, options=ModelOptions(**content))
    muscles.add_to(spec, LEGS[legs])
    spec.comment += f"; {drive.driver}: {muscles.sentence}"
    return spec


def _moment_model(design: Design, moments: JointMoments, cadence: float, content: dict[str, Any]) -> Spec:
    crank, transmission = content.pop("crank", "servo"), content.pop("transmission", "freewheel")
    legs, timestep = content.pop("legs", 1), None
    model = ModelOptions(held=crank == "servo", **content)
    if crank == "road":
        from fes_mj.riding.ride import Ride  # with machine code, of which other variants need nothing

        ride = Ride(design, moments, transmission=transmission)
        spec = build_road_mjcf(replace(ride, launch=cadence * ride.travel), integrator=LADEN, options=model)
    else:
        if crank == "brake":  # the flywheel lets no turn be much faster
            timestep = 2 * math.pi / cadence / steps_per_turn(design, cadence)
        spec = build_mjcf(design, cadence=cadence, timestep=timestep, legs=legs, options=model)
    if crank == "brake":
        _add_brake(spec, design, moments, cadence, legs)
    _limit_motors(spec, moments)
    return spec


def _add_brake(spec: Spec, design: Design, moments: JointMoments, cadence: float, legs: int) -> None:
    """An ergometer: a flywheel with the tricycle's inertia, and a brake that takes the muscles' power at the cadence.

    The brake's moment grows with the crank's speed. The work per turn of moments that do not depend on speed then asks
    for just this cadence, as a mean over the crank angle.
    """
    power = legs * LegTurns.solve(design, moments, cadence, legs).power_mean
    if power <= 0:
        raise InputError(
            f"{design.name}, {moments.name}: the moments deliver {power:.3g} W at {cadence / RPM:.4g} rpm, so there is "
            "nothing for a brake to take; leave out the variant brake, or give free"
        )
    spec.option.integrator = INTEGRATORS[LADEN]
    from fes_mj.riding.ride import Ride

    ride, crank = Ride(design, moments), spec.joint("crank")
    crank.armature = ride.load.inertia * ride.travel**2
    crank.damping = (power / cadence**2, 0.0, 0.0)


def _limit_motors(spec: Spec, moments: JointMoments) -> None:
    """Ranges of the joints' motors in N m, either way."""
    for actuator in spec.actuators:
        if actuator.name == SERVO:
            continue
        joint = next(joint for joint in JOINTS if actuator.name.endswith(joint))
        largest = float(np.abs(torque_map(moments.of_leg(actuator.name)).table[joint]).max())
        limit = RANGE_STEP * max(1, math.ceil(HEADROOM * largest / RANGE_STEP))
        actuator.ctrlrange, actuator.ctrllimited = (-limit, limit), True
