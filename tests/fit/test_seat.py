"""The seat that is found against what a moved seat must do."""

import math
import re
from dataclasses import replace

import pytest

import fes_mj
from fes_mj.common.errors import AssemblyError, InputError
from fes_mj.fit.seat import fit_seat, seat_text
from fes_mj.fit.seats import OUTSIDE_EQUAL, POWER_EQUAL, SeatLimits, Seats, outside_range
from fes_mj.linkage.design import Rider
from fes_mj.linkage.design_file import design_toml
from fes_mj.linkage.kinematics import solve
from fes_mj.linkage.riders import populations
from fes_mj.moments.reference_tricycle import PAPER_TRICYCLE
from fes_mj.statics.cycles import cycles
from fes_mj.statics.work_table import WorkTable


def test_a_moved_seat_moves_the_hip_and_nothing_else(design: fes_mj.Design) -> None:
    """Against the crank centre all of the linkage keeps its place; the hip goes forwards (-x) and up (y)."""
    moved = Seats(0.02, 0.01, 0.1).moved(design)
    before, after = (solve(seated).points for seated in (design, moved))
    for point in before.keys() - {"hip", "knee"}:
        relative = [points[point].value - points["crank_centre"].value for points in (before, after)]
        assert relative[0] == pytest.approx(relative[1])
    hips = [complex(points["hip"].value - points["crank_centre"].value) for points in (before, after)]
    assert hips[1] - hips[0] == pytest.approx(-0.02 + 0.01j)
    assert moved.linkage.seat_angle - design.linkage.seat_angle == pytest.approx(0.1)


@pytest.mark.usefixtures("coarse_seats")
def test_a_fit_stays_within_limits_and_range_and_never_loses_power() -> None:
    moments, limits = fes_mj.load_moments("p1p2"), SeatLimits((0.0, 0.1), (-0.02, 0.02), (0.0, 0.0))
    for name in ("r1", "d2"):
        design = fes_mj.load_design(name)
        fit = fit_seat(design, Rider(), moments, limits)
        assert fit.static
        assert all(low <= value <= high for value, (low, high) in zip(fit.seat, limits, strict=True))
        free = fit_seat(design, Rider(), moments)
        assert free.static
        assert outside_range(cycles(free.design, WorkTable.of(moments)))[0] <= OUTSIDE_EQUAL + 1e-9
        drawn = fes_mj.quasi_static(design, moments)
        assert free.static.power_mean > drawn.power_mean


def test_a_seat_that_need_not_move_stays() -> None:
    """The TRT delivers its own moments wherever they are in range: nothing is gained by moving."""
    fit = fit_seat(fes_mj.load_design("trt"), Rider(), fes_mj.load_moments("p1p2"))
    assert fit.seat == pytest.approx((0, 0, 0), abs=2e-3)
    assert seat_text(Seats(0.0, 0.0, 0.0)) == "stays where it is"
    assert (
        seat_text(Seats(-0.05, 0.1, math.radians(3))) == "5.0 cm away from the crank, 10.0 cm up, seat angle +3.0 deg"
    )


@pytest.mark.usefixtures("coarse_seats")
def test_who_does_not_fit_is_told_by_how_much_where_and_what_helps() -> None:
    child, moments = populations()["woman"].of_stature(1.25), fes_mj.load_moments("p1p2")
    fit = fit_seat(fes_mj.load_design("d1"), child, moments, SeatLimits((0.0, 0.1), (0.0, 0.0), (0.0, 0.0)))
    content = fit.summary()
    assert not content["fits"]
    assert content["power_mean_W"] is None
    for words in ("thigh and shank cannot close at crank angle", "mm lack"):
        assert words in content["why"]
    assert content["helps"][0].startswith("a seat that moves farther: ")
    # the least lack within the limits is where the seat is nearest
    assert content["seat_shift_m"] == pytest.approx([0.1, 0.0], abs=1e-3)


def test_a_shorter_crank_helps_where_it_does() -> None:
    """The seat is fixed, and the leg longer than hip to crank centre by less than the crank."""
    design = fes_mj.load_design("trt")
    far = abs(design.linkage.crank_centre)
    rider = Rider(thigh=0.4, shank=math.sqrt((far + 0.8 * design.linkage.crank - 0.4) ** 2 - 0.069**2))
    fit = fit_seat(design, rider, fes_mj.load_moments("p1p2"), SeatLimits((0.0, 0.0), (0.0, 0.0), (0.0, 0.0)))
    assert not fit.fits
    assert any("a crank (R2) of 10.5 instead of 15.0 cm" in text for text in fit.helps)


def test_no_seat_repairs_a_linkage_that_cannot_turn() -> None:
    with pytest.raises(AssemblyError, match="rocker and coupler"):
        fit_seat(fes_mj.load_design("r2", "printed"), Rider(), fes_mj.load_moments("p1p2"))


@pytest.mark.usefixtures("coarse_seats")
def test_a_seat_at_the_end_of_its_range_says_so_and_has_workshop_digits() -> None:
    design, moments = fes_mj.load_design("r1"), fes_mj.load_moments("p1p2")
    fit = fit_seat(design, Rider(0.41, 0.52), moments, SeatLimits((0.0, 0.03), (0.0, 0.0), (0.0, 0.1)))
    assert "forward" in fit.ends
    assert fit.summary()["at_end_of"] == fit.ends
    moved = [line for line in design_toml(fit.design).splitlines() if line.startswith(("R1", "seat_angle"))]
    assert all(len(digits) <= 6 for digits in re.findall(r"\.(\d+)", "".join(moved)))
    assert fit_seat(design, Rider(0.41, 0.52), moments).ends == []


def test_legs_with_moments_of_their_own_are_fitted_together() -> None:
    """Power is their mean, and no seat that suits one leg alone is better for both."""
    design, rider = fes_mj.load_design("r1"), Rider()
    right, left = fes_mj.load_moments("p1p2"), fes_mj.load_moments("p1p3")
    both = fit_seat(design, rider, fes_mj.load_moments("p1p2", left="p1p3"))
    assert both.static

    def mean_power(seated: fes_mj.Design) -> float:
        return (fes_mj.quasi_static(seated, right).power_mean + fes_mj.quasi_static(seated, left).power_mean) / 2

    assert both.static.power_mean == pytest.approx(mean_power(both.design), abs=1e-12)
    for moments in (right, left):
        assert both.static.power_mean > mean_power(fit_seat(design, rider, moments).design) - POWER_EQUAL


def test_legs_measured_on_different_tricycles_are_not_averaged() -> None:
    right, other = fes_mj.load_moments("p1p2"), fes_mj.load_moments("p1p3")
    tricycle = replace(PAPER_TRICYCLE, design=PAPER_TRICYCLE.design.with_linkage(crank=0.16))
    with pytest.raises(InputError, match=r"^p1p2, p1p3: "):
        WorkTable.of(replace(right, left=replace(other, measured_on=tricycle)))
