"""The dimensions behind Table 2: the point of its rounding box closest to the print that moves as Table 1 says.

Beside the print, and beside what other readings of the paper would have given.

For given seat angle and coupler angle the designs separate: each is a least-squares problem in nine
lengths with the eight range limits of Table 1 and the Grashof condition as constraints.
"""

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from scipy.optimize import least_squares, minimize

from fes_mj.common.arrays import FloatArray
from fes_mj.common.console import track
from fes_mj.common.errors import AssemblyError
from fes_mj.linkage.assembly import grashof_margin, joint_ranges
from fes_mj.linkage.design import Design
from fes_mj.linkage.design_file import SIX_BARS, load_design
from fes_mj.linkage.kinematics import FULL_TURN
from fes_mj.linkage.turning import turning
from fes_mj.linkage.variables import LENGTHS, component, lengths, replaced, with_lengths
from fes_mj.paper.captions import Rows, table
from fes_mj.paper.printed import table1
from fes_mj.verification.case import Expected

LENGTH_ROUNDING = 0.005  # m, Table 2 is rounded to 1 cm
SEAT_ANGLE, COUPLER_ANGLE = np.radians(30.0), np.radians(90.0)  # in no table of the paper: what fits (readings below)
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
    printed_ranges, candidate = _wanted(target), _candidates(printed, seat_angle, coupler_angle)

    def margins(shift: FloatArray) -> FloatArray:
        design = candidate(shift)
        error = np.nan_to_num(joint_ranges(design) - printed_ranges, nan=180.0)
        return np.array([*(RANGE_TOLERANCE - error), *(RANGE_TOLERANCE + error), 100 * grashof_margin(design).item()])

    results, random = [], np.random.default_rng(_SEED)
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
        results.append((bool(margins(result.x).min() > -1e-6), -result.fun, result.x))
    feasible, _, best = max(results, key=lambda result: result[:2])
    design = candidate(best)
    return Identification(design, LENGTH_ROUNDING * best, joint_ranges(design), feasible)


def range_misfit(printed: Design, target: Expected, seat_angle: float, coupler_angle: float) -> float:
    """Largest error of a joint range, deg, at the least-squares fit of Table 1 inside the rounding box.

    NaN if no start inside the box turns; then nothing can be said.
    """
    printed_ranges, candidate = _wanted(target), _candidates(printed, seat_angle, coupler_angle)

    def error(shift: FloatArray) -> FloatArray:
        return np.asarray(joint_ranges(candidate(shift)) - printed_ranges)

    random = np.random.default_rng(_SEED)
    starts = [start for start in random.uniform(-0.9, 0.9, (60, 9)) if np.all(np.isfinite(error(start)))]
    fits = [
        least_squares(lambda shift: np.nan_to_num(error(shift), nan=180.0), start, bounds=(-1, 1), max_nfev=100)
        for start in starts[:_STARTS]
    ]
    return float(np.abs(min(fits, key=lambda fit: fit.cost).fun).max()) if fits else float("nan")


def inside_rounding(
    name: str, half_widths: Mapping[str, float], random: np.random.Generator, count: int, batch: int = 10_000
) -> dict[str, FloatArray]:
    """Linkages drawn evenly around the print that move as Table 1 says, by component, shape (linkages,) each.

    half_widths: by component (linkage.variables), in the unit of files, how far it may be from the print. At most
    `count` linkages: those of which a finer turn says otherwise are left out.
    """
    printed, wanted_ranges = load_design(name, "printed"), _wanted(table1()[name])
    middle, half = (
        np.array(values)[:, None, None]
        for values in ([component(printed, key) for key in half_widths], [*half_widths.values()])
    )

    def moving_so(drawn: FloatArray, points: FloatArray) -> FloatArray:
        ranges = joint_ranges(replaced(printed, dict(zip(half_widths, drawn, strict=True))), points)
        return drawn[:, np.all(np.abs(ranges - wanted_ranges) < 0.5, axis=1)]

    accepted: FloatArray = np.empty((len(half_widths), 0, 1))
    while accepted.shape[1] < count:
        drawn = middle + half * random.uniform(-1, 1, (len(half_widths), batch, 1))
        accepted = np.hstack([accepted, moving_so(drawn, FULL_TURN[::8])])
    accepted = moving_so(accepted[:, :count], FULL_TURN)  # the coarse turn may have stepped over an extreme
    return dict(zip(half_widths, accepted[..., 0], strict=True))


