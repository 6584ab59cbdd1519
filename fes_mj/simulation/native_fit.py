"""A muscle as MuJoCo can have it, fitted to one rider's along a turn: straight tendons, and parabolas for its curves.

A tendon is straight between a site on either side of each joint that it passes, so its moment arms only resemble the
polynomials', and the sites are effective ones, not those of an anatomy. The curves are parabolas (MuJoCo's
documentation, "Muscles"); pennation is that at the optimal length. Rigid tendons are exact.
"""

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.linkage.joints import PerJoint
from fes_mj.linkage.kinematics import Motion
from fes_mj.muscles.anatomy import anatomy
from fes_mj.muscles.contraction import PLATEAU, tension
from fes_mj.muscles.power import MuscleTurn
from fes_mj.muscles.torque import MuscleTorque

RADII = (0.005, 0.3)  # m, of a site from the joint
SITE_START = 0.2  # m, of the site along the thigh, where a fit begins
LIMITS = ((0.5, 1.5), (0.4, 0.95), (0.2, 2.0), (1.05, 2.0))  # of the fit of MuscleCurves


@dataclass(frozen=True)
class Crossing:
    """Two sites, near and far of a joint by their radii, m; phase: of the angle between them, rad, at joint turn 0."""

    near: float
    far: float
    phase: float

    def length(self, turn: FloatArray) -> FloatArray:
        """Between the sites, m, where the distal body is turned by so much, rad, counter-clockwise."""
        square = self.near**2 + self.far**2 - 2 * self.near * self.far * np.cos(turn + self.phase)
        return np.asarray(np.sqrt(square))

    def arm(self, turn: FloatArray) -> FloatArray:
        """Derivative of the length by the turn, m."""
        return np.asarray(self.near * self.far * np.sin(turn + self.phase) / self.length(turn))

    @classmethod
    def fitted(cls, turn: FloatArray, arm: FloatArray) -> "Crossing":
        """With the least squares of arms, m, at these turns of the joint, rad."""
        from scipy.optimize import least_squares

        def of(numbers: FloatArray) -> Crossing:
            near, far = np.exp(numbers[:2])
            return cls(float(near), float(far), float(numbers[2]))

        size, side = np.clip(np.abs(arm).max(), 2 * RADII[0], RADII[1] / 2), math.copysign(1.0, arm.mean())
        low, high = np.log(RADII)
        bounds = [low, low, -np.inf], [high, high, np.inf]
        start = [math.log(size), math.log(SITE_START), side * math.pi / 2 - turn.mean()]  # a right angle in mid-turn
        near, far, phase = least_squares(lambda x: 1e3 * (of(x).arm(turn) - arm), start, bounds=bounds).x  # mm
        return of(np.array([min(near, far), max(near, far), phase]))


@dataclass(frozen=True)
class NativeMuscle:
    """One muscle as MuJoCo knows it; m, N, s. slack: what the tendon is longer than the fibres, by MuJoCo's path.

    Errors over the turn, the largest ones: of length, m, of moment arms, per the muscle's largest; of the force, root
    mean square when fully active, per isometric force.
    """

    name: str
    group: int
    crossings: dict[str, Crossing]
    force: float
    optimal: float
    slack: float
    width: float
    max_speed: float  # optimal lengths per s
    plateau: float
    length_error: float
    arm_error: float
    force_error: float


def native_curve(length: FloatArray, speed: FloatArray, width: float, plateau: float) -> FloatArray:
    """MuJoCo's force of a muscle per activation and isometric force, at optimal lengths and largest speeds."""
    apart = np.abs(length - 1) / (width / 2)
    by_length = np.where(apart <= 1, 1 - apart**2 / 2, np.maximum(2 - apart, 0) ** 2 / 2)
    lengthening = plateau - np.maximum(plateau - 1 - speed, 0) ** 2 / (plateau - 1)
    return np.asarray(by_length * np.where(speed <= 0, np.maximum(1 + speed, 0) ** 2, lengthening))


class MuscleCurves(NamedTuple):
    """Of one muscle: force per isometric force at the optimal length, width, largest speed per its own, plateau."""

    force: float
    width: float
    speed: float
    plateau: float

    @classmethod
    def fitted(cls, length: FloatArray, speed: FloatArray, fibre: dict[str, float]) -> tuple["MuscleCurves", float]:
        """By least squares at these lengths and speeds, and the root mean square of what is left of the force."""
        from scipy.optimize import least_squares

        target, _ = tension(length, speed, **fibre)
        optimal = fibre["optimal"] * math.cos(fibre["pennation"])
        relative, fastest = (length - fibre["slack"]) / optimal, speed / (optimal * fibre["max_speed"])

        def missed(numbers: FloatArray) -> FloatArray:
            of = cls(*numbers)
            return np.asarray(of.force * native_curve(relative, fastest / of.speed, of.width, of.plateau) - target)

        low, high = zip(*LIMITS, strict=True)
        fit = least_squares(missed, (1.0, 0.7, 0.5, PLATEAU), bounds=(low, high))
        return cls(*map(float, fit.x)), float(np.sqrt(np.mean(fit.fun**2)))


def joint_turns(motion: Motion) -> PerJoint[FloatArray]:
    """By which shank and thigh are turned from the body above, rad counter-clockwise (mjcf.build_mjcf)."""
    angle, design = motion.joint_angle, motion.design
    return PerJoint(np.pi - float(design.boot_angle) - angle.knee, design.linkage.seat_angle + angle.hip)


def fitted(torque: MuscleTorque, turn: MuscleTurn, row: int) -> NativeMuscle:
    """One muscle of the anatomy, by its row, along a turn of the rider whose torque it is."""
    muscles = anatomy()
    pulled, riders = turn.pulled, torque.riders
    scale, turned = float(pulled.scale[row].item()), joint_turns(torque.stimulated.motion)
    length, by_hip, by_knee = (values[row, 0, 0] for values in pulled.lengths)
    # flexion turns the shank counter-clockwise, the thigh clockwise
    arms = {"knee": scale * by_knee, "hip": -scale * by_hip}
    crossings = {
        joint: Crossing.fitted(turned[joint], arm) for joint, arm in arms.items() if np.abs(arm).max() > RADII[0] / 10
    }
    path = np.sum([crossing.length(turned[joint]) for joint, crossing in crossings.items()], axis=0)
    if len(crossings) == 2:  # and along the thigh
        path += abs(torque.design.rider.thigh - sum(crossing.far for crossing in crossings.values()))
    unlike = scale * length - path
    missing = [arm - (crossings[joint].arm(turned[joint]) if joint in crossings else 0) for joint, arm in arms.items()]
    fibre = {
        "optimal": float(muscles.optimal[row]),
        "slack": float(riders.slack(muscles)[row].item()),
        "pennation": float(muscles.pennation[row]),
        "max_speed": float(riders["max_speed"].item()),
    }
    curves, force_error = MuscleCurves.fitted(length, pulled.speed[row, 0, 0], fibre)
    return NativeMuscle(
        name=muscles.names[row],
        group=int(muscles.group[row]),
        crossings=crossings,
        force=float(muscles.force[row] * riders.strength(muscles)[row].item()) * curves.force,
        optimal=scale * fibre["optimal"] * math.cos(fibre["pennation"]),
        slack=scale * fibre["slack"] - float(unlike.mean()),
        width=curves.width,
        max_speed=curves.speed * fibre["max_speed"],
        plateau=curves.plateau,
        length_error=float(np.abs(unlike - unlike.mean()).max()),
        arm_error=float(np.abs(missing).max() / np.abs([*arms.values()]).max()),
        force_error=force_error,
    )
