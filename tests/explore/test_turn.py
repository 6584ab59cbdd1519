"""Curves and numbers of the page are those of the solvers that it shows, and they come at once."""

import gc
import time
import tracemalloc
from dataclasses import replace

import numpy as np
import pytest

import fes_mj
from fes_mj.explore.answers import Answers
from fes_mj.explore.dimensions import content_of
from fes_mj.explore.server import encoded
from fes_mj.explore.turn import DIGITS, SENT_POINTS, turn
from fes_mj.linkage.design import Design
from fes_mj.linkage.variables import replaced
from fes_mj.moments.fourier import fourier
from fes_mj.statics.turn import quasi_static
from tests.explore.conftest import question

ROUNDED = 0.5001 * 10.0**-DIGITS
GROUPS = {name: fes_mj.load_moments(name) for name in ("p1p2", "p1p3")}


def text_of(numbers: list[dict[str, str]], name: str) -> str:
    return next(number["text"] for number in numbers if number["name"] == name)


@pytest.mark.parametrize("group", GROUPS)
def test_power_is_that_of_statics(design: Design, group: str) -> None:
    shown = turn(design, GROUPS)["moments"][group]
    static = quasi_static(design, GROUPS[group])
    np.testing.assert_allclose(shown["static"], static.power[:: len(static.power) // SENT_POINTS], atol=ROUNDED)
    assert text_of(shown["numbers"], "power") == f"{static.power_mean:.2f}"
    assert shown["power_mean_W"] == pytest.approx(static.power_mean, rel=1e-12)


def test_power_near_a_dead_centre_is_that_of_statics() -> None:
    """Where a few angles more or less change the mean by percents."""
    linkage = fes_mj.load_design("d1").linkage
    longest = linkage.rocker + linkage.coupler - abs(linkage.pivot_to_crank)  # of cranks that turn
    near = replaced(fes_mj.load_design("d1"), {"R2": longest - 2e-4})
    static = quasi_static(near, GROUPS["p1p2"])
    assert turn(near, GROUPS)["moments"]["p1p2"]["power_mean_W"] == pytest.approx(static.power_mean, rel=1e-9)


def test_masses_move_power_about_but_make_none(design: Design) -> None:
    shown = turn(design, GROUPS)["moments"]["p1p2"]
    assert np.mean(shown["masses"]) == pytest.approx(np.mean(shown["static"]), abs=2 * ROUNDED)
    assert np.ptp(shown["masses"] - shown["static"]) > 1


@pytest.mark.long
def test_the_band_is_that_of_many_curves() -> None:
    """Power under moments drawn from their covariance scatters as much as the band says, at every angle."""
    design, moments = fes_mj.load_design("d1"), GROUPS["p1p2"]
    generator, count = np.random.default_rng(7), 400
    mean = np.concatenate([*moments.coefficients])
    angle = np.radians(np.arange(0.0, 360.0, 2.0))
    powers = []
    for row in generator.multivariate_normal(mean, moments.covariance, count, method="eigh"):
        knee, hip = (fourier(angle) @ part for part in np.split(row, 2))
        drawn = replace(moments, crank_angle=angle, knee=knee, hip=hip)
        powers.append(quasi_static(design, drawn, points=SENT_POINTS).power)
    scatter = np.std(powers, axis=0)
    sd = turn(design, GROUPS)["moments"]["p1p2"]["sd"]
    # a standard deviation from so many samples is itself unsure by 1 / sqrt(2 n) of it; five times that
    np.testing.assert_allclose(scatter, sd, rtol=5 / np.sqrt(2 * count), atol=0.02)


def test_two_legs_are_half_a_turn_apart() -> None:
    one, two = (turn(fes_mj.load_design("d1"), GROUPS, legs)["moments"]["p1p2"] for legs in (1, 2))
    for curve in ("static", "masses"):
        total = one[curve] + np.roll(one[curve], SENT_POINTS // 2)
        np.testing.assert_allclose(two[curve], total, atol=3 * ROUNDED)
    assert np.all(two["sd"] <= one["sd"] + np.roll(one["sd"], SENT_POINTS // 2) + 2 * ROUNDED)
    assert one["numbers"] == two["numbers"]  # of one leg


def test_a_linkage_that_does_not_turn_says_why_and_is_still_drawn() -> None:
    answer = turn(replaced(fes_mj.load_design("d1"), {"R2": 0.25}), GROUPS)
    assert "rocker and coupler cannot close at crank angle" in answer["why"]
    assert f"{answer['failing']['deg']:.1f} deg" in answer["why"]
    assert answer["bodies"]
    assert "moments" not in answer


def test_a_joint_that_never_has_moments_says_so() -> None:
    answer = turn(replaced(fes_mj.load_design("d1"), {"seat_angle": -80.0}), GROUPS)
    assert "it never comes into that range" in answer["why"]
    assert answer["failing"] is None


def test_outside_the_moments_range_is_marked() -> None:
    shown = turn(replaced(fes_mj.load_design("d1"), {"seat_angle": 25.0}), GROUPS)
    under = shown["moments"]["p1p2"]
    outside = shown["joints"]["hip"] > under["range_deg"]["hip"][1] + 0.02
    assert outside.any()
    assert np.all(under["outside"][outside])
    assert "no moments are known" in under["note"]


@pytest.mark.long
def test_turns_leave_nothing_behind() -> None:
    """Once the caches (at most 256 designs) are full, many more turns take less memory than the answer to one."""
    design, own, sizes = fes_mj.load_design("d1"), {"p1p2": GROUPS["p1p2"]}, []
    tracemalloc.start()
    for n in range(340):
        answer = encoded(turn(replaced(design, {"R2": 0.14 + 5e-5 * n}), own))
        if n in (270, 339):
            gc.collect()
            sizes.append(tracemalloc.get_traced_memory()[0])
    tracemalloc.stop()
    assert sizes[1] - sizes[0] < len(answer)


def test_from_slider_to_new_curves(answers: Answers) -> None:
    """In at most 100 ms of processor time, with all that is sent to the page; what runs beside it only adds to that."""
    design, took = fes_mj.load_design("d1"), []
    for n in range(11):
        asked = question(design=content_of(replaced(design, {"R2": 0.155 + 0.0005 * n})))
        start = time.thread_time()
        encoded(answers.turn(asked))
        took.append(time.thread_time() - start)
    assert min(took[1:]) <= 0.1
