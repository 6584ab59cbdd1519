"""What a design does in a turn, as the page shows it: motion, curves and numbers, or why there are none."""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from typing import Any, TypeAlias

import numpy as np

from fes_mj.common.errors import InputError
from fes_mj.common.text import typeset
from fes_mj.common.units import RPM
from fes_mj.explore import pose
from fes_mj.explore.limits import broken
from fes_mj.linkage import kinematics
from fes_mj.linkage.assembly import grashof_margin
from fes_mj.linkage.design import Design
from fes_mj.linkage.joints import JOINTS
from fes_mj.linkage.kinematics import Motion
from fes_mj.linkage.legs import all_legs
from fes_mj.moments.joint_moments import JointMoments
from fes_mj.moments.uncertainty import instant_power_weights
from fes_mj.statics.characteristics import motion_characteristics, power_characteristics
from fes_mj.statics.equilibrium import crank_moment, virtual_work
from fes_mj.statics.extrapolation import beyond
from fes_mj.statics.joint_forces import JointForces, peaks
from fes_mj.statics.turn import QuasiStatic, quasi_static, turn_points

SENT_POINTS = 360  # crank angles of a turn, from 0, at which curves are sent
DIGITS = 3  # after the point, of curves in W and deg
_ANGLES = kinematics.uniform_turn(SENT_POINTS)


def turn(design: Design, moments: Mapping[str, JointMoments], legs: int = 1) -> dict[str, Any]:
    """A turn under each of several moments; curves are of all legs together, numbers of one.

    Without power, because the linkage does not turn or a joint never enters the moments' range, "why" says so.
    """
    failing = pose.failing(design)
    answer = pose.as_json(design, _ANGLES) | {"cadence_rpm": design.linkage.cadence / RPM, "failing": failing}
    try:
        solved = {name: quasi_static(design, curves, points=SENT_POINTS) for name, curves in moments.items()}
    except InputError as error:
        return answer | {"why": failing["text"] if failing else str(error), "broken": broken(design, None)}
    motion = kinematics.solve(design, kinematics.uniform_turn(turn_points(design)))
    fine = {name: _fine(static, motion) for name, static in solved.items()}
    first, coarse = (next(iter(turns.values())) for turns in (fine, solved))
    return answer | {
        "broken": broken(design, first),
        "numbers": shown(_numbers(first)),
        "joints": {joint: np.round(np.degrees(angle), DIGITS) for joint, angle in coarse.joint_angle.items()},
        "moments": {name: _under(static, fine[name], legs) for name, static in solved.items()},
    }


def _fine(solved: QuasiStatic, motion: Motion) -> QuasiStatic:
    """The same at as many angles as `fes_mj static` takes, by virtual work: without reactions."""
    moment = solved.torque.along(motion, solved.cadence)
    return replace(solved, motion=motion, joint_moment=moment, crank_moment=virtual_work(motion, moment), reactions={})


def _under(solved: QuasiStatic, fine: QuasiStatic, legs: int) -> dict[str, Any]:
    """Curves and numbers that depend on the moments."""
    massive = solved.cadence * crank_moment(solved.motion, solved.torque, solved.cadence)
    covariance, reference = solved.moments.covariance, solved.torque.reference
    deviation = None
    if covariance is not None:
        weights = all_legs(instant_power_weights(solved.motion, solved.cadence, reference).T, legs)
        deviation = np.sqrt(np.sum((covariance @ weights) * weights, axis=0))
    outside = beyond(reference, solved.joint_angle)
    return {
        "static": np.round(all_legs(solved.power, legs), DIGITS),
        "masses": np.round(all_legs(massive, legs), DIGITS),
        "sd": None if deviation is None else np.round(deviation, DIGITS),
        "power_mean_W": fine.power_mean,
        "range_deg": {joint: np.degrees(reference.ranges[joint]) for joint in JOINTS},
        "outside": np.maximum(*outside) > 0,
        "numbers": shown(_power_numbers(fine, peaks(JointForces(solved).with_masses))),
        "note": fine.extrapolation.verdict,
    }


Number: TypeAlias = tuple[str, str, str, str]  # name, words, text, unit


def shown(numbers: Iterable[Number]) -> list[dict[str, str]]:
    rows = ((name, words, typeset(text), unit) for name, words, text, unit in numbers)
    return [dict(zip(("name", "words", "text", "unit"), row, strict=True)) for row in rows]


def _numbers(solved: QuasiStatic) -> Iterator[Number]:
    """Numbers that do not depend on the moments."""
    design, motion = solved.design, solved.motion
    yield "cadence", "cadence", f"{solved.cadence / RPM:.1f}", "rpm"
    for joint, (low, high) in solved.joint_range_deg.items():
        yield f"{joint}_range", f"{joint} range", f"{low:.1f} to {high:.1f}", "deg"
    knee_speed = np.degrees(np.mean(np.abs(motion.joint_rate.knee))) * solved.cadence
    yield "knee_speed", "mean knee speed", f"{knee_speed:.0f}", "deg/s"
    transmission = float(motion_characteristics(motion)["transmission_angle_min_deg"])
    yield "transmission", "least transmission angle", f"{transmission:.1f}", "deg"
    if design.linkage.kind != "trt":
        yield "grashof", "Grashof margin", f"{100 * float(grashof_margin(design)[0]):.2f}", "cm"


def _power_numbers(solved: QuasiStatic, forces: Mapping[str, float]) -> Iterator[Number]:
    character = power_characteristics(solved.power)
    joint = max(forces, key=lambda name: forces[name])
    yield "power", "as the paper assumes, one leg", f"{solved.power_mean:.2f}", "W"
    yield "work", "work per turn", f"{solved.work_per_turn:.2f}", "J"
    yield "inactive", "inactive zone", f"{100 * float(character['inactive_zone_share']):.0f}", "% of the turn"
    yield "ripple", "power, peak to peak", f"{float(character['power_peak_to_peak_W']):.0f}", "W"
    yield "force", f"peak pin force ({joint.replace('_', ' ')})", f"{forces[joint]:.0f}", "N"
