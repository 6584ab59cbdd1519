"""The identified dimensions beside the print, and what other readings of the paper would have given."""

import math
from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np

from fes_mj.common.arrays import FloatArray
from fes_mj.common.errors import AssemblyError
from fes_mj.common.markdown import Table
from fes_mj.linkage.assembly import grashof_margin, joint_ranges
from fes_mj.linkage.design_file import load_design
from fes_mj.linkage.turning import turning
from fes_mj.linkage.variables import LENGTHS, lengths
from fes_mj.paper.captions import captioned
from fes_mj.paper.identification import COUPLER_ANGLE, SEAT_ANGLE, identify, range_misfit
from fes_mj.paper.printed import SIX_BARS, table1


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


STEPS = len(readings())  # how often `read_all` calls `done`


def read_all(done: Callable[[], None]) -> dict[str, dict[str, str]]:
    """By reading and design: does a point of the rounding box fit Table 1, at which cost, or by how much none does."""
    outcomes = {}
    for reading in readings():
        outcomes[reading.title] = dict(_outcomes(reading))
        done()
    return outcomes


def readings_table(outcomes: dict[str, dict[str, str]]) -> Table:
    """The outcome of every reading."""
    rows = [(title, *(of.get(name, "as chosen") for name in SIX_BARS)) for title, of in outcomes.items()]
    return captioned("readings", rows, design=[name.upper() for name in SIX_BARS])


def _outcomes(reading: Reading) -> Iterator[tuple[str, str]]:
    for name in reading.designs:
        printed, target = load_design(name, "printed"), table1()[name]
        if reading.mirrored:
            ground = printed.linkage.ground.conjugate()
            printed = printed.with_linkage(ground=ground)
        result = identify(printed, target, reading.seat_angle, reading.coupler_angle)
        if result.feasible:
            yield name, f"fits, cost {result.cost:.2f}"
        else:
            yield name, f"misses by {range_misfit(printed, target, reading.seat_angle, reading.coupler_angle):.1f} deg"


def dimensions_table() -> Table:
    """Table 2: printed and identified lengths, cm, and the shift between them."""
    rows = []
    for name in SIX_BARS:
        printed, identified = (100 * lengths(load_design(name, dims)) for dims in ("printed", "identified"))
        rows += [
            (name.upper(), length, *values)
            for length, *values in zip(LENGTHS, printed, identified, identified - printed, strict=True)
        ]
    return captioned("dimensions", rows)


def ranges_table() -> Table:
    """Joint ranges: Table 1, printed dimensions, identified dimensions, and Grashof's margin of both."""
    rows = []
    for name, target in table1().items():
        wanted = np.array([*target.knee_range, *target.hip_range])
        for dims in ("printed", "identified"):
            design = load_design(name, dims)
            try:
                turning(design)
                ranges = [float(value) for value in joint_ranges(design)]
                error: float | None = float(np.abs(ranges - wanted).max())
            except AssemblyError:
                ranges, error = [], None
            verdict = "cannot turn" if error is None else "yes" if error <= 0.5 else "no"
            margin = None if name == "trt" else 100 * grashof_margin(design).item()
            rows.append((name.upper(), dims, _span(wanted, 0), _span(ranges, 1), error, verdict, margin))
    return captioned("ranges", rows)


def _span(ranges: list[float] | FloatArray, digits: int) -> str:
    if not len(ranges):
        return "-"
    knee_low, knee_high, hip_low, hip_high = (f"{value:.{digits}f}" for value in ranges)
    return f"{knee_low} to {knee_high}, {hip_low} to {hip_high}"
