"""What free riding says about the paper's designs: how fast, how evenly, from where and up what they ride.

Stimulated muscles drive. Errors are the scatter over all that is not known and matters on a road, each drawn anew: the
rider of the ensemble, the dimensions, the legs' lengths and masses. The windows stay those of the design as drawn.
"""

from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from dataclasses import dataclass, replace
from itertools import product
from typing import Any, NamedTuple

import numpy as np

from fes_mj.budget.unknowns import MASSES, budget_priors, realisations
from fes_mj.common.console import track
from fes_mj.common.errors import InputError, require_extra
from fes_mj.common.units import KMH, RPM
from fes_mj.crosscheck.ride_case import RideCase
from fes_mj.linkage.design import Design
from fes_mj.linkage.design_file import DESIGNS, load_design
from fes_mj.linkage.variables import replaced, runnable
from fes_mj.moments.files import load_moments
from fes_mj.moments.joint_moments import RIDER_GROUPS
from fes_mj.moments.uncertainty import with_sd
from fes_mj.muscles.drive import Muscles, load_muscles
from fes_mj.paper.captions import Rows, table
from fes_mj.riding.ride import TRANSMISSIONS, Ride, Road, balancing_slope
from fes_mj.riding.starts import Starts, starts
from fes_mj.riding.stimulated import StimulatedRider, stimulated_rider
from fes_mj.riding.trace import Trace, ride as solved
from fes_mj.riding.verdict import FASTEST_CADENCE

RIDE_DRAWS = 24  # of all; a standard deviation of so many is known to a seventh of itself
START_DRAWS = 4  # of these, in the search for starts, which takes some thirty times as long as a ride; to two fifths
TRIED_ANGLES = 8  # crank angles over half a turn, from which it is tried to start
SHORT = 20.0  # s: what rides so long from rest goes on
RATIOS = np.geomspace(0.125, 4.0, 21)  # times the design's own gear ratio; of these those that can be run
SLOPES = (0.0, 0.02)  # on which the best gear ratio is sought
AT_END = " (end of the range)"
RIDE_SEED = 2007
THREADS = 2  # the compiled solver lets others run beside it


@dataclass(frozen=True, eq=False)
class Riding:
    """Of one design, group and transmission: rides with the muscles as they are known best, then with those drawn.

    slope: that balances the mean power at 5.71 km/h. starts: of START_DRAWS of these muscles.
    gears: by slope, the gear ratio with which it is fastest; None where none will do.
    """

    design: Design
    group: str
    transmission: str
    slope: float
    flat: list[Trace]
    uphill: list[Trace]
    starts: list[Starts]
    gears: dict[float, "Gear | None"]

    @property
    def names(self) -> tuple[str, str, str]:
        return self.design.name.upper(), self.group, self.transmission


class Gear(NamedTuple):
    """A gear ratio and the speed with it, m/s. at_end: whether no lower, or no higher, ratio was tried."""

    ratio: float
    speed: float
    at_end: bool


def ride_all(silent: bool) -> list[Riding]:
    """All rides. Raises MissingPartError without numba."""
    require_extra("optimize", "numba")
    muscles = {group: load_muscles(group) for group in RIDER_GROUPS}
    cases = track([*product(RIDER_GROUPS, DESIGNS, TRANSMISSIONS)], "rides", silent)
    return [_riding(load_design(name), group, muscles[group], kind) for group, name, kind in cases]


def drawn_rides(ride: Ride, muscles: Muscles, count: int) -> list[Ride]:
    """A ride with the rider, the dimensions and the legs of each draw; without those that cannot turn or be driven."""
    assert isinstance(ride.drive, StimulatedRider)
    design, group = ride.design, muscles.riders.name
    drawn = realisations(design, load_moments(group), count)
    values = drawn.dimensions | drawn.legs
    members = np.linspace(0, len(muscles.riders) - 1, count).astype(int)  # which are independent of each other
    heavier = np.exp(budget_priors()[MASSES]["log_sd"] * np.random.default_rng(RIDE_SEED).standard_normal(count))
    rides = []
    for row, (member, factor) in enumerate(zip(members, heavier, strict=True)):
        other = replaced(design, {name: float(column[row]) for name, column in values.items()})
        rider = replace(ride.drive, riders=muscles.riders.taken([member]))
        one = replace(ride, design=other.with_rider(leg_mass_factor=float(factor)), drive=rider)
        with suppress(InputError):  # of which AssemblyError is one
            one.require_possible()
            rides.append(one)
    return rides


