"""Designs, alone and in batches: what they refuse, and how they are changed."""

import math

import numpy as np
import pytest

from fes_mj.common.errors import InputError
from fes_mj.common.units import RPM
from fes_mj.linkage.design import SEXES, TRICYCLE_SPEED, WHEEL_DIAMETER, Frame, Linkage, Rider
from fes_mj.linkage.design_file import load_design
from fes_mj.linkage.inertia import DE_LEVA, FOOT_LENGTH
from fes_mj.linkage.legs import LEGS
from fes_mj.linkage.variables import crank_speed, replaced


def test_words_that_nothing_is_known_of_are_refused_where_they_are_said() -> None:
    with pytest.raises(InputError, match=r"kind is 'abc'.* trt, crt, cdt"):
        Linkage("abc", -0.7 - 0.3j, 0.15, 0.07)
    with pytest.raises(InputError, match="branch is 'up'"):
        Linkage("crt", -0.7 - 0.3j, 0.15, 0.07, branch="up")
    with pytest.raises(InputError, match="sex is 'x'"):
        Rider(sex="x")
    with pytest.raises(InputError, match=r"legs is 3\b.* 1 or 2"):
        _ = LEGS[3]
    assert (*DE_LEVA,) == (*FOOT_LENGTH,) == SEXES


@pytest.mark.parametrize("cadence", [0.0, -6.0, math.nan, math.inf])
def test_a_cadence_at_which_nothing_turns_is_refused(cadence: float) -> None:
    with pytest.raises(InputError, match=rf"d1: cadence is {cadence / RPM:.4g} rpm"):
        crank_speed(load_design("d1"), cadence)


def test_a_cadence_that_is_not_given_is_the_designs_own() -> None:
    design = load_design("d1")
    assert crank_speed(design) == design.linkage.cadence
    assert crank_speed(design, 6.0) == 6.0


def test_numbers_that_a_linkage_has_by_itself() -> None:
    """A wheel that the crank turns 1.5 times as fast; the hinge of the crank seen from the hip; a seat of 30 deg."""
    linkage = Linkage("crt", -0.7 - 0.3j, 0.15, 0.07, 0.2 + 0.1j, gear_ratio=1.5)
    assert linkage.cadence == pytest.approx(1.5 * TRICYCLE_SPEED / (WHEEL_DIAMETER / 2), rel=1e-15)
    assert linkage.crank_centre == pytest.approx(-0.5 - 0.2j)
    assert linkage.seat_angle == pytest.approx(math.radians(30))


def test_what_stands_still_moves_with_the_hips_way() -> None:
    known = Frame((0.1 - 0.2j, -0.5 - 0.1j), 0.04, 0.2, 0.5, 0.3 - 0.25j, -0.5)
    assert known.moved(0.02 + 0.03j) == Frame(
        (pytest.approx(0.12 - 0.17j), pytest.approx(-0.48 - 0.07j)),
        *(0.04, 0.2, 0.5, pytest.approx(0.32 - 0.22j), pytest.approx(-0.47)),
    )
    assert Frame().moved(0.02 + 0.03j) == Frame()


def test_the_designs_of_a_batch_are_those_that_it_was_made_of() -> None:
    design, crank, mass = load_design("d1"), np.array([[0.1], [0.12], [0.14]]), np.array([[60.0], [70.0], [80.0]])
    batch = design.with_linkage(crank=crank).with_rider(mass=mass)
    assert batch.is_batch
    assert not design.is_batch
    assert (batch.size, design.size) == (3, 1)
    alone = [replaced(design, {"R2": crank[row, 0].item(), "mass": mass[row, 0].item()}) for row in range(3)]
    assert [batch.single(row) for row in range(3)] == alone
    later = batch.taken([2, 0])
    assert [later.single(row) for row in range(2)] == [alone[2], alone[0]]
    assert design.taken([0, 0]) == design.single(5) == design
