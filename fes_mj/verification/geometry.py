"""The moving linkage itself: do the links close, on the right branch, are the rates the derivatives of the positions?

And is it what its design file says, read once more without the reader and measured between the joints?
"""

import math
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from fes_mj.common.arrays import BoolArray, ComplexArray, FloatArray
from fes_mj.common.checks import Check
from fes_mj.crosscheck.turn_case import Case
from fes_mj.linkage.design import BODIES, BRANCHES
from fes_mj.linkage.joints import JOINTS
from fes_mj.linkage.kinematics import Motion, cross, uniform_turn
from fes_mj.linkage.variables import SHORTEST
from fes_mj.verification.case import VerificationCase

# The catalogue is resolved to rounding by 512 points; linkages closer to a dead centre turn faster there.
GEOMETRY_POINTS = 2048
FILE_ANGLES = uniform_turn(72)
ANGLE_KEYS = ("gamma", "seat_angle")  # keys of a design file that are angles
WHEEL, SPEED = 0.66, 5.71 / 3.6  # m, m/s: of Eq. 16, not the reader's


def geometry_checks(case: Case) -> Iterator[Check]:
    """Closure, branch and rates of one case."""
    motion = case.steps.motion(uniform_turn(GEOMETRY_POINTS))
    first, second = rate_errors(motion)
    yield case.check("loop_closure", closure_error(motion))
    yield case.check("assembly_mode", wrong_branch(motion))
    yield case.check("rates", first)
    yield case.check("second_rates", second)


def closure_error(motion: Motion) -> float:
    """Largest difference between a link's length and the distance of its ends, pedal arm included, m."""
    design, point = motion.design, {name: jet.value for name, jet in motion.points.items()}
    errors = [
        np.abs(np.abs(point[BODIES[body][1]] - point[BODIES[body][0]]) - length).max()
        for body, length in design.link_lengths.items()
    ]
    if design.linkage.architecture.pedal_body != "crank":
        errors.append(np.abs(np.abs(point["pedal"] - point["rocker_joint"]) - design.linkage.pedal_arm).max())
    return float(np.max(errors))


def wrong_branch(motion: Motion) -> float:
    """Number of crank angles at which a dyad is assembled the other way round."""
    point = {name: jet.value for name, jet in motion.points.items()}
    wrong: BoolArray = ~(cross(point["pedal"] - point["hip"], point["knee"] - point["hip"]) < 0)
    if "rocker_joint" in point:
        pivot = point["rocker_pivot"]
        side = BRANCHES[motion.design.linkage.branch]
        wrong |= ~(side * cross(point["crank_pin"] - pivot, point["rocker_joint"] - pivot) > 0)
    return float(np.sum(wrong))


def rate_errors(motion: Motion) -> tuple[float, float]:
    """Kinematic coefficients against Fourier derivatives of the positions and angles, relative to the largest.

    First and second coefficients; motion over GEOMETRY_POINTS uniform crank angles from 0.
    """
    pairs: list[tuple[Any, Any, Any]] = [
        (jet.value, jet.first, jet.second) for jet in motion.points.values() if np.size(jet.value) > 1
    ]
    angle, rotation = motion.joint_angle.map(np.unwrap), motion.joint_rotation
    pairs += [(angle[joint], *rotation[joint]) for joint in JOINTS]
    first = np.max([_relative_error(_derivative(value), rate) for value, rate, _ in pairs])
    second = np.max([_relative_error(_derivative(rate), change) for _, rate, change in pairs])
    return float(first), float(second)  # by NumPy, whose largest of a NaN and a number is the NaN


def _derivative(curve: Any) -> Any:
    """By the crank angle, of a curve at uniform angles of a turn, real or complex; by Fourier series."""
    order = np.fft.fftfreq(len(curve), 1 / len(curve))
    order[len(curve) // 2] = 0.0  # whose derivative is not known
    change = np.fft.ifft(1j * order * np.fft.fft(curve))
    return change if np.iscomplexobj(curve) else change.real


def _relative_error(value: Any, reference: Any) -> float:
    return float(np.abs(value - reference).max() / max(np.abs(value).max(), np.abs(reference).max()))


def file_checks(case: VerificationCase) -> Iterator[Check]:
    """Every dimension that the case's design file gives; nothing for a design that is in no file."""
    if case.file:
        yield case.check("design_file", file_error(case.file, case.steps.motion(FILE_ANGLES)))


def file_error(path: Path, motion: Motion) -> float:
    """Largest difference between a number of a design file and the same measured on a linkage, m, rad or a ratio."""
    content, measured = tomllib.loads(path.read_text(encoding="utf-8")), measure(motion)
    rider = content.get("rider", {})
    # a rider with a name is in no design file
    written = content["linkage"] | (rider if isinstance(rider, dict) else {})
    # of an arm that is shorter than any link its direction is known no better than its end
    weights = {"gamma": np.minimum(1.0, np.abs(measured["R8"]) / SHORTEST)} if "gamma" in measured else {}
    errors = [
        np.abs(_difference(key, written[key], measured[key]) * weights.get(key, 1.0)).max()
        for key in written
        if key in measured
    ]
    return float(np.max(errors))  # by NumPy, whose largest of a NaN and a number is the NaN


def _difference(key: str, written: Any, measured: Any) -> Any:
    if key in ANGLE_KEYS:
        return np.angle(np.exp(1j * (measured - written * math.pi / 180)))
    return measured - (complex(*written) if isinstance(written, list) else written)


def measure(motion: Motion) -> dict[str, ComplexArray | FloatArray]:
    """Dimensions by the keys of design files, m, rad or a ratio, from where the joints are; over crank angles.

    The pedal arm as a complex number, so that one that leaves the rocker's line is not as long as it is.
    """
    at = {name: jet.value for name, jet in motion.points.items()}
    linkage, leg, pin = motion.design.linkage, at["knee"] - at["hip"], at["crank_pin"]
    knee_to_pedal = at["pedal"] - at["knee"]
    boot_angle = math.pi - np.angle(knee_to_pedal) + np.angle(leg) - motion.joint_angle.knee
    shank = np.abs(knee_to_pedal) * np.exp(1j * boot_angle)
    measured = {
        "R2": np.abs(pin - at["crank_centre"]),
        "R6": shank.imag,
        "thigh": np.abs(leg),
        "shank": shank.real,
        "seat_angle": np.angle(leg) - motion.joint_angle.hip,
        "gear_ratio": np.asarray(linkage.cadence * WHEEL / 2 / SPEED),
    }
    if linkage.kind == "trt":
        return measured | {"R1": at["crank_centre"] - at["hip"]}
    pivot, joint = at["rocker_pivot"], at["rocker_joint"]
    along = (pin if linkage.kind == "cdt" else 2 * joint - pivot) - joint  # the line from which gamma turns the arm
    arm = (at["pedal"] - joint) / (along / np.abs(along))
    measured |= {"gamma": np.angle(arm), "R8": np.abs(arm) if linkage.kind == "cdt" else arm}
    return measured | {
        "R1": pivot - at["hip"],
        "R7": at["crank_centre"] - pivot,
        "R9": np.abs(pin - joint),
        "R10": np.abs(joint - pivot),
    }
