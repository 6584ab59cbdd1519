"""The MJCF model of the ride: a tricycle that slides along the road, its legs hung on it; nothing holds the cadence."""

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import mujoco
import numpy as np

from fes_mj.linkage import kinematics
from fes_mj.linkage.inertia import GRAVITY
from fes_mj.linkage.legs import TWO_LEGS
from fes_mj.simulation.appearance import Spec
from fes_mj.simulation.bench import add_motor_sensors
from fes_mj.simulation.mjcf import (
    COMPLETE,
    INTEGRATORS,
    LOOP_SOLIMP,
    LOOP_SOLREF,
    NO_MINUS,
    ModelOptions,
    add_keyframe,
    add_motors,
    build_mjcf,
    joint_motion,
)

if TYPE_CHECKING:
    from fes_mj.riding import ride  # with machine code, of which a bench needs nothing

ROAD, DRIVETRAIN = "road", "drivetrain"  # the joint along the road, m; the tendon road / travel - crank, rad
# At 60 rpm finer than on the bench. At the 250 rpm that D1 reaches on the flat it makes 1200 steps a turn, and the
# scheme loses less than 4e-4 of the muscles' work.
TIMESTEP = 2e-4  # s
# MuJoCo asks whether a tendon is shorter than its limit plus this. At zero, rounding would open the freewheel.
TENDON_MARGIN = 1e-9  # rad
_FORWARD = (-1.0, 0.0, 0.0)
_FAR = 1e6  # rad, an upper limit that is never reached: MuJoCo has no one-sided range


def build_road_mjcf(
    ride: "ride.Ride", timestep: float = TIMESTEP, *, integrator: str = "discrete", options: ModelOptions = COMPLETE
) -> Spec:
    """The model of build_mjcf with both legs, set on the road at the ride's start.

    integrator: one of mjcf.INTEGRATORS; the scheme of ride_on_road is made for `discrete`. options: as of build_mjcf,
    but that nothing holds the cadence; if `compatible` without what MJX does not know, the sensor of the freewheel.

    The tricycle gets its mass and the slide joint `road`; rims are its armature, rolling resistance its friction, air
    its damping. The slope tilts gravity. The tendon `drivetrain` is road less crank: a fixed gear holds its length; a
    freewheel only keeps it from becoming shorter, and whoever steps the model raises that limit to the length reached.
    """
    spec = build_mjcf(ride.design, timestep=timestep, legs=len(TWO_LEGS), options=replace(options, driven=False))
    spec.option.timestep, spec.option.integrator = timestep, INTEGRATORS[integrator]
    spec.comment = f"{ride.name}: both legs on a tricycle that rides"
    spec.option.gravity = (GRAVITY * math.sin(ride.road.angle), 0.0, -GRAVITY * math.cos(ride.road.angle))
    load = ride.load
    body = spec.body("tricycle")
    body.mass, body.ipos, body.inertia = load.body_mass, (0.0, 0.0, 0.0), [load.body_mass] * 3  # it never turns
    body.explicitinertial = True
    slide = body.add_joint(name=ROAD, type=mujoco.mjtJoint.mjJNT_SLIDE, axis=_FORWARD)
    slide.armature, slide.frictionloss = ride.road.rolling_mass, load.rolling
    slide.damping = (0.0, load.drag, 0.0)
    slide.solref_friction, slide.solimp_friction = LOOP_SOLREF, LOOP_SOLIMP
    _add_drivetrain(spec, ride)
    if options.driven:
        add_motors(spec, TWO_LEGS)
    _add_sensors(spec, ride, options)
    spec.delete(spec.key("start"))
    add_keyframe(spec, start_state(ride))
    return spec


def _add_drivetrain(spec: Spec, ride: "ride.Ride") -> None:
    tendon = spec.add_tendon(name=DRIVETRAIN)
    tendon.wrap_joint(ROAD, 1 / ride.travel)
    tendon.wrap_joint("crank", -1.0)
    if ride.fixed:
        gear = spec.add_equality(name=DRIVETRAIN, type=mujoco.mjtEq.mjEQ_TENDON)
        gear.name1, gear.data[0] = DRIVETRAIN, NO_MINUS - ride.start
        gear.solref, gear.solimp = LOOP_SOLREF, LOOP_SOLIMP
    else:
        tendon.limited, tendon.margin = mujoco.mjtLimited.mjLIMITED_TRUE, TENDON_MARGIN
        tendon.range = NO_MINUS - ride.start, _FAR
        tendon.solref_limit, tendon.solimp_limit = LOOP_SOLREF, LOOP_SOLIMP


def _add_sensors(spec: Spec, ride: "ride.Ride", options: ModelOptions) -> None:
    kinds, objects = mujoco.mjtSensor, mujoco.mjtObj
    for name, kind in ((f"{ROAD}_angle", kinds.mjSENS_JOINTPOS), (f"{ROAD}_speed", kinds.mjSENS_JOINTVEL)):
        spec.add_sensor(name=name, type=kind, objtype=objects.mjOBJ_JOINT, objname=ROAD)
    if options.driven:
        add_motor_sensors(spec, TWO_LEGS)
    if not ride.fixed and not options.compatible:
        spec.add_sensor(
            name=DRIVETRAIN, type=kinds.mjSENS_TENDONLIMITFRC, objtype=objects.mjOBJ_TENDON, objname=DRIVETRAIN
        )


def start_state(
    ride: "ride.Ride", before: float = 0.0, gain: dict[str, float] | None = None
) -> dict[str, tuple[float, float]]:
    """Position of every joint, and its mean speed over the time `before` (s) that; with none its speed then.

    gain: acceleration of road (m/s^2) and crank (rad/s^2) in that time, by name.
    """
    speed = {ROAD: ride.launch, "crank": ride.launch / ride.travel}
    earlier = {name: speed[name] - before / 2 * (gain or {}).get(name, 0.0) for name in speed}
    state = {ROAD: (0.0, earlier[ROAD]), "crank": (ride.start, earlier["crank"])}
    for leg in TWO_LEGS:
        turn = ride.start - leg.lag - np.array([0.0, earlier["crank"] * before])
        for joint, (angle, rate, _) in joint_motion(kinematics.solve(ride.design, turn)).items():
            now, then = np.unwrap(angle)
            state[leg.prefix + joint] = float(now), float((now - then) / before if before else speed["crank"] * rate[0])
    return state
