"""The moving linkage against its design file: read once more, without the reader, and measured between the joints."""

import math
import tomllib
from pathlib import Path
from typing import Any

import numpy as np

from fes_mj.common.arrays import ComplexArray, FloatArray
from fes_mj.common.checks import Check
from fes_mj.linkage.kinematics import Motion
from fes_mj.verification.case import VerificationCase

POSES = np.linspace(0, 2 * np.pi, 72, endpoint=False)
DEGREES = ("gamma", "seat_angle")  # keys of a design file that are angles
WHEEL, SPEED = 0.66, 5.71 / 3.6  # m, m/s: of Eq. 16, not the reader's


def file_checks(case: VerificationCase) -> list[Check]:
    """Every dimension that the case's design file gives; nothing for a design that is in no file."""
    if case.file is None:
        return []
    return [case.check("design_file", file_error(case.file, case.steps.motion(POSES)))]


def file_error(path: Path, motion: Motion) -> float:
    """Largest difference between a number of a design file and the same measured on a linkage, m, rad or a ratio."""
    content, measured = tomllib.loads(path.read_text(encoding="utf-8")), measure(motion)
    rider = content.get("rider", {})
    given = content["linkage"] | (rider if isinstance(rider, dict) else {})  # a rider with a name is in no design file
    errors = [np.abs(_difference(key, given[key], measured[key])).max() for key in given if key in measured]
    return float(np.max(errors))  # by NumPy, whose largest of a NaN and a number is the NaN


def _difference(key: str, given: Any, measured: Any) -> Any:
    if key in DEGREES:
        return np.angle(np.exp(1j * (measured - given * math.pi / 180)))
    return measured - (complex(*given) if isinstance(given, list) else given)


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
