"""The page on riding: what its rows say, by rides of its own, and what must hold between them."""

import json
from pathlib import Path

import pytest

from fes_mj import load_design, load_moments
from fes_mj.paper import riding
from fes_mj.paper.printed import table1
from fes_mj.riding.ride import Ride, Road
from fes_mj.riding.trace import ride as solved

PAGE = json.loads((Path(__file__).parents[2] / "results" / "reproduction.json").read_text(encoding="utf-8"))["riding"]
SPEEDS = {
    (row["design"], row["group"], row["transmission"]): row
    for row in PAGE["How fast they ride, and whether they keep riding"]
}


def test_every_design_rides_with_both_groups_and_transmissions() -> None:
    assert len(SPEEDS) == 4 * len(table1()) == 20
    assert len(PAGE["The gear ratio that suits"]) == len(PAGE["From where they start, and what they climb"]) == 20


@pytest.mark.parametrize(("transmission", "rides"), [("freewheel", False), ("fixed", True)])
def test_d1_on_the_slope_that_its_mean_power_climbs(transmission: str, rides: bool) -> None:
    row = SPEEDS["D1", "p1p2", transmission]
    moments = load_moments()
    road = Road(slope=row["slope, %"] / 100)
    ride = Ride(load_design("d1"), moments, road=road, transmission=transmission, duration=20.0)
    assert solved(ride).rides is rides
    assert (row["on this slope"] == "rides") is rides


def test_muscles_are_drawn_anew_and_always_the_same() -> None:
    best, *drawn = riding._muscles("p1p2")
    again = riding._muscles("p1p2")[1:]
    assert len({float(moments.knee[0]) for moments in (best, *drawn)}) == 1 + riding.DRAWS
    assert [moments.knee.tolist() for moments in drawn] == [moments.knee.tolist() for moments in again]
