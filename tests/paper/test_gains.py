"""What makes a gain comparable on cases with known answers; slopes against the quasi-static solver and the page."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import fes_mj
from fes_mj.linkage.variables import LENGTHS, lengths, with_lengths
from fes_mj.moments.uncertainty import standard_deviation, with_sd
from fes_mj.paper.gains import MADE_FOR, STEP, at_knee_speed, slopes
from fes_mj.paper.runs import joint_speed
from fes_mj.statics.turn import QuasiStatic, quasi_static

PAGE = json.loads((Path(__file__).parents[2] / "results" / "reproduction.json").read_text(encoding="utf-8"))["gains"][
    "What the paper's search held"
]


@pytest.mark.parametrize("name", MADE_FOR)
@pytest.mark.parametrize("length", ["R2", "R7x"])
def test_slopes_are_differences_of_the_solver(name: str, length: str) -> None:
    """From free-body equilibrium at 3600 angles; its mean is right to 1e-5 of itself, a slope to 2e-5 P / 0.02 cm."""
    design, moments = fes_mj.load_design(name), fes_mj.load_moments(MADE_FOR[name])
    row = LENGTHS.index(length)

    def at(step: float, cadence: float | None = None) -> QuasiStatic:
        shifted = with_lengths(design, lengths(design) + step * np.eye(9)[row])
        return quasi_static(shifted, moments, cadence)

    middle = at(0.0)
    more, less = at(STEP), at(-STEP)
    by_held, near = slopes(design, moments), 2e-5 * middle.power_mean / (200 * STEP)
    value, deviation = (part[row] for part in by_held["gear ratio"])
    assert value == pytest.approx((more.power_mean - less.power_mean) / (200 * STEP), abs=near)
    assert moments.covariance is not None
    by_moments = standard_deviation(more.power_weights - less.power_weights, moments.covariance)
    assert deviation == pytest.approx(by_moments / (200 * STEP), abs=near)
    speed = joint_speed(middle, "knee")[0]
    slowed = [at(step, middle.cadence * speed / joint_speed(at(step), "knee")[0]) for step in (STEP, -STEP)]
    difference = (slowed[0].power_mean - slowed[1].power_mean) / (200 * STEP)
    assert by_held["knee speed"][0][row] == pytest.approx(difference, abs=3 * near)


def test_slopes_of_a_linkage_that_cannot_turn_are_unknown() -> None:
    moments = replace(fes_mj.load_moments("p1p3"))
    assert np.isnan(slopes(fes_mj.load_design("r2", "printed"), moments)["gear ratio"][0]).all()


def test_the_page_is_todays() -> None:
    for row in PAGE:
        if row["dimensions"] == "identified":
            name = row["design"].lower()
            slope, deviation = slopes(fes_mj.load_design(name), fes_mj.load_moments(row["group"]))[row["held"]]
            cells = [with_sd(*pair, 1) for pair in zip(slope.tolist(), deviation.tolist(), strict=True)]
            assert [row[f"{length}, W/cm"] for length in LENGTHS] == cells


def test_equal_knee_speed_scales_power() -> None:
    result = quasi_static(fes_mj.load_design("d1"), fes_mj.load_moments("p1p2"))
    slowed = at_knee_speed(result, joint_speed(result, "knee")[0] / 2)
    assert slowed.power_mean == pytest.approx(result.power_mean / 2)
    assert joint_speed(slowed, "knee")[0] == pytest.approx(joint_speed(result, "knee")[0] / 2)
