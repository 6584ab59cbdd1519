"""What free riding says about the paper's designs: how fast, how evenly, from where and up what they ride.

Errors are the scatter over muscles drawn from what is known of them: a curve of the recovered moments and a relation of
Hill's prior, each drawn anew. Nothing here is linear in either.
"""

from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from fes_mj.common.markdown import Table
from fes_mj.common.units import KMH, RPM
from fes_mj.linkage.design import Design
from fes_mj.linkage.design_file import DESIGNS, load_design
from fes_mj.moments.files import load_moments
from fes_mj.moments.joint_moments import GROUPS, JointMoments
from fes_mj.moments.samples import sampled_moments
from fes_mj.moments.torque_velocity import drawn_relations, load_torque_velocity
from fes_mj.moments.uncertainty import with_sd
from fes_mj.paper.captions import captioned
from fes_mj.riding.ride import TRANSMISSIONS, Ride, Road, balancing_slope
from fes_mj.riding.starts import Starts, starts
from fes_mj.riding.trace import Trace, ride as solved

DRAWS = 48  # of muscles; a standard deviation of so many is known to a tenth of itself
START_DRAWS = 12  # of these, in the search for starts, which takes some thirty times as long as a ride; to a fifth
ANGLES = 12  # crank angles over half a turn, from which it is tried to start
SHORT = 20.0  # s: what rides so long from rest goes on
RATIOS = np.geomspace(0.25, 4.0, 17)  # times the design's own gear ratio
SLOPES = (0.0, 0.02)  # on which the best gear ratio is sought
SEED = 2007
THREADS = 2  # the compiled solver lets others run beside it
STEPS = len(DESIGNS) * len(GROUPS)  # how often `ride_all` calls `done`


@dataclass(frozen=True, eq=False)
class Riding:
    """Of one design, group and transmission: rides with the muscles as they are known best, then with those drawn.

    slope: that balances the mean power of speed-free muscles at 5.71 km/h. starts: of START_DRAWS of these muscles.
    gears: by slope, speed at each of RATIOS, m/s, 0 where it stops.
    """

    design: Design
    group: str
    transmission: str
    slope: float
    flat: list[Trace]
    uphill: list[Trace]
    starts: list[Starts]
    gears: dict[float, list[float]]


def ride_all(done: Callable[[], None]) -> list[Riding]:
    """All rides; without numba it takes hours."""
    found: list[Riding] = []
    for group in GROUPS:
        muscles = _muscles(group)
        for name in DESIGNS:
            found += [_riding(load_design(name), group, muscles, each) for each in TRANSMISSIONS]
            done()
    return found


def _muscles(group: str) -> list[JointMoments]:
    """The best known, then DRAWS others."""
    best, drawn = load_torque_velocity("hill"), drawn_relations("hill", DRAWS, SEED)
    curves = [load_moments(group), *sampled_moments(group, DRAWS)]
    return [curve.at_speed(relation) for curve, relation in zip(curves, [best, *drawn], strict=True)]


def _riding(design: Design, group: str, muscles: list[JointMoments], transmission: str) -> Riding:
    level = [Ride(design, each, transmission=transmission) for each in muscles]
    slope = balancing_slope(level[0])
    uphill = [replace(ride, road=Road(slope=slope)) for ride in level]
    brief = [replace(ride, duration=SHORT) for ride in level[: 1 + START_DRAWS]]
    geared = {each: [_geared(level[0], ratio, each) for ratio in RATIOS] for each in SLOPES}
    with ThreadPoolExecutor(THREADS) as threads:
        return Riding(
            design,
            group,
            transmission,
            slope,
            [*threads.map(solved, level)],
            [*threads.map(solved, uphill)],
            [*threads.map(lambda ride: starts(ride, ANGLES), brief)],
            {each: [trace.mean_speed or 0.0 for trace in threads.map(solved, some)] for each, some in geared.items()},
        )


def _geared(ride: Ride, ratio: float, slope: float) -> Ride:
    linkage = replace(ride.design.linkage, gear_ratio=ratio * ride.design.linkage.gear_ratio)
    return replace(ride, design=replace(ride.design, linkage=linkage), road=Road(slope=slope))


def speed_table(found: list[Riding]) -> Table:
    """What each settles to on the flat, and whether it rides on the slope that its mean power balances."""
    rows = [
        (
            *_names(each),
            _with_scatter(lambda trace: trace.mean_speed and trace.mean_speed / KMH, each.flat),
            _with_scatter(lambda trace: trace.cadence and trace.cadence / RPM, each.flat, 0),
            _with_scatter(lambda trace: trace.ripple and 100 * trace.ripple, each.flat),
            100 * each.flat[0].coasting_share,
            100 * each.slope,
            "rides" if each.uphill[0].rides else f"stops after {each.uphill[0].stopped_at:.0f} s",
            f"{sum(trace.rides for trace in each.uphill[1:])} of {DRAWS}",
        )
        for each in found
    ]
    return captioned("riding", rows, draws=str(DRAWS))


def start_table(found: list[Riding]) -> Table:
    """From which crank angles each starts, the launch it needs, the slope it climbs."""
    rows = [
        (
            *_names(each),
            _with_scatter(lambda one: 100 * one.share, each.starts, 0),
            _with_scatter(lambda one: None if one.launch is None else one.launch / KMH, each.starts),
            _with_scatter(lambda one: None if one.slope is None else 100 * one.slope, each.starts),
        )
        for each in found
    ]
    return captioned("starts", rows, angles=str(2 * ANGLES), draws=str(START_DRAWS))


def gear_table(found: list[Riding]) -> Table:
    """The gear ratio with which each is fastest on the flat and uphill."""
    rows = []
    for each in found:
        cells: list[float | None] = []
        for speeds in each.gears.values():
            best = int(np.argmax(speeds))
            rides = speeds[best] > 0
            cells += [float(RATIOS[best]) * each.design.linkage.gear_ratio if rides else None]
            cells += [speeds[best] / KMH if rides else None]
        rows.append((*_names(each), each.design.linkage.gear_ratio, *cells))
    return captioned("gears", rows)


def transmission_table(found: list[Riding]) -> Table:
    """Distance in a minute with a fixed gear per that with a freewheel, beside what was measured on the road."""
    by = {_names(each): each for each in found}
    rows = []
    for each in (each for each in found if each.transmission == "fixed"):
        other = by[each.design.name.upper(), each.group, "freewheel"]
        gains = [
            100 * (_distance(one) / _distance(two) - 1)
            for one, two in ((each.flat[0], other.flat[0]), (each.uphill[0], other.uphill[0]))
        ]
        rows.append((*_names(each)[:2], *gains))
    return captioned("transmissions", rows)


def _distance(trace: Trace) -> float:
    return float(trace.distance.max())


def _names(each: Riding) -> tuple[str, str, str]:
    return each.design.name.upper(), each.group, each.transmission


def _with_scatter(of: Callable[[Any], float | None], rides: Sequence[Any], digits: int = 1) -> str | None:
    """The value of the best known muscles and the standard deviation of those drawn; None without the one."""
    best, *drawn = map(of, rides)
    known = [value for value in drawn if value is not None]
    return None if best is None else with_sd(best, float(np.std(known, ddof=1)) if len(known) > 1 else None, digits)
