"""The dimensions behind Table 2: the point of its rounding box closest to the print that moves as Table 1 says.

For given seat angle and coupler angle the designs separate: each is a least-squares problem in nine
lengths with the eight range limits of Table 1 and the Grashof condition as constraints.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares, minimize

from fes_mj import kinematics
from fes_mj.design import Design, Linkage
from fes_mj.paper.printed import Table1Row

ROUNDING = 0.005  # m, Table 2 is rounded to 1 cm
SEAT_ANGLE, COUPLER_ANGLE = np.radians(30.0), np.radians(90.0)  # in no table of the paper: what fits (readings.py)
RANGE_TOLERANCE = 0.49  # deg, Table 1 is rounded to 1 deg; a little inside, so that rounding the result is safe
_STARTS = 6
_SEED = 2022


@dataclass(frozen=True)
class Identification:
    """Outcome for one design: the identified linkage, or the closest try when `found` is false."""

    design: Design
    shift: NDArray[np.float64]  # m, identified minus printed, in the order of pack
    ranges: NDArray[np.float64]  # deg: knee min, knee max, hip min, hip max
    found: bool

    @property
    def cost(self) -> float:
        """Sum of squared shifts in units of the rounding half-width."""
        return float(np.sum((self.shift / ROUNDING) ** 2))


def identify(
    printed: Design, target: Table1Row, seat_angle: float = SEAT_ANGLE, coupler_angle: float = COUPLER_ANGLE
) -> Identification:
    """Identify one six-bar for a seat angle and a coupler angle (rad)."""
    base = replace(printed.linkage, seat_angle=seat_angle, coupler_angle=coupler_angle)
    wanted = np.array([*target.knee_range, *target.hip_range])

    def candidate(shift: NDArray[np.float64]) -> Design:
        return replace(printed, linkage=unpack(base, pack(base) + ROUNDING * shift))

    def margins(shift: NDArray[np.float64]) -> NDArray[np.float64]:
        design = candidate(shift)
        error = np.nan_to_num(joint_ranges(design) - wanted, nan=180.0)
        return np.array([*(RANGE_TOLERANCE - error), *(RANGE_TOLERANCE + error), 100 * grashof_margin(design.linkage)])

    random, best, found = np.random.default_rng(_SEED), None, False
    for trial in range(_STARTS):
        start = random.normal(0, 0.3, 9) if trial else np.zeros(9)
        result = minimize(
            lambda shift: shift @ shift,
            np.clip(start, -1, 1),
            jac=lambda shift: 2 * shift,
            bounds=[(-1, 1)] * 9,
            constraints={"type": "ineq", "fun": margins},
            method="SLSQP",
            options={"maxiter": 200},
        )
        feasible = bool(margins(result.x).min() > -1e-6)
        if best is None or (feasible, -result.fun) > (found, -best.fun):
            best, found = result, feasible
    assert best is not None
    design = candidate(best.x)
    return Identification(design, ROUNDING * best.x, joint_ranges(design), found)


def range_misfit(printed: Design, target: Table1Row, seat_angle: float, coupler_angle: float) -> float:
    """Largest error of a joint range, deg, at the least-squares fit of Table 1 inside the rounding box.

    NaN if no start inside the box turns; then nothing can be said.
    """
    base = replace(printed.linkage, seat_angle=seat_angle, coupler_angle=coupler_angle)
    wanted = np.array([*target.knee_range, *target.hip_range])

    def error(shift: NDArray[np.float64]) -> NDArray[np.float64]:
        return joint_ranges(replace(printed, linkage=unpack(base, pack(base) + ROUNDING * shift))) - wanted

    random = np.random.default_rng(_SEED)
    starts = [start for start in random.uniform(-0.9, 0.9, (60, 9)) if np.all(np.isfinite(error(start)))]
    fits = [
        least_squares(lambda shift: np.nan_to_num(error(shift), nan=180.0), start, bounds=(-1, 1), max_nfev=100)
        for start in starts[:_STARTS]
    ]
    return float(np.abs(min(fits, key=lambda fit: fit.cost).fun).max()) if fits else float("nan")


def joint_ranges(design: Design, crank_angle: NDArray[np.float64] = kinematics.FULL_TURN) -> NDArray[np.float64]:
    """Knee minimum and maximum, hip minimum and maximum, deg; NaN if it cannot close.

    Shape (4,), or (designs, 4) for a batch.
    """
    points = kinematics.positions(design, crank_angle)
    angles = kinematics.knee_angle(design, points), kinematics.hip_angle(design, points)
    return np.degrees(np.stack([f(angle, axis=-1) for angle in angles for f in (np.min, np.max)], axis=-1))


def grashof_margin(linkage: Linkage) -> Any:
    """Grashof's inequality with the crank as shortest link: sum of the other two minus crank and longest link, m."""
    others = np.sort(np.stack([np.abs(linkage.pivot_to_crank), linkage.coupler, linkage.rocker]), axis=0)
    return others[0] + others[1] - others[2] - linkage.crank


def rounded(linkage: Linkage, digits: int = 6) -> Linkage:
    """The linkage with its lengths rounded, by default to 1 um."""
    return unpack(linkage, np.round(pack(linkage), digits))


def pack(linkage: Linkage) -> NDArray[np.float64]:
    """The nine identified lengths, m, shape (9,): R1x, R1y, R2, R6, R7x, R7y, R8, R9, R10."""
    ground, pivot, lengths = (
        linkage.ground,
        linkage.pivot_to_crank,
        (linkage.pedal_arm, linkage.coupler, linkage.rocker),
    )
    return np.array([ground.real, ground.imag, linkage.crank, linkage.foot, pivot.real, pivot.imag, *lengths])


def unpack(linkage: Linkage, lengths: NDArray[np.float64]) -> Linkage:
    """The linkage with its lengths replaced; lengths of shape (9, designs, 1) make a batch."""
    ground_x, ground_y, crank, foot, pivot_x, pivot_y, *rest = lengths.tolist() if lengths.ndim == 1 else lengths
    pedal_arm, coupler, rocker = rest
    return replace(
        linkage,
        ground=ground_x + 1j * ground_y,
        crank=crank,
        foot=foot,
        pivot_to_crank=pivot_x + 1j * pivot_y,
        pedal_arm=pedal_arm,
        coupler=coupler,
        rocker=rocker,
    )
