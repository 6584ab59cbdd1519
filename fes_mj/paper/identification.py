"""The dimensions behind Table 2: the point of its rounding box closest to the print that moves as Table 1 says.

For given seat angle and coupler angle the designs separate: each is a least-squares problem in nine
lengths with the eight range limits of Table 1 and the Grashof condition as constraints.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from scipy.optimize import least_squares, minimize

from fes_mj.common.arrays import FloatArray
from fes_mj.linkage.assembly import grashof_margin, joint_ranges
from fes_mj.linkage.design import Design
from fes_mj.linkage.design_file import load_design
from fes_mj.linkage.kinematics import FULL_TURN
from fes_mj.linkage.variables import component, lengths, replaced, with_lengths
from fes_mj.paper.printed import table1
from fes_mj.verification.case import Expected

LENGTH_ROUNDING = 0.005  # m, Table 2 is rounded to 1 cm
SEAT_ANGLE, COUPLER_ANGLE = np.radians(30.0), np.radians(90.0)  # in no table of the paper: what fits (readings.py)
RANGE_TOLERANCE = 0.49  # deg, Table 1 is rounded to 1 deg; a little inside, so that rounding the result is safe
_STARTS = 6
_SEED = 2022


@dataclass(frozen=True)
class Identification:
    """Outcome for one design: the identified linkage, or the closest try when `feasible` is false."""

    design: Design
    shift: FloatArray  # m, identified minus printed, in the order of variables.LENGTHS
    ranges: FloatArray  # deg: knee min, knee max, hip min, hip max
    feasible: bool

    @property
    def cost(self) -> float:
        """Sum of squared shifts in units of the rounding half-width."""
        return float(np.sum((self.shift / LENGTH_ROUNDING) ** 2))


def identify(
    printed: Design, target: Expected, seat_angle: float = SEAT_ANGLE, coupler_angle: float = COUPLER_ANGLE
) -> Identification:
    """Identify one six-bar for a seat angle and a coupler angle (rad)."""
    wanted, candidate = (
        np.array([*target.knee_range, *target.hip_range]),
        _candidates(printed, seat_angle, coupler_angle),
    )

    def margins(shift: FloatArray) -> FloatArray:
        design = candidate(shift)
        error = np.nan_to_num(joint_ranges(design) - wanted, nan=180.0)
        return np.array([*(RANGE_TOLERANCE - error), *(RANGE_TOLERANCE + error), 100 * grashof_margin(design).item()])

    random, best, fits = np.random.default_rng(_SEED), None, False
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
        if best is None or (feasible, -result.fun) > (fits, -best.fun):
            best, fits = result, feasible
    assert best is not None
    design = candidate(best.x)
    return Identification(design, LENGTH_ROUNDING * best.x, joint_ranges(design), fits)


def range_misfit(printed: Design, target: Expected, seat_angle: float, coupler_angle: float) -> float:
    """Largest error of a joint range, deg, at the least-squares fit of Table 1 inside the rounding box.

    NaN if no start inside the box turns; then nothing can be said.
    """
    wanted, candidate = (
        np.array([*target.knee_range, *target.hip_range]),
        _candidates(printed, seat_angle, coupler_angle),
    )

    def error(shift: FloatArray) -> FloatArray:
        return np.asarray(joint_ranges(candidate(shift)) - wanted)

    random = np.random.default_rng(_SEED)
    starts = [start for start in random.uniform(-0.9, 0.9, (60, 9)) if np.all(np.isfinite(error(start)))]
    fits = [
        least_squares(lambda shift: np.nan_to_num(error(shift), nan=180.0), start, bounds=(-1, 1), max_nfev=100)
        for start in starts[:_STARTS]
    ]
    return float(np.abs(min(fits, key=lambda fit: fit.cost).fun).max()) if fits else float("nan")


def inside_rounding(
    name: str, half_widths: Mapping[str, float], random: np.random.Generator, wanted: int, batch: int = 10_000
) -> dict[str, FloatArray]:
    """Linkages drawn evenly around the print that move as Table 1 says, by component, shape (linkages,) each.

    half_widths: by component (linkage.variables), in the unit of files, how far it may be from the print. At most
    `wanted` linkages: those of which a finer turn says otherwise are left out.
    """
    printed, target = load_design(name, "printed"), table1()[name]
    wanted_ranges = (*target.knee_range, *target.hip_range)
    middle, half = (
        np.array(values)[:, None, None]
        for values in ([component(printed, key) for key in half_widths], [*half_widths.values()])
    )

    def moving_so(drawn: FloatArray, points: FloatArray) -> FloatArray:
        ranges = joint_ranges(replaced(printed, dict(zip(half_widths, drawn, strict=True))), points)
        return drawn[:, np.all(np.abs(ranges - wanted_ranges) < 0.5, axis=1)]

    accepted: FloatArray = np.empty((len(half_widths), 0, 1))
    while accepted.shape[1] < wanted:
        drawn = middle + half * random.uniform(-1, 1, (len(half_widths), batch, 1))
        accepted = np.hstack([accepted, moving_so(drawn, FULL_TURN[::8])])
    accepted = moving_so(accepted[:, :wanted], FULL_TURN)  # the coarse turn may have stepped over an extreme
    return dict(zip(half_widths, accepted[..., 0], strict=True))


def _candidates(printed: Design, seat_angle: float, coupler_angle: float) -> Callable[[FloatArray], Design]:
    """Shift in half-widths of the rounding, shape (9,) -> the design with these lengths and angles."""
    base = printed.with_linkage(seat_angle=seat_angle, coupler_angle=coupler_angle)
    return lambda shift: with_lengths(base, lengths(base) + LENGTH_ROUNDING * shift)


def rounded(design: Design, digits: int = 6) -> Design:
    """The design with its lengths rounded, by default to 1 um."""
    return with_lengths(design, np.round(lengths(design), digits))
