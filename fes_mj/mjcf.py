"""MJCF of the rider's leg(s) and the linkage, written with MjSpec; loops are closed by `connect` constraints.

The plane of the paper becomes MuJoCo's x-z plane: x backwards, z up, y to the rider's right. Angles grow
counter-clockwise in the paper's view, that is about -y. The joint coordinates are the paper's: `hip` is
phi_h, `knee` is phi_k, `crank` is theta_2.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import mujoco
import numpy as np

from fes_mj import kinematics
from fes_mj.design import Design
from fes_mj.segments import GRAVITY, Inertia, combine, inertias

TARGET_TIMESTEP = 0.25e-3  # s; the loop gap grows with (speed * step)^2, the error of the torque reading with the step
FEWEST_STEPS = 2400  # per turn: above 100 rpm the step shrinks with the turn
SERVO_GAIN = 1e5  # N m s/rad; holds the cadence to 1e-5, stable only with the `discrete` integrator
# MuJoCo's default solref (0.02 s) opens the loops by millimetres and bends the mean power by tens of percent; shorter
# than 1e-5 s gains nothing, the softness left is that of solimp, which MuJoCo caps at 0.9999.
LOOP_SOLREF = (1e-5, 1.0)
LOOP_SOLIMP = (0.9999, 0.9999, 0.001, 0.5, 2.0)

# Joints that are cut and closed again by a constraint: passive pins without drive, limit or friction.
CUTS = ("pedal", "crank_pin")
NORMAL = (0.0, -1.0, 0.0)


@dataclass(frozen=True)
class Leg:
    """One leg with its linkage: name prefix, how far its crank arm trails the first leg's (rad), plane's y (m)."""

    prefix: str
    lag: float
    lateral: float


ONE_LEG = (Leg("", 0.0, 0.0),)
TWO_LEGS = (Leg("right_", 0.0, 0.12), Leg("left_", math.pi, -0.12))
LEGS = {1: ONE_LEG, 2: TWO_LEGS}


def steps_per_turn(cadence: float, timestep: float | None = None) -> int:
    """Whole number of time steps in a turn at `cadence` (rad/s), for a step near `timestep` (s) if given."""
    turn = 2 * math.pi / cadence
    if timestep is None:
        return max(FEWEST_STEPS, round(turn / TARGET_TIMESTEP))
    return max(1, round(turn / timestep))


def build_mjcf(
    design: Design,
    *,
    cadence: float | None = None,
    timestep: float | None = None,
    legs: int = 1,
    mass_scale: float = 1.0,
    gravity: float = GRAVITY,
) -> mujoco.MjSpec:
    """The model of a design at a cadence (rad/s, by default Eq. 16), with a keyframe at crank angle 0.

    timestep: s; rounded so that a turn is a whole number of steps. mass_scale: factor on every mass and inertia.
    Raises AssemblyError if the linkage does not close over the whole turn.
    """
    kinematics.require_assembly(design)
    cadence = design.linkage.cadence if cadence is None else cadence
    spec = mujoco.MjSpec()
    spec.modelname = design.name
    spec.comment = f"{design.linkage.architecture.title}: {design.name}, {math.degrees(cadence) / 6:.2f} rpm"
    # as authored and at full precision: the default output has six digits, half a micrometre of loop error
    spec.compiler.savecompiled = spec.compiler.savecanonical = False
    spec.compiler.degree = False
    _set_options(spec, 2 * math.pi / cadence / steps_per_turn(cadence, timestep), gravity)
    root = spec.worldbody.add_body(name="tricycle")  # one fixed root: some readers drop all bodies but the first
    masses = {body: _scaled(part, mass_scale) for body, part in inertias(design).items()}
    masses["crank"] = combine(*(_turned(masses["crank"], -leg.lag) for leg in LEGS[legs]))
    crank = _add_body(root, "crank", _position(design.linkage.crank_centre), masses["crank"])
    crank.add_site(name="crank_torque")
    for leg in LEGS[legs]:
        _add_leg(spec, root, design, leg, masses)
    _add_drives(spec, LEGS[legs])
    _add_keyframe(spec, design, cadence, LEGS[legs])
    return spec


def _scaled(inertia: Inertia, scale: float) -> Inertia:
    return Inertia(scale * inertia.mass, inertia.centre, scale * inertia.moment)


def _turned(inertia: Inertia, angle: float) -> Inertia:
    return inertia._replace(centre=inertia.centre * complex(math.cos(angle), math.sin(angle)))


def _set_options(spec: mujoco.MjSpec, timestep: float, gravity: float) -> None:
    option = spec.option
    option.timestep = timestep
    option.gravity = (0.0, 0.0, -gravity)
    option.integrator = mujoco.mjtIntegrator.mjINT_DISCRETE
    option.solver = mujoco.mjtSolver.mjSOL_NEWTON
    option.jacobian = mujoco.mjtJacobian.mjJAC_DENSE  # 4.0.0's sparse Newton Hessian is wrong
    option.disableflags = int(mujoco.mjtDisableBit.mjDSBL_CONTACT | mujoco.mjtDisableBit.mjDSBL_ISLAND)


def _position(point: complex, lateral: float = 0.0) -> tuple[float, float, float]:
    return (float(np.real(point)), lateral, float(np.imag(point)))


def _add_body(
    parent: Any,
    name: str,
    pos: tuple[float, float, float],
    inertia: Inertia,
    *,
    joint: str = "",
    turned: float = 0.0,
    axis: tuple[float, float, float] = NORMAL,
) -> Any:
    """A body with one hinge at its origin, `turned` (rad, counter-clockwise) against its parent at joint angle 0."""
    body = parent.add_body(name=name, pos=pos, quat=(math.cos(turned / 2), 0, -math.sin(turned / 2), 0))
    # only the moment about the plane's normal matters; equal ones satisfy the triangle inequality
    body.mass, body.ipos, body.inertia = inertia.mass, _position(inertia.centre), [inertia.moment] * 3
    body.explicitinertial = True
    body.add_joint(name=joint or name, type=mujoco.mjtJoint.mjJNT_HINGE, axis=axis)
    return body


def _add_leg(spec: mujoco.MjSpec, root: Any, design: Design, leg: Leg, masses: dict[str, Inertia]) -> None:
    """Thigh and shank, rocker and coupler of one leg."""
    linkage, prefix = design.linkage, leg.prefix
    hip = _position(0j, leg.lateral)
    thigh = _add_body(
        root, prefix + "thigh", hip, masses["thigh"], joint=prefix + "hip", turned=float(linkage.seat_angle)
    )
    # extension turns the shank clockwise: the knee's axis is reversed, so that its angle grows with it
    straight = math.pi - float(design.boot_angle)
    knee = (design.rider.thigh, 0, 0)
    _add_body(thigh, prefix + "shank", knee, masses["shank"], joint=prefix + "knee", turned=straight, axis=(0, 1, 0))
    if "rocker" in masses:
        pivot = _position(linkage.ground, leg.lateral)
        rocker = _add_body(root, prefix + "rocker", pivot, masses["rocker"])
        _add_body(rocker, prefix + "coupler", (linkage.rocker, 0, 0), masses["coupler"])
    for cut in CUTS:
        if cut in linkage.architecture.joints:
            _close_loop(spec, design, leg, cut)


def _close_loop(spec: mujoco.MjSpec, design: Design, leg: Leg, cut: str) -> None:
    """Two sites at a cut joint, one on each of its bodies, and the constraint that holds them together."""
    architecture, sites = design.linkage.architecture, []
    for body in architecture.joints[cut]:
        carrier = cut == "pedal" and body == architecture.pedal_body
        point = design.link_lengths[body] * (design.linkage.pedal_offset if carrier else 1.0)
        if body == "crank":
            owner, pos = "crank", _position(point * np.exp(-1j * leg.lag), leg.lateral)
        else:
            owner, pos = leg.prefix + body, _position(point)
        sites.append(f"{leg.prefix}{body}_{cut}")
        spec.body(owner).add_site(name=sites[-1], pos=pos)
    spec.add_equality(
        name=leg.prefix + cut,
        type=mujoco.mjtEq.mjEQ_CONNECT,
        objtype=mujoco.mjtObj.mjOBJ_SITE,
        name1=sites[0],
        name2=sites[1],
        solref=LOOP_SOLREF,
        solimp=LOOP_SOLIMP,
    )
    # the loop gap, m
    spec.add_sensor(
        name=f"{leg.prefix}{cut}_gap",
        type=mujoco.mjtSensor.mjSENS_FRAMEPOS,
        objtype=mujoco.mjtObj.mjOBJ_SITE,
        objname=sites[0],
        reftype=mujoco.mjtObj.mjOBJ_SITE,
        refname=sites[1],
    )


def _add_drives(spec: mujoco.MjSpec, legs: tuple[Leg, ...]) -> None:
    """Joint motors (N m, extension positive), the servo that holds the cadence, the crank-torque sensor."""
    measured = ["crank"]
    for leg in legs:
        for joint in (leg.prefix + "hip", leg.prefix + "knee"):
            spec.add_actuator(name=joint, trntype=mujoco.mjtTrn.mjTRN_JOINT, target=joint).set_to_motor()
            measured.append(joint)
    servo = spec.add_actuator(name="crank_servo", trntype=mujoco.mjtTrn.mjTRN_JOINT, target="crank")
    servo.set_to_velocity(kv=SERVO_GAIN)
    spec.add_sensor(
        name="crank_torque",
        type=mujoco.mjtSensor.mjSENS_TORQUE,
        objtype=mujoco.mjtObj.mjOBJ_SITE,
        objname="crank_torque",
    )
    for joint in measured:
        for quantity, kind in (
            ("angle", mujoco.mjtSensor.mjSENS_JOINTPOS),
            ("speed", mujoco.mjtSensor.mjSENS_JOINTVEL),
        ):
            spec.add_sensor(name=f"{joint}_{quantity}", type=kind, objtype=mujoco.mjtObj.mjOBJ_JOINT, objname=joint)


def _add_keyframe(spec: mujoco.MjSpec, design: Design, cadence: float, legs: tuple[Leg, ...]) -> None:
    """Exact position and velocity at crank angle 0, the servo at its cadence and the joint motors idle."""
    state = {"crank": (0.0, cadence)}
    for leg in legs:
        motion = kinematics.solve(design, np.array([-leg.lag]))
        angles = {"hip": (motion.hip_angle, motion.hip_rate), "knee": (motion.knee_angle, motion.knee_rate)}
        if "rocker" in motion.turning:
            rocker, coupler = motion.direction("rocker"), motion.direction("coupler")
            turning = motion.turning["rocker"][0]
            angles["rocker"] = (np.angle(rocker), turning)
            angles["coupler"] = (np.angle(coupler / rocker), motion.turning["coupler"][0] - turning)
        for joint, (angle, rate) in angles.items():
            state[leg.prefix + joint] = (float(angle[0]), cadence * float(rate[0]))
    model = spec.compile()
    qpos, qvel, ctrl = np.zeros(model.nq), np.zeros(model.nv), np.zeros(model.nu)
    for joint, (angle, rate) in state.items():
        address = model.joint(joint).qposadr[0]
        qpos[address], qvel[address] = angle, rate
    ctrl[model.actuator("crank_servo").id] = cadence
    spec.add_key(name="start", qpos=qpos, qvel=qvel, ctrl=ctrl)