def _candidates(printed: Design, seat_angle: float, coupler_angle: float) -> Callable[[FloatArray], Design]:
    """Shift in half-widths of the rounding, shape (9,) -> the design with these lengths and angles."""
    base = printed.with_linkage(seat_angle=seat_angle, coupler_angle=coupler_angle)
    return lambda shift: with_lengths(base, lengths(base) + LENGTH_ROUNDING * shift)


def _wanted(target: Expected) -> FloatArray:
    """Table 1's knee min, knee max, hip min, hip max, deg."""
    return np.array([*target.knee_range, *target.hip_range])


class Reading(NamedTuple):
    """One way to read what the paper leaves out; angles in rad."""

    title: str
    designs: tuple[str, ...] = SIX_BARS
    seat_angle: float = SEAT_ANGLE
    coupler_angle: float = COUPLER_ANGLE
    mirrored: bool = False  # R1y with the other sign


def readings() -> list[Reading]:
    """The chosen reading first, then the alternatives."""
    seats = [Reading(f"seat angle {angle:g} deg", seat_angle=math.radians(angle)) for angle in (28, 29, 31, 32)]
    couplers = [
        Reading(f"gamma {angle:g} deg", ("d1", "d2"), coupler_angle=math.radians(angle))
        for angle in (75, 80, 85, 95, 100, 105)
    ]
    return [
        Reading("chosen: seat angle 30 deg, gamma 90 deg"),
        *seats,
        Reading("seat angle 60 deg, as Section 3 needs for the TRT", seat_angle=math.radians(60)),
        Reading("seat angle 15.4 deg, as Table 2 needs for the TRT", seat_angle=math.radians(15.4)),
        Reading("R1y with the other sign", mirrored=True),
        *couplers,
        Reading("gamma 0 deg: pedal on the coupler's line", ("d1", "d2"), coupler_angle=0.0),
        Reading("gamma -90 deg: pedal on the other side", ("d1", "d2"), coupler_angle=-math.pi / 2),
    ]


def read_all(silent: bool) -> dict[str, dict[str, str]]:
    """By reading and design: does a point of the rounding box fit Table 1, at which cost, or by how much none does."""
    return {reading.title: dict(_outcomes(reading)) for reading in track(readings(), "readings of Table 2", silent)}


@table("readings", design=[name.upper() for name in SIX_BARS])
def readings_table(outcomes: dict[str, dict[str, str]]) -> Rows:
    """The outcome of every reading."""
    return ((title, *(of.get(name, "as chosen") for name in SIX_BARS)) for title, of in outcomes.items())


def _outcomes(reading: Reading) -> Iterator[tuple[str, str]]:
    for name in reading.designs:
        printed, target = load_design(name, "printed"), table1()[name]
        if reading.mirrored:
            printed = printed.with_linkage(ground=printed.linkage.ground.conjugate())
        case = printed, target, reading.seat_angle, reading.coupler_angle
        result = identify(*case)
        yield name, f"fits, cost {result.cost:.2f}" if result.feasible else f"misses by {range_misfit(*case):.1f} deg"


@table("dimensions")
def dimensions_table() -> Rows:
    """Table 2: printed and identified lengths, cm, and the shift between them."""
    for name in SIX_BARS:
        printed, identified = (100 * lengths(load_design(name, dims)) for dims in ("printed", "identified"))
        for row in zip(LENGTHS, printed, identified, identified - printed, strict=True):
            yield name.upper(), *row


@table("ranges")
def ranges_table() -> Rows:
    """Joint ranges: Table 1, printed dimensions, identified dimensions, and Grashof's margin of both."""
    for name, target in table1().items():
        printed_ranges = _wanted(target)
        for dims in ("printed", "identified"):
            design = load_design(name, dims)
            try:
                turning(design)
                ranges = [float(value) for value in joint_ranges(design)]
                error: float | None = float(np.abs(ranges - printed_ranges).max())
            except AssemblyError:
                ranges, error = [], None
            verdict = "cannot turn" if error is None else "yes" if error <= 0.5 else "no"
            margin = None if name == "trt" else 100 * grashof_margin(design).item()
            yield name.upper(), dims, _span(printed_ranges, 0), _span(ranges, 1), error, verdict, margin


def _span(ranges: list[float] | FloatArray, digits: int) -> str:
    if not len(ranges):
        return "-"
    knee_low, knee_high, hip_low, hip_high = (f"{value:.{digits}f}" for value in ranges)
    return f"{knee_low} to {knee_high}, {hip_low} to {hip_high}"
