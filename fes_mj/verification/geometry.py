"""The linkage itself: do the links close, on the right branch, and are the rates the derivatives of the positions?"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from fes_mj.common.arrays import BoolArray
from fes_mj.common.checks import Check
from fes_mj.crosscheck.turn_case import Case
from fes_mj.linkage.design import BODIES, BRANCHES
from fes_mj.linkage.joints import JOINTS
from fes_mj.linkage.kinematics import Motion, cross

# The catalogue is resolved to rounding by 512 points; linkages closer to a dead centre turn faster there.
SAMPLES = 2048


def geometry_checks(case: Case) -> list[Check]:
    """Closure, branch and rates of one case."""
    motion = case.steps.motion(np.linspace(0, 2 * np.pi, SAMPLES, endpoint=False))
    first, second = rate_errors(motion)
    return [
        case.check("loop_closure", closure_error(motion)),
        case.check("assembly_mode", wrong_branch(motion)),
        case.check("rates", first),
        case.check("second_rates", second),
    ]


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

    First and second coefficients; motion over SAMPLES uniform crank angles from 0.
    """
    pairs: list[tuple[Any, Any, Any]] = [
        (jet.value, jet.first, jet.second) for jet in motion.points.values() if np.size(jet.value) > 1
    ]
    angle, rotation = motion.joint_angle.map(np.unwrap), motion.joint_rotation
    pairs += [(angle[joint], *rotation[joint]) for joint in JOINTS]
    first = np.max([_relative_error(fourier_derivative(value), rate) for value, rate, _ in pairs])
    second = np.max([_relative_error(fourier_derivative(rate), change) for _, rate, change in pairs])
    return float(first), float(second)  # by NumPy, whose largest of a NaN and a number is the NaN


def fourier_derivative(values: Any) -> NDArray[Any]:
    """Derivative of a periodic function by its argument, from uniform samples over a turn."""
    order = np.fft.fftfreq(len(values), 1 / len(values))
    order[len(values) // 2] = 0.0  # the highest harmonic has no derivative on the grid
    spectrum = np.fft.fft(values)
    derivative: NDArray[Any] = np.fft.ifft(1j * order * spectrum)
    return derivative if np.iscomplexobj(values) else derivative.real


def _relative_error(value: Any, reference: Any) -> float:
    return float(np.abs(value - reference).max() / max(np.abs(value).max(), np.abs(reference).max()))
