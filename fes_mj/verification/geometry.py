"""The linkage itself: do the links close, on the right branch, and are the rates the derivatives of the positions?"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from fes_mj import kinematics
from fes_mj.checks import Check
from fes_mj.design import BODIES, TRICYCLE_SPEED, WHEEL_DIAMETER
from fes_mj.kinematics import Motion
from fes_mj.paper.identification import joint_ranges
from fes_mj.statics import quasi_static
from fes_mj.verification.case import Case

# The catalogue is resolved to rounding by 512 points; linkages closer to a dead centre turn faster there.
POINTS = 2048


def geometry_checks(case: Case) -> list[Check]:
    """Closure, branch, rates, and the gear law of one case."""
    motion = kinematics.solve(case.design, np.linspace(0, 2 * np.pi, POINTS, endpoint=False))
    first, second = rate_errors(motion)
    speed = case.design.linkage.cadence * WHEEL_DIAMETER / (2 * case.design.linkage.gear_ratio)
    return [
        case.check("loop_closure", closure_error(motion)),
        case.check("assembly_mode", wrong_branch(motion)),
        case.check("rates", first),
        case.check("second_rates", second),
        case.check("tricycle_speed", abs(speed / TRICYCLE_SPEED - 1)),
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
    return float(max(errors))


def wrong_branch(motion: Motion) -> float:
    """Number of crank angles at which a dyad is assembled the other way round."""
    point = {name: jet.value for name, jet in motion.points.items()}
    wrong = ~(_cross(point["pedal"] - point["hip"], point["knee"] - point["hip"]) < 0)
    if "rocker_joint" in point:
        pivot = point["rocker_pivot"]
        wrong |= ~(_cross(point["crank_pin"] - pivot, point["rocker_joint"] - pivot) > 0)
    return float(np.sum(wrong))


def _cross(a: Any, b: Any) -> Any:
    return a.real * b.imag - a.imag * b.real


def rate_errors(motion: Motion) -> tuple[float, float]:
    """Kinematic coefficients against Fourier derivatives of the positions and angles, relative to the largest.

    First and second coefficients; motion over POINTS uniform crank angles from 0.
    """
    pairs: list[tuple[Any, Any, Any]] = [
        (jet.value, jet.first, jet.second) for jet in motion.points.values() if np.size(jet.value) > 1
    ]
    turning = motion.turning
    pairs.append((np.unwrap(motion.hip_angle), motion.hip_rate, turning["thigh"][1]))
    pairs.append((motion.knee_angle, motion.knee_rate, turning["thigh"][1] - turning["shank"][1]))
    first = max(_relative_error(fourier_derivative(value), rate) for value, rate, _ in pairs)
    second = max(_relative_error(fourier_derivative(rate), change) for _, rate, change in pairs)
    return first, second


def fourier_derivative(values: Any) -> NDArray[Any]:
    """Derivative of a periodic function by its argument, from uniform samples over a turn."""
    order = np.fft.fftfreq(len(values), 1 / len(values))
    order[len(values) // 2] = 0.0  # the highest harmonic has no derivative on the grid
    spectrum = np.fft.fft(values)
    derivative: NDArray[Any] = np.fft.ifft(1j * order * spectrum)
    return derivative if np.iscomplexobj(values) else derivative.real


def _relative_error(value: Any, reference: Any) -> float:
    return float(np.abs(value - reference).max() / max(np.abs(value).max(), np.abs(reference).max()))


def paper_checks(case: Case) -> list[Check]:
    """A catalogued design against Table 1 of the paper: joint ranges and, for the paper's moments, power."""
    if case.printed is None:
        return []
    row = case.printed
    wanted = np.array([*row.knee_range, *row.hip_range])
    checks = [case.check("joint_range", np.abs(joint_ranges(case.design) - wanted).max())]
    if case.moments.name in row.power and case.moments.torque_velocity is None:  # the paper knows no speed
        power = quasi_static(case.design, case.moments).power_mean
        checks.append(case.check("printed_power", abs(power - row.power[case.moments.name])))
    return checks
