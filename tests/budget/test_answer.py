"""The two numbers of a design: rider by rider, against the single designs that were drawn."""

from dataclasses import replace

import numpy as np
import pytest

import fes_mj
from fes_mj.budget.answer import Answer, rider_powers, riders_of
from fes_mj.budget.unknowns import drawn_designs
from fes_mj.linkage.design_file import load_design
from fes_mj.muscles.power import best_turn, muscle_turn
from fes_mj.muscles.riders import Riders, load_riders
from fes_mj.statics.turn import quasi_static


@pytest.fixture(scope="module")
def riders() -> Riders:
    """A few of a group."""
    return load_riders("p1p2").taken(slice(0, 200, 20))


@pytest.mark.parametrize("name", ["trt", "d2"])
def test_every_rider_has_a_linkage_of_its_own(name: str, riders: Riders) -> None:
    design = load_design(name)
    _, windows = best_turn(riders, design)
    drawn = drawn_designs(design, len(riders))
    alone = [
        muscle_turn(riders.taken([row]), drawn.single(row), design.linkage.cadence, windows).power_mean.item()
        for row in range(len(riders))
    ]
    assert rider_powers(design, riders) == pytest.approx(alone, rel=1e-6)  # near a dead centre rounding grows
    assert len({*alone}) == len(riders)


def test_one_who_cannot_turn_has_no_power(riders: Riders) -> None:
    """A crank so long that the leg is nearly straight: with shorter legs it does not turn."""
    design = load_design("trt")
    longest = max(
        (design.with_linkage(crank=crank) for crank in np.arange(0.15, 0.3, 0.003)), key=lambda one: _power(one, riders)
    )
    powers = rider_powers(longest, riders)
    assert 0 < np.isnan(powers).sum() < len(riders)
    answer = Answer(longest, rider=powers, trt=rider_powers(design, riders))
    assert answer.summary()["rider_draws_that_do_not_turn"] == np.isnan(powers).sum()
    assert answer.rider_power is not None
    assert answer.rider_power.value == pytest.approx(np.nanmean(powers))


def _power(design: fes_mj.Design, riders: Riders) -> float:
    """The crank's length, if the design as it is can be ridden."""
    try:
        rider_powers(design, riders)
    except (fes_mj.AssemblyError, fes_mj.InputError):
        return 0.0
    return float(design.linkage.crank)


def test_ratios_are_of_the_same_riders(riders: Riders) -> None:
    moments = fes_mj.load_moments("p1p2")
    trt, d1 = (
        fes_mj.answer(design, [quasi_static(design, moments)], riders) for design in map(load_design, ("trt", "d1"))
    )
    assert trt.rider_ratio is not None
    assert (*trt.rider_ratio,) == (1, 1, 1)
    paper, rider = d1.per(trt)
    assert rider == d1.rider_ratio
    assert paper is not None
    assert paper.value == pytest.approx(2.118, abs=1e-3)  # within its interval, of draws that both share
    assert paper.low < paper.value < paper.high


def test_what_is_not_known_says_why(riders: Riders) -> None:
    design = load_design("trt")
    assert fes_mj.answer(design).missing.startswith("no muscles belong to these moments; `fes_mj moments")
    steep = design.with_linkage(seat_angle=np.radians(-40))
    assert "muscle lengths are known" in fes_mj.answer(steep, riders=riders).missing
    short = fes_mj.answer(load_design("r1").with_rider(thigh=0.46, shank=0.44), riders=riders)
    assert short.rider is not None
    assert "no tricycle to compare with" in short.missing
    assert short.summary()["rider_power_per_trt"] is None


def test_riders_belong_to_the_moments_that_ship_and_to_no_others_of_their_name() -> None:
    shipped, muscles = fes_mj.load_moments("p1p2"), fes_mj.load_muscles("p1p3")
    assert riders_of(shipped) is load_riders("p1p2")
    assert riders_of(replace(shipped, covariance=None)) is None
    assert riders_of(muscles) is muscles.riders
