"""Seats and the ground that a design file names."""

from dataclasses import replace

import pytest

import fes_mj
from fes_mj.fit.ground import above_ground
from fes_mj.fit.seat import fit_seat
from fes_mj.fit.seats import SeatLimits
from fes_mj.linkage.design import Frame
from fes_mj.linkage.design_file import design_toml
from fes_mj.linkage.shapes import lowest_point

pytestmark = pytest.mark.usefixtures("coarse_seats")
MOMENTS = fes_mj.load_moments("p1p2")


def _on_ground(height: float) -> fes_mj.Design:
    return replace(fes_mj.load_design("d1"), frame=Frame(ground_height=height, wheel_centre=0.2 - 0.3j))


def test_the_seat_itself_stays_above_the_ground() -> None:
    """It is 14 cm below the hip: with the ground 10 cm below it the seat must go up by those 4 and 5 mm more."""
    assert above_ground(_on_ground(-0.1), SeatLimits()).up == pytest.approx((0.045, 0.15))
    assert above_ground(_on_ground(-2.0), SeatLimits()) == SeatLimits()
    assert above_ground(fes_mj.load_design("d1"), SeatLimits()) == SeatLimits()
    free, kept = (fit_seat(_on_ground(height), fes_mj.Rider(), MOMENTS) for height in (-2.0, -0.1))
    assert free.seat.up < 0.045 <= kept.seat.up
    assert free.static
    assert free.design.frame.ground_height is not None
    assert lowest_point(free.design) - free.design.frame.ground_height >= 0.005


def test_an_underground_seat_does_not_fit() -> None:
    fit = fit_seat(_on_ground(0.1), fes_mj.Rider(), MOMENTS)
    assert not fit.fits
    assert "mm below the ground; 5 mm are needed" in str(fit.why)


def test_what_stands_still_stays_where_it_is_when_the_seat_moves() -> None:
    """Seen from the hip, wheel and ground move as the crank centre does."""
    drawn = _on_ground(-2.0)
    fit = fit_seat(drawn, fes_mj.Rider(thigh=0.47, shank=0.47), MOMENTS)
    moved = fit.design.linkage.crank_centre - drawn.linkage.crank_centre
    assert abs(moved) > 0.01
    assert fit.design.frame.wheel_centre == pytest.approx(0.2 - 0.3j + moved, abs=1e-6)
    assert fit.design.frame.ground_height == pytest.approx(-2.0 + moved.imag, abs=1e-6)
    assert "[frame]" in design_toml(fit.design)
