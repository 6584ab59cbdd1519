"""The page on riding: what its rows say, by rides of its own, and what must hold between them."""

import json
from dataclasses import replace
from functools import partial
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from fes_mj import load_design
from fes_mj.budget.unknowns import MASSES, budget_priors
from fes_mj.common.units import KMH
from fes_mj.muscles.drive import Muscles, load_muscles
from fes_mj.muscles.riders import load_riders
from fes_mj.paper import riding
from fes_mj.paper.printed import table1
from fes_mj.riding.ride import TRANSMISSIONS, Ride, Road, balancing_slope
from fes_mj.riding.stimulated import stimulated_rider
from fes_mj.riding.trace import ride as solved
from fes_mj.riding.verdict import FASTEST_CADENCE

PAGE = json.loads((Path(__file__).parents[2] / "results" / "reproduction.json").read_text(encoding="utf-8"))["riding"]
SPEEDS = {
    (row["design"], row["group"], row["transmission"]): row
    for row in PAGE["How fast they ride, and whether they keep riding"]
}
GEARS = {(row["design"], row["group"], row["transmission"]): row for row in PAGE["The gear ratio that suits"]}


def printed(cell: str | None) -> str | None:
    """The value of a cell without its error."""
    return None if cell is None else cell.split(" ")[0]


def in_kmh(speed: float | None) -> str | None:
    """A speed in m/s as it is printed."""
    return None if speed is None else f"{speed / KMH:.1f}"


def test_every_design_rides_with_both_groups_and_transmissions() -> None:
    assert len(SPEEDS) == 4 * len(table1()) == 20
    assert len(PAGE["The gear ratio that suits"]) == len(PAGE["From where they start, and what they climb"]) == 20


@pytest.mark.long
@pytest.mark.parametrize(("name", "group", "transmission"), [("trt", "p1p3", "fixed"), ("d1", "p1p2", "freewheel")])
def test_a_row_is_what_a_ride_alone_says(name: str, group: str, transmission: str) -> None:
    """On the flat, on its slope and in its best gear, by the muscles that `fes_mj ride` takes."""
    design, muscles, row = load_design(name), load_muscles(group), SPEEDS[name.upper(), group, transmission]
    ride = Ride(design, stimulated_rider(muscles, design), transmission=transmission)
    uphill = solved(replace(ride, road=Road(slope=balancing_slope(ride))))
    assert printed(row["speed, km/h"]) == in_kmh(solved(ride).mean_speed)
    assert row["slope, %"] == pytest.approx(100 * uphill.ride.road.slope, rel=1e-6)
    assert row["on this slope"] == ("rides" if uphill.rides else f"stops after {uphill.stopped_at:.0f} s")
    gear = GEARS[name.upper(), group, transmission]
    best = float(gear["best on the flat"].split(" ")[0])
    ratio = min(riding.RATIOS * design.linkage.gear_ratio, key=lambda ratio: abs(ratio - best))
    geared = design.with_linkage(gear_ratio=float(ratio))
    windows_at = min(geared.linkage.cadence, FASTEST_CADENCE)  # as the table's note says
    ride = Ride(geared, stimulated_rider(muscles, geared, windows_at), transmission=transmission)
    assert f"{gear['speed, km/h']:.1f}" == in_kmh(solved(ride).mean_speed)


def test_everything_that_matters_on_a_road_is_drawn_and_always_the_same() -> None:
    design, muscles = load_design("d1"), Muscles(load_riders("p1p3").taken(slice(0, 30)))
    ride = Ride(design, stimulated_rider(muscles, design))
    drawn, again = (riding.drawn_rides(ride, muscles, 20) for _ in range(2))
    assert 15 < len(drawn) <= 20
    for of in (
        lambda one: one.drive.riders["rise_s"].item(),
        lambda one: one.design.linkage.crank,
        lambda one: one.design.rider.thigh,
        lambda one: one.design.rider.leg_mass_factor,
    ):
        values = [of(one) for one in drawn]
        assert len({*values}) == len(drawn)
        assert values == [of(one) for one in again]
    factors = np.log([one.design.rider.leg_mass_factor for one in riding.drawn_rides(ride, muscles, 200)])
    assert factors.std() == pytest.approx(budget_priors()[MASSES]["log_sd"], rel=0.2)
    assert {one.drive.cadence for one in drawn} == {design.linkage.cadence}


def test_rows_have_the_units_of_their_heads() -> None:
    """Of made-up rides: km/h, rpm and per cent; the deviation is that of what was drawn, and what stops has none."""
    flat = [
        SimpleNamespace(mean_speed=speed, cadence=cadence, ripple=ripple, coasting_share=0.25)
        for speed, cadence, ripple in ((2.0, 5.0, 0.1), (2.5, 6.0, 0.2), (3.5, 8.0, 0.4), (None, None, None))
    ]
    uphill = [SimpleNamespace(rides=rides, stopped_at=None if rides else 7.4) for rides in (False, True, False)]
    begun = [
        SimpleNamespace(share=share, launch=launch, slope=slope)
        for share, launch, slope in ((0.5, 1.0, 0.02), (0.7, 2.0, 0.04), (0.6, None, None))
    ]
    gears: dict[float, riding.Gear | None] = {0.0: riding.Gear(1.234, 2.5, True), 0.02: None}
    made = riding.Riding(load_design("trt"), "p1p2", "fixed", 0.03, flat, uphill, begun, gears)  # type: ignore[arg-type]
    names = ("TRT", "p1p2", "fixed")
    (speeds,), (start,), (gear,) = (
        [*map(tuple, of([made]).rows)] for of in (riding.speed_table, riding.start_table, riding.gear_table)
    )
    assert speeds == (*names, "7.2 +- 2.5", "48 +- 14", "10.0 +- 14.1", 25.0, 3.0, "stops after 7 s", "1 of 2")
    assert start == (*names, "50 +- 7", "3.6", "2.0")
    assert gear == (*names, 1.31, "1.23 (end of the range)", 9.0, None, None)


@pytest.mark.long
def test_a_riding_of_few_draws(monkeypatch: pytest.MonkeyPatch) -> None:
    """Every table of the page from one design."""
    pytest.importorskip("numba")
    monkeypatch.setattr(riding, "RIDE_DRAWS", 2)
    monkeypatch.setattr(riding, "START_DRAWS", 0)
    monkeypatch.setattr(riding, "TRIED_ANGLES", 2)
    monkeypatch.setattr(riding, "RATIOS", np.array([0.8, 1.0]))
    monkeypatch.setattr(riding, "SHORT", 2.0)
    monkeypatch.setattr(riding, "Ride", partial(Ride, duration=4.0))
    muscles = Muscles(load_riders("p1p3").taken(slice(0, 8)))
    rides = [riding._riding(load_design("trt"), "p1p3", muscles, kind) for kind in TRANSMISSIONS]
    tables = (riding.speed_table, riding.start_table, riding.gear_table, riding.transmission_table)
    assert [len(table(rides).records()) for table in tables] == [2, 2, 2, 1]
    gears = [gear for one in rides for gear in one.gears.values() if gear]
    assert {round(gear.ratio / load_design("trt").linkage.gear_ratio, 9) for gear in gears} <= {0.8, 1.0}
