"""What a ride is said to have done, and why, by rides of the reduced model."""

import math
from dataclasses import replace

import pytest

import fes_mj
from fes_mj.riding.ride import Ride, Road
from fes_mj.riding.trace import ride as solved
from fes_mj.riding.verdict import outside_known, rolls_back, sentence, verdict

PLAIN = fes_mj.load_moments("p1p2")
WEAK = replace(PLAIN, name="weak", knee=PLAIN.knee / 10, hip=PLAIN.hip / 10)


@pytest.mark.parametrize(
    ("ride", "word", "reason"),
    [
        (Ride(fes_mj.load_design("r2"), PLAIN, duration=10), "rides", None),
        (Ride(fes_mj.load_design("r1"), PLAIN, Road(slope=0.10), duration=20), "stops", "the slope takes "),
        (Ride(fes_mj.load_design("d1"), PLAIN, Road(slope=0.033), duration=20), "stops", "dead centre at "),
        (
            Ride(fes_mj.load_design("d1"), PLAIN, Road(slope=0.03), launch=0, start=math.radians(90)),
            "does-not-start",
            "the crank never turned: dead centre at 90 deg",
        ),
        (Ride(fes_mj.load_design("d1"), WEAK, Road(slope=-0.05), duration=20), "coasts", "the freewheel runs free 9"),
    ],
    ids=lambda value: value.name if isinstance(value, Ride) else None,
)
def test_verdicts_and_their_reasons(ride: Ride, word: str, reason: str | None) -> None:
    trace = solved(ride)
    told = verdict(trace)
    assert told.word == word
    assert told.reason is None if reason is None else str(told.reason).startswith(reason)
    assert trace.rides == (word in ("rides", "coasts"))


def test_a_ride_ends_where_the_crank_has_turned_back_by_a_turn() -> None:
    trace = solved(Ride(fes_mj.load_design("r1"), PLAIN, Road(slope=0.10), duration=60))
    assert rolls_back(trace)
    assert sentence(trace).endswith("; then it rolls back.")
    back = trace.crank_angle.max() - trace.crank_angle
    assert back[-1] > 2 * math.pi >= back[-2]


def test_a_ride_ends_where_it_stands_for_good(smooth_moments: fes_mj.JointMoments) -> None:
    held = Road(slope=0.001, rolling_resistance=0.5)
    trace = solved(Ride(fes_mj.load_design("trt"), smooth_moments, held, launch=0.0))
    assert 2 < trace.time[-1] < 2.1
    assert trace.turns == 0


def test_what_is_outside_anything_measured_is_named() -> None:
    """Moments the same at any speed turn R1's crank faster and faster; on a slope it stays at a rider's pace."""
    fast = solved(Ride(fes_mj.load_design("r1"), PLAIN, transmission="fixed", duration=30))
    cadence, knee = outside_known(fast)
    assert cadence.startswith(f"{(fast.cadence or 0) * 30 / math.pi:.0f} rpm")
    assert knee.startswith("the knee at ")
    assert "Outside what is known: " in sentence(fast)
    slow = solved(Ride(fes_mj.load_design("trt"), PLAIN, Road(slope=0.0112), "fixed", duration=10))
    assert outside_known(slow) == []
