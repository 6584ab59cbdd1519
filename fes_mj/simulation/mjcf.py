"""MJCF of the rider's leg(s) and the linkage, written with MjSpec; loops are closed by `connect` constraints.

The plane of the paper becomes MuJoCo's x-z plane: x backwards, z up, y to the rider's right. Angles grow
counter-clockwise in the paper's view, that is about -y. The joint coordinates are the paper's: `hip` is
phi_h, `knee` is phi_k, `crank` is theta_2.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Literal

import mujoco
import numpy as np

from fes_mj.common.errors import InputError
from fes_mj.common.units import RPM
from fes_mj.linkage import kinematics
from fes_mj.linkage.design import Design
from fes_mj.linkage.inertia import GRAVITY, Inertia, combine, inertias
from fes_mj.linkage.kinematics import Motion
from fes_mj.linkage.legs import LEGS, Leg
from fes_mj.linkage.turning import turning
from fes_mj.linkage.variables import crank_speed
from fes_mj.simulation import appearance
from fes_mj.simulation.appearance import Spec
from fes_mj.simulation.time_step import loose_steps, steps_per_turn

INTEGRATORS = {
    "discrete": mujoco.mjtIntegrator.mjINT_DISCRETE,
    "euler": mujoco.mjtIntegrator.mjINT_EULER,
    "implicitfast": mujoco.mjtIntegrator.mjINT_IMPLICITFAST,
    "rk4": mujoco.mjtIntegrator.mjINT_RK4,
}
SERVO = "crank_servo"
SERVO_GAIN = 1e11  # N m s/rad; 1e6 lets the cadence ripple by twice its limit at 1 rpm (results/settings.md)
FLYWHEEL = 1e6  # kg m^2 of crank armature; holds the cadence to 1e-6 without a servo
# What MuJoCo's defaults (0.02 s, 0.9) and 1e-5 s do instead is in results/settings.md. Other integrators than
# `discrete` raise the time constant to two time steps.
LOOP_SOLREF = (1e-7, 1.0)
LOOP_SOLIMP = (0.9999, 0.9999, 0.001, 0.5, 2.0)

# Angles grow counter-clockwise in the paper's view, which is about -y.
AXIS = (0.0, -1.0, 0.0)
# MuJoCo's compiler takes a site or a centre of mass within 1e-6 m of its body's origin, or of each other, for that very
# place, but not if their frames are turned against each other: so offsets stay exact. Half turns, as quaternions.
SITE_TURN, INERTIA_TURN = (0.0, 0.0, 1.0, 0.0), (0.0, 0.0, 0.0, 1.0)
# Added to make -0.0 a plain 0.0: MuJoCo leaves values that equal the default out of the file, and the sign with them.
NO_MINUS = 0.0

# Joints that are cut and closed again by a constraint: passive pins without drive, limit or friction.
CUTS = ("pedal", "crank_pin")


@dataclass(frozen=True)
class Physics:
    """What may differ from the leg that a model stands for.

    mass_scale: factor on every mass and inertia. gravity: m/s^2. loop_solref: MuJoCo's time constant (s) and damping
    ratio of the loops, by default LOOP_SOLREF.
    """

    mass_scale: float = 1.0
    gravity: float = GRAVITY
    loop_solref: tuple[float, float] | None = None


REAL = Physics()


@dataclass(frozen=True)
class ModelOptions:
    """What a model contains.

    anchors: what the loops are closed between. driven: joint motors, unless without `motors` something else is to be
    added, and, if also `held`, a cadence that is held: by a servo, which needs the integrator `discrete`, or if
    `compatible` by a flywheel, which Euler bears. Where nothing holds the crank, Runge-Kutta of fourth order keeps the
    energy, in steps short enough for the fastest turn.
    drawn: geoms, which are pictures only and cost a fifth of a step.
    """

    physics: Physics = REAL
    anchors: Literal["sites", "bodies"] = "sites"
    driven: bool = True
    motors: bool = True
    held: bool = True
    compatible: bool = False
    drawn: bool = True


COMPLETE, UNDRAWN = ModelOptions(), ModelOptions(drawn=False)


def build_mjcf(
    design: Design,
    *,
    cadence: float | None = None,
    timestep: float | None = None,
    legs: int = 1,
    options: ModelOptions = COMPLETE,
) -> Spec:
    """The model of a design at a cadence (rad/s, by default Eq. 16), assembled, with a keyframe at crank angle 0.

    timestep: s; rounded so that a turn is a whole number of steps, and by default chosen by time_step. legs: 1, or 2
    half a turn apart on one crank. Raises AssemblyError if the linkage does not close, InputError if MuJoCo refuses it.

    >>> model = fes_mj.build_mjcf(fes_mj.load_design("d1")).compile()
    >>> model.nv, model.nu
    (5, 3)
    """
    turning(design)
    pair, physics, held = LEGS[legs], options.physics, options.driven and options.held
    cadence = crank_speed(design, cadence)
    spec = mujoco.MjSpec()
    spec.modelname = design.name
    spec.comment = f"{design.name}: {design.linkage.title}, {cadence / RPM:.2f} rpm"
    # as authored and at full precision: the default output has six digits, half a micrometre of loop error
    spec.compiler.savecompiled = spec.compiler.savecanonical = False
    spec.compiler.degree = False
    loose = not held and timestep is None
    steps = loose_steps(design, cadence, legs, physics.gravity) if loose else steps_per_turn(design, cadence, timestep)
    integrator = "rk4" if not held else "euler" if options.compatible else "discrete"
    set_options(spec, 2 * math.pi / cadence / steps, physics.gravity, integrator)
    shared = _set_defaults(spec, physics.loop_solref or LOOP_SOLREF)
    if options.drawn:
        appearance.define_parts(spec, shared)
    # one fixed root: some readers drop all bodies but the first
    root = spec.worldbody.add_body(name="tricycle", childclass="tricycle")
    scale = physics.mass_scale
    masses = {body: Inertia(scale * m, centre, scale * i) for body, (m, centre, i) in inertias(design).items()}
    arm, turns = masses["crank"], [appearance.on_body(leg, "crank")[1] for leg in pair]
    masses["crank"] = combine(*(arm._replace(centre=arm.centre * turn) for turn in turns))
    crank = add_body(root, "crank", position(design.linkage.crank_centre), masses["crank"])
    crank.add_site(name="crank_torque")
    state = {"crank": (0.0, cadence)}
    for leg in pair:
        joints = joint_motion(kinematics.solve(design, np.array([-leg.lag])))
        start = {joint: (float(angle[0]), cadence * float(rate[0])) for joint, (angle, rate, _) in joints.items()}
        _add_leg(spec, root, design, leg, masses, start, options.anchors)
        state |= {leg.prefix + joint: values for joint, values in start.items()}
    if options.drawn:
        appearance.draw_bodies(spec, design, pair)
    if options.driven and options.motors:
        add_motors(spec, pair)
    if held and options.compatible:  # its integrator bears no servo
        spec.joint("crank").armature = FLYWHEEL
    elif held:
        servo = spec.add_actuator(name=SERVO, trntype=mujoco.mjtTrn.mjTRN_JOINT, target="crank")
        servo.set_to_velocity(kv=SERVO_GAIN)
    _add_sensors(spec)
    add_keyframe(spec, state, [cadence if motor.name == SERVO else 0.0 for motor in spec.actuators])
    return spec


def joint_motion(motion: Motion) -> dict[str, tuple[Any, Any, Any]]:
    """Angle (rad) of every joint of a leg but the crank, and its first two derivatives by the crank angle."""
    rotation, angle = motion.rotation, motion.joint_angle
    joints = {joint: (angle[joint], *turn) for joint, turn in motion.joint_rotation.items()}
    if "rocker" in rotation:
        rocker, coupler = motion.direction("rocker"), motion.direction("coupler")
        joints["rocker"] = (np.angle(rocker), *rotation["rocker"])
        joints["coupler"] = (np.angle(coupler / rocker), *(rotation["coupler"] - rotation["rocker"]))
    return joints


def set_options(spec: Spec, timestep: float, gravity: float, integrator: str = "discrete") -> None:
    """Solver options for closed planar loops: time step in s, gravity in m/s^2 along -z."""
    option = spec.option
    option.timestep = timestep
    option.gravity = (0.0, 0.0, -gravity)
    option.integrator = INTEGRATORS[integrator]
    option.solver = mujoco.mjtSolver.mjSOL_NEWTON
    option.jacobian = mujoco.mjtJacobian.mjJAC_DENSE  # 4.0.0's sparse Newton Hessian is wrong
    option.disableflags = int(mujoco.mjtDisableBit.mjDSBL_CONTACT | mujoco.mjtDisableBit.mjDSBL_ISLAND)


def _set_defaults(spec: Spec, loop_solref: tuple[float, float]) -> Spec:
    """The default class `tricycle`: what all joints, loops, sites and geoms of the model share."""
    shared = spec.add_default("tricycle", spec.default)
    shared.joint.axis = AXIS
    shared.equality.solref, shared.equality.solimp = loop_solref, LOOP_SOLIMP
    shared.site.group, shared.site.size = 4, [0.005] * 3  # hidden unless asked for
    shared.site.quat = SITE_TURN
    # geoms are pictures: no mass, no contact
    shared.geom.density, shared.geom.contype, shared.geom.conaffinity, shared.geom.group = 0, 0, 0, 2
    return shared


def position(point: complex, lateral: float = 0.0) -> tuple[float, float, float]:
    return (float(np.real(point)) + NO_MINUS, lateral, float(np.imag(point)) + NO_MINUS)


def add_body(
    parent: Spec,
    name: str,
    pos: tuple[float, float, float],
    inertia: Inertia,
    *,
    joint: str = "",
    angle: float = 0.0,
    turned: float = 0.0,
    sense: int = 1,
) -> Spec:
    """A body with one hinge at its origin, posed at the joint's start angle (rad), which is also its reference.

    turned: counter-clockwise from the parent at joint angle 0, rad. sense: -1 if the angle grows clockwise.
    """
    pose = -(turned + sense * angle) / 2 + NO_MINUS  # half the turn about +y
    body = parent.add_body(name=name, pos=pos, quat=(math.cos(pose), 0, math.sin(pose), 0))
    # only the moment about the plane's normal matters; equal ones satisfy the triangle inequality
    body.mass, body.ipos, body.inertia = inertia.mass, position(inertia.centre), [inertia.moment] * 3
    body.iquat, body.explicitinertial = INERTIA_TURN, True
    hinge = body.add_joint(name=joint or name, ref=angle)
    if sense < 0:
        hinge.axis = [NO_MINUS - part for part in AXIS]
    return body


def _add_leg(
    spec: Spec,
    root: Spec,
    design: Design,
    leg: Leg,
    masses: dict[str, Inertia],
    start: dict[str, tuple[float, float]],
    anchors: str,
) -> None:
    """Thigh and shank, rocker and coupler of one leg, its loops closed."""
    linkage, prefix = design.linkage, leg.prefix
    angle = {joint: values[0] for joint, values in start.items()}

    def add(parent: Spec, body: str, pos: tuple[float, float, float], joint: str, **pose: Any) -> Spec:
        return add_body(parent, prefix + body, pos, masses[body], joint=prefix + joint, angle=angle[joint], **pose)

    thigh = add(root, "thigh", position(0j, leg.lateral), "hip", turned=linkage.seat_angle)
    # extension turns the shank clockwise; at knee angle 0 it would lie folded along the thigh
    add(thigh, "shank", (design.rider.thigh, 0, 0), "knee", turned=math.pi - float(design.boot_angle), sense=-1)
    if "rocker" in masses:
        rocker = add(root, "rocker", position(linkage.ground, leg.lateral), "rocker")
        add(rocker, "coupler", (linkage.rocker, 0, 0), "coupler")
    for cut in CUTS:
        if cut in linkage.architecture.joints:
            _close_loop(spec, design, leg, cut, anchors)


def _close_loop(spec: Spec, design: Design, leg: Leg, cut: str, anchors: str) -> None:
    """Two sites at a cut joint, one on each of its bodies, the constraint between them and a sensor of the gap."""
    architecture, owners, sites = design.linkage.architecture, [], []
    for body in architecture.joints[cut]:
        carrier = cut == "pedal" and body == architecture.pedal_body
        point = design.link_lengths[body] * (design.linkage.pedal_offset if carrier else 1.0)
        owner, arm, plane = appearance.on_body(leg, body)
        owners.append(owner)
        sites.append(spec.body(owner).add_site(name=f"{leg.prefix}{body}_{cut}", pos=position(point * arm, plane)))
    equality = spec.add_equality(spec.find_default("tricycle"), name=leg.prefix + cut, type=mujoco.mjtEq.mjEQ_CONNECT)
    if anchors == "bodies":
        # the second anchor follows from the pose in the file, which is assembled
        equality.objtype, equality.name1, equality.name2 = mujoco.mjtObj.mjOBJ_BODY, *owners
        equality.data[:3] = sites[0].pos
    else:
        equality.objtype, equality.name1, equality.name2 = mujoco.mjtObj.mjOBJ_SITE, sites[0].name, sites[1].name
    # the loop gap, m
    kind, site = mujoco.mjtSensor.mjSENS_FRAMEPOS, mujoco.mjtObj.mjOBJ_SITE
    gap = spec.add_sensor(name=f"{leg.prefix}{cut}_gap", type=kind, objtype=site, reftype=site)
    gap.objname, gap.refname = (anchor.name for anchor in sites)


def add_motors(spec: Spec, legs: tuple[Leg, ...]) -> None:
    """Joint motors, N m, extension positive."""
    for leg in legs:
        for joint in (leg.prefix + "hip", leg.prefix + "knee"):
            spec.add_actuator(name=joint, trntype=mujoco.mjtTrn.mjTRN_JOINT, target=joint).set_to_motor()


def _add_sensors(spec: Spec) -> None:
    """The torque between frame and crank, angle and speed of every joint."""
    kinds, objects, name = mujoco.mjtSensor, mujoco.mjtObj, "crank_torque"
    spec.add_sensor(name=name, type=kinds.mjSENS_TORQUE, objtype=objects.mjOBJ_SITE, objname=name)
    for joint in [joint.name for joint in spec.joints]:
        for quantity, kind in (("angle", kinds.mjSENS_JOINTPOS), ("speed", kinds.mjSENS_JOINTVEL)):
            spec.add_sensor(name=f"{joint}_{quantity}", type=kind, objtype=objects.mjOBJ_JOINT, objname=joint)


def add_keyframe(spec: Spec, state: dict[str, tuple[float, float]], controls: Sequence[float] = ()) -> None:
    """Position (rad, m) and speed of every joint at the start, and what its actuators are given."""
    try:
        model = spec.compile()
    except ValueError as error:
        raise InputError(f"{spec.modelname}: MuJoCo cannot build the model: {' '.join(str(error).split())}") from None
    qpos, qvel = np.zeros(model.nq), np.zeros(model.nv)
    for joint, (angle, speed) in state.items():
        address = model.joint(joint).qposadr[0]
        qpos[address], qvel[address] = angle, speed
    spec.add_key(name="start", qpos=qpos, qvel=qvel, ctrl=controls)
