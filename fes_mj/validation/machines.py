"""Predictions, as in cranking.py, that ask about joints' shares of the work and about another machine."""

import itertools
import math

import numpy as np
from scipy.optimize import brentq

from fes_mj.common.arrays import FloatArray
from fes_mj.common.units import RPM
from fes_mj.linkage import kinematics
from fes_mj.linkage.design import Design, Linkage
from fes_mj.linkage.joints import PerJoint
from fes_mj.muscles.anatomy import MUSCLE_GROUPS, anatomy
from fes_mj.muscles.passive import passive_moments
from fes_mj.muscles.power import best_turn, muscle_turn
from fes_mj.muscles.riders import Riders, load_riders
from fes_mj.muscles.rules import trial_windows
from fes_mj.muscles.timing import TURN_ANGLES, Windows
from fes_mj.validation.cranking import TRICYCLE, CrankingSetup

_SLIDER = 20.0  # m: a rocker so long leads as a straight slide does, within 2 mm
_COUPLER = 5.0  # of the stepper per crank: long enough that its path is an ellipse


def _joint_power(riders: Riders, setup: CrankingSetup) -> PerJoint[tuple[FloatArray, FloatArray]]:
    """Moment of muscles and passive tissue, N m, and power, W, (members, angles), in a rider group's windows."""
    leg, cadence = setup["leg_m"], setup["cadence_rpm"][0] * RPM
    theirs = load_riders(setup["windows_of"]).taken(slice(len(riders)))
    design = TRICYCLE.with_rider(thigh=leg, shank=leg)
    motion = kinematics.solve(design, TURN_ANGLES)
    turn = muscle_turn(riders, design, cadence, trial_windows(theirs, design))
    passive = passive_moments(riders.flexion(motion))

    def of_joint(joint: str) -> tuple[FloatArray, FloatArray]:
        moment = (turn.moment[joint] + passive[joint])[:, 0]
        return moment, cadence * moment * motion.joint_rate[joint]

    return PerJoint.of(of_joint)


def _shares(riders: Riders, setup: CrankingSetup, joint: str, sign: int) -> FloatArray:
    """Net work while a joint's moment has this sign per the leg's, %."""
    both = _joint_power(riders, setup)
    moment, power = both[joint]
    net = np.sum([done.mean(axis=1) for _, done in both], axis=0)
    return np.asarray(100 * np.where(sign * moment > 0, power, 0).mean(axis=1) / net)


def knee_extensors(riders: Riders, setup: CrankingSetup) -> FloatArray:
    """Their share of the leg's work, %."""
    return _shares(riders, setup, "knee", 1)


def knee_flexors(riders: Riders, setup: CrankingSetup) -> FloatArray:
    """Their share of the leg's work, %."""
    return _shares(riders, setup, "knee", -1)


def hip_extensors(riders: Riders, setup: CrankingSetup) -> FloatArray:
    """Their share of the leg's work, %."""
    return _shares(riders, setup, "hip", 1)


def eccentric(riders: Riders, setup: CrankingSetup) -> FloatArray:
    """Work of both joints while their moments brake, per the leg's work, %."""
    power = np.stack([power for _, power in _joint_power(riders, setup)])
    return np.asarray(100 * np.minimum(power, 0).mean(axis=2).sum(axis=0) / power.mean(axis=2).sum(axis=0))


def stepper(crank: float, flatness: float, knee_deg: float) -> Design:
    """A seated elliptical stepper: the pedal on the coupler of a crank and a slide, a coupler-driven tricycle.

    crank: m, half the stride. flatness: height of the path per length. knee_deg: flexion of the straightest knee.
    The slide lies in line with hip and crank centre, as steep as the standard tricycle's.
    """
    along = TRICYCLE.linkage.crank_centre / abs(TRICYCLE.linkage.crank_centre)
    coupler = _COUPLER * crank
    rider, boot = TRICYCLE.rider, float(TRICYCLE.boot_angle)
    corner = math.pi - math.radians(knee_deg) + boot
    reach = abs(rider.thigh - float(TRICYCLE.knee_to_pedal) * np.exp(1j * corner))

    def at(distance: float) -> Design:
        centre = distance * along
        pivot = centre + (1j * _SLIDER - coupler) * along  # the slide's end is between crank and rider
        linkage = Linkage(
            "cdt",
            ground=pivot,
            crank=crank,
            foot=TRICYCLE.linkage.foot,
            pivot_to_crank=centre - pivot,
            pedal_arm=flatness * coupler,
            coupler=coupler,
            rocker=_SLIDER,
            coupler_angle=0.0,
            branch="right",
            seat_angle=TRICYCLE.linkage.seat_angle,
        )
        return Design("elliptical stepper", linkage, rider)

    def too_far(distance: float) -> float:
        return float(np.abs(kinematics.positions(at(distance), TURN_ANGLES)["pedal"]).max() - reach)

    beyond_pedal = (1 - flatness) * coupler
    root: float = brentq(too_far, beyond_pedal, beyond_pedal + 2 * reach)
    return at(root)


def stepping_per_cycling(riders: Riders, setup: CrankingSetup) -> FloatArray:
    """Power on elliptical steppers of the sizes that may have been meant, per cycling; (members of all sizes,)."""

    def power(design: Design) -> FloatArray:
        motion = kinematics.solve(design, TURN_ANGLES)
        anatomy().require_range(design.name, riders.flexion(motion))
        rates = [rpm * RPM for rpm in setup["cadence_rpm"]]
        return np.asarray(np.mean([best_turn(riders, design, rate)[0].power_mean[:, 0] for rate in rates], axis=0))

    sizes = [*itertools.product(setup["crank_m"], setup["flatness"], setup["knee_deg"])]
    stepping = np.concatenate([power(stepper(*size)) for size in sizes])
    return stepping / np.tile(power(TRICYCLE), len(sizes))


def effort_saved(riders: Riders, setup: CrankingSetup) -> FloatArray:
    """Change of stimulated force and time per work by the best timing instead of the measurement's, %."""
    cadence = setup["cadence_rpm"][0] * RPM
    _, best = best_turn(riders, TRICYCLE, cadence)
    force = np.stack([anatomy().force[rows].sum() for rows in anatomy().of_group])
    strength = np.stack([riders.values[f"{group}_strength"] for group in MUSCLE_GROUPS])

    def per_work(windows: Windows) -> FloatArray:
        turn = muscle_turn(riders, TRICYCLE, cadence, windows)
        effort = turn.activation.mean(axis=-1)[:, :, 0] * strength * force[:, None]
        return np.asarray(effort.sum(axis=0) / turn.power_mean[:, 0])

    return 100 * (per_work(best) / per_work(trial_windows(riders, TRICYCLE)) - 1)