def _riding(design: Design, group: str, muscles: Muscles, transmission: str) -> Riding:
    best = Ride(design, stimulated_rider(muscles, design), transmission=transmission)
    level = [best, *drawn_rides(best, muscles, RIDE_DRAWS)]
    balanced = balancing_slope(best)
    uphill = [replace(ride, road=Road(slope=balanced)) for ride in level]
    brief = [replace(ride, duration=SHORT) for ride in level[: 1 + START_DRAWS]]
    geared = []
    for ratio in RATIOS * design.linkage.gear_ratio:
        other = design.with_linkage(gear_ratio=float(ratio))
        if not runnable(other.linkage.cadence):
            continue
        set_at = min(float(other.linkage.cadence), FASTEST_CADENCE)  # beyond it no gear counts
        geared.append(replace(best, design=other, drive=stimulated_rider(muscles, other, set_at)))
    on_slopes = {slope: [replace(ride, road=Road(slope=slope)) for ride in geared] for slope in SLOPES}
    with ThreadPoolExecutor(THREADS) as threads:
        return Riding(
            design,
            group,
            transmission,
            balanced,
            [*threads.map(solved, level)],
            [*threads.map(solved, uphill)],
            [*threads.map(lambda ride: starts(ride, TRIED_ANGLES), brief)],
            {slope: _fastest([*threads.map(solved, rides)]) for slope, rides in on_slopes.items()},
        )


def _fastest(traces: list[Trace]) -> Gear | None:
    """The best of the gears of RATIOS that need no cadence beyond what is known, and of which MuJoCo says the same."""
    within = [trace for trace in traces if trace.mean_speed and (trace.cadence or 0.0) <= FASTEST_CADENCE]
    for trace in sorted(within, key=lambda trace: -(trace.mean_speed or 0.0)):
        if RideCase(replace(trace.ride, duration=SHORT)).agrees:
            at_end = trace in (traces[0], traces[-1])
            return Gear(trace.ride.design.linkage.gear_ratio, trace.mean_speed or 0.0, at_end)
    return None


@table("riding", draws=str(RIDE_DRAWS))
def speed_table(rides: list[Riding]) -> Rows:
    """What each settles to on the flat, and whether it rides on the slope that its mean power balances."""
    for riding in rides:
        yield (
            *riding.names,
            _with_scatter(lambda trace: trace.mean_speed and trace.mean_speed / KMH, riding.flat),
            _with_scatter(lambda trace: trace.cadence and trace.cadence / RPM, riding.flat, 0),
            _with_scatter(lambda trace: trace.ripple and 100 * trace.ripple, riding.flat),
            100 * riding.flat[0].coasting_share,
            100 * riding.slope,
            "rides" if riding.uphill[0].rides else f"stops after {riding.uphill[0].stopped_at:.0f} s",
            f"{sum(trace.rides for trace in riding.uphill[1:])} of {len(riding.uphill) - 1}",
        )


@table("starts", angles=str(2 * TRIED_ANGLES), draws=str(START_DRAWS))
def start_table(rides: list[Riding]) -> Rows:
    """From which crank angles each starts, the launch it needs, the slope it climbs."""
    for riding in rides:
        yield (
            *riding.names,
            _with_scatter(lambda start: 100 * start.share, riding.starts, 0),
            _with_scatter(lambda start: None if start.launch is None else start.launch / KMH, riding.starts),
            _with_scatter(lambda start: None if start.slope is None else 100 * start.slope, riding.starts),
        )


@table("gears", ratios=str(len(RATIOS)), rpm=f"{FASTEST_CADENCE / RPM:.0f}")
def gear_table(rides: list[Riding]) -> Rows:
    """The gear ratio with which each is fastest on the flat and uphill."""
    for riding in rides:
        cells: list[str | float | None] = []
        for gear in riding.gears.values():
            cells += [f"{gear.ratio:.2f}{AT_END * gear.at_end}", gear.speed / KMH] if gear else [None, None]
        yield *riding.names, riding.design.linkage.gear_ratio, *cells


@table("transmissions")
def transmission_table(rides: list[Riding]) -> Rows:
    """Distance in a minute with a fixed gear per that with a freewheel, beside what was measured on the road."""
    distances = {riding.names: [riding.flat[0].distance.max(), riding.uphill[0].distance.max()] for riding in rides}
    for (name, group, transmission), fixed in distances.items():
        if transmission == "fixed":
            pairs = zip(fixed, distances[name, group, "freewheel"], strict=True)
            yield name, group, *(100 * (float(one) / float(other) - 1) for one, other in pairs)


def _with_scatter(of: Callable[[Any], float | None], rides: Sequence[Any], digits: int = 1) -> str | None:
    """The value of the best known muscles and the standard deviation of those drawn; None without the one."""
    best, *drawn = map(of, rides)
    values = [value for value in drawn if value is not None]
    return None if best is None else with_sd(best, float(np.std(values, ddof=1)) if len(values) > 1 else None, digits)
