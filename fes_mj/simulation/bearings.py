"""Friction in the bearings of a model: MuJoCo's frictionloss, a constant moment against the turning."""

from collections.abc import Mapping

import mujoco
import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.linkage.design import Architecture
from fes_mj.linkage.joints import JOINTS
from fes_mj.linkage.legs import Leg
from fes_mj.simulation.appearance import Spec
from fes_mj.simulation.mjcf import LOOP_SOLIMP, LOOP_SOLREF

# Joint coordinates that add up to a body's angle, but for a constant: coordinate -> sign.
_ANGLES: dict[str, dict[str, int]] = {
    "frame": {},
    "crank": {"crank": 1},
    "rocker": {"rocker": 1},
    "coupler": {"rocker": 1, "coupler": 1},
    "shank": {"hip": 1, "knee": -1},
}


def add_friction(spec: Spec, architecture: Architecture, legs: tuple[Leg, ...], moments: Mapping[str, float]) -> None:
    """Give every bearing its moment, N m: by name of the point where it is, of each leg.

    The angle of two bodies is the length of a tendon over the joint coordinates between them: loops, which are cut at
    bearings, have no joint there.
    """
    for leg in legs:
        for point, pair in architecture.joints.items():
            if point not in JOINTS:
                tendon = spec.add_tendon(name=f"{leg.prefix}{point}_bearing", frictionloss=moments[point])
                # soft, as by default, they slip where the turning changes its direction: 4e-4 of D1's power
                tendon.solref_friction, tendon.solimp_friction = LOOP_SOLREF, LOOP_SOLIMP
                for joint, sign in _between(*pair).items():
                    tendon.wrap_joint(joint if joint == "crank" else leg.prefix + joint, sign)


def _between(one: str, other: str) -> dict[str, int]:
    """Joint coordinates whose sum is the angle from one body to the other: coordinate -> sign."""
    signs = {joint: -sign for joint, sign in _ANGLES[one].items()}
    for joint, sign in _ANGLES[other].items():
        signs[joint] = signs.get(joint, 0) + sign
    return {joint: sign for joint, sign in signs.items() if sign}


def friction_on_crank(model: mujoco.MjModel, speed: Mapping[str, FloatArray]) -> FloatArray:
    """What bearings take off the crank's moment between leg and load, N m, at speeds (rad/s) by joint.

    The crank's torque sensor is on the leg's side of them: it does not see them.
    """
    total = np.zeros_like(speed["crank"])
    for tendon in range(model.ntendon):
        wraps = slice(model.tendon_adr[tendon], model.tendon_adr[tendon] + model.tendon_num[tendon])
        names = [model.joint(joint).name for joint in model.wrap_objid[wraps]]
        signs = dict(zip(names, model.wrap_prm[wraps].tolist(), strict=True))
        slip = sum(sign * speed[joint] for joint, sign in signs.items())
        total += model.tendon_frictionloss[tendon] * signs.get("crank", 0) * np.sign(slip)
    return total
