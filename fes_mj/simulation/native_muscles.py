"""Muscles as MuJoCo's own: tendons through sites and its muscle curves (native_fit), in the model of a design.

What the fit leaves is measured and said. Activation is played back over the crank angle: it is no state.
"""

from collections.abc import Iterable
from dataclasses import asdict, dataclass
from functools import cached_property, lru_cache
from typing import Any

import mujoco
import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.common.errors import InputError
from fes_mj.linkage.design import Design
from fes_mj.linkage.joints import JOINTS
from fes_mj.linkage.legs import LEGS, Leg
from fes_mj.muscles.anatomy import MUSCLE_GROUPS, anatomy
from fes_mj.muscles.drive import Muscles
from fes_mj.muscles.torque import MuscleTorque
from fes_mj.simulation.appearance import Spec
from fes_mj.simulation.mjcf import ModelOptions, build_mjcf, joint_motion, position
from fes_mj.simulation.native_fit import NativeMuscle, fitted

SPAN = (0.5, 1.5)  # optimal lengths to which MuJoCo's `lengthrange` belongs; any two say the same
NOTHING = 1e-12  # MuJoCo wants a passive force; passive moments do no work over a turn


@dataclass(frozen=True, eq=False)
class NativeMuscles:
    """The muscles of a drive's most probable rider on one design at one cadence, fitted there."""

    torque: MuscleTorque
    muscles: tuple[NativeMuscle, ...]
    static_power: float  # mean, of one leg by the same rider's muscles in statics, W

    @cached_property
    def power(self) -> float:
        """Mean power of one leg by MuJoCo's muscle forces at the exact poses and speeds of a turn, W."""
        design, cadence = self.torque.design, self.torque.cadence
        spec = build_mjcf(design, cadence=cadence, options=ModelOptions(motors=False, drawn=False))
        self.add_to(spec, LEGS[1])
        model = spec.compile()
        data, motion = mujoco.MjData(model), self.torque.stimulated.motion
        states = {"crank": (motion.crank_angle, 1.0, 0.0)} | joint_motion(motion)
        active, driven = self.activation(motion.crank_angle), [model.joint(joint).dofadr[0] for joint in JOINTS]
        power = 0.0
        for number in range(len(motion.crank_angle)):
            for joint, (angle, rate, _) in states.items():
                data.joint(joint).qpos[0] = angle[number]
                data.joint(joint).qvel[0] = cadence * (rate if joint == "crank" else rate[number])
            for name, column in active.items():
                data.actuator(name).ctrl[0] = column[number]
            mujoco.mj_forward(model, data)
            power += float(data.qfrc_actuator[driven] @ data.qvel[driven])
        return power / len(motion.crank_angle)

    def activation(self, crank_angle: FloatArray) -> dict[str, FloatArray]:
        """Of each muscle, by name, at crank angles, rad, counted from its own leg's."""
        groups = self.torque.activation(crank_angle)
        return {muscle.name: groups[muscle.group] for muscle in self.muscles}

    def add_to(self, spec: Spec, legs: Iterable[Leg]) -> None:
        """Sites, tendons and actuators, whose control is the activation, in a model of build_mjcf without motors."""
        thigh, start = self.torque.design.rider.thigh, [control for key in spec.keys for control in key.ctrl]
        for leg in legs:
            active = self.activation(np.array([-leg.lag]))
            start += [float(active[muscle.name][0]) for muscle in self.muscles]
            for muscle in self.muscles:
                _add_muscle(spec, leg, muscle, thigh)
        spec.keys[0].ctrl = start

    @property
    def sentence(self) -> str:
        """What a reader of the model must know of it, in one line."""
        worst = {key: max(getattr(muscle, key) for muscle in self.muscles) for key in ("length_error", "arm_error")}
        return (
            f"native muscles give {self.power:.2f} W a leg, by statics the same rider's give {self.static_power:.2f} W "
            f"({self.power - self.static_power:+.2f} W); lengths within {1e3 * worst['length_error']:.2g} mm, moment "
            f"arms within {100 * worst['arm_error']:.2g} %"
        )

    def summary(self) -> dict[str, Any]:
        """Powers, their difference and each muscle's fit as JSON names and units them."""
        return {
            "power_native_W": self.power,
            "power_static_W": self.static_power,
            "power_difference_W": self.power - self.static_power,
            "native_muscles": [
                {
                    "name": muscle.name,
                    "group": MUSCLE_GROUPS[muscle.group],
                    "length_error_mm": 1e3 * muscle.length_error,
                    "moment_arm_error_percent": 100 * muscle.arm_error,
                    "force_error_percent": 100 * muscle.force_error,
                    "joints": {joint: asdict(crossing) for joint, crossing in muscle.crossings.items()},
                }
                for muscle in self.muscles
            ],
        }


def _add_muscle(spec: Spec, leg: Leg, muscle: NativeMuscle, thigh: float) -> None:
    """One tendon through two sites at every joint that it passes, and its actuator."""
    name = leg.prefix + muscle.name
    tendon = spec.add_tendon(name=name, width=0.003, rgba=(0.8, 0.2, 0.2, 1.0))
    for joint in ("hip", "knee"):  # from the pelvis downwards
        if joint not in muscle.crossings:
            continue
        crossing = muscle.crossings[joint]
        # the far site lies on the line from hip to knee, the near one where the phase says
        if joint == "hip":
            ends = [("tricycle", crossing.near * np.exp(-1j * crossing.phase)), (leg.prefix + "thigh", crossing.far)]
        else:
            near = -crossing.near * np.exp(1j * crossing.phase)
            ends = [(leg.prefix + "thigh", thigh - crossing.far), (leg.prefix + "shank", near)]
        for end, (body, point) in zip(("origin", "insertion"), ends, strict=True):
            lateral = leg.lateral if body == "tricycle" else 0.0
            site = spec.body(body).add_site(name=f"{name}_{joint}_{end}", pos=position(complex(point), lateral))
            tendon.wrap_site(site.name)
    actuator = spec.add_actuator(name=name, trntype=mujoco.mjtTrn.mjTRN_TENDON, target=name)
    actuator.set_to_muscle(
        tausmooth=0.0,
        range=SPAN,
        force=muscle.force,
        lmin=1 - muscle.width,
        lmax=1 + muscle.width,
        vmax=muscle.max_speed,
        fpmax=NOTHING,
        fvmax=muscle.plateau,
    )
    actuator.dyntype = mujoco.mjtDyn.mjDYN_NONE  # activation is played straight
    actuator.lengthrange = [muscle.slack + end * muscle.optimal for end in SPAN]
    actuator.ctrlrange, actuator.ctrllimited = (0.0, 1.0), True


@lru_cache(maxsize=8)
def native_muscles(design: Design, drive: Muscles, cadence: float) -> NativeMuscles:
    """The most probable rider's muscles as MuJoCo's; cadence: rad/s.

    Raises InputError as Muscles.torque, and for the timing by-angle, which has moments but no activation.
    """
    torque = drive.torque(design, cadence)
    if not isinstance(torque, MuscleTorque) or torque.stimulated.turn is None:
        raise InputError(f"the timing {drive.timing} says moments but no activation; choose another one")
    turn = torque.stimulated.turn
    every = tuple(fitted(torque, turn, row) for row in range(len(anatomy().names)))
    return NativeMuscles(torque, every, float(turn.power_mean.item()))
