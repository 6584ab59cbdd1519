"""Consistency with what the paper and Szecsi et al. print: identified dimensions, recovered moments, powers."""

import math

import numpy as np
import pytest

from fes_mj import load_design, load_moments, quasi_static
from fes_mj.linkage.assembly import grashof_margin, joint_ranges
from fes_mj.linkage.design_file import SIX_BARS
from fes_mj.moments.joint_moments import RIDER_GROUPS
from fes_mj.moments.reference_tricycle import PAPER_TRICYCLE
from fes_mj.paper.evidence import functional, load_evidence
from fes_mj.paper.identification import identify
from fes_mj.paper.printed import table1
from fes_mj.paper.reconstruction import choose_hyperparameters, condition


@pytest.mark.parametrize("name", SIX_BARS)
def test_identified_designs_move_as_table_1_says(name: str) -> None:
    design, row = load_design(name), table1()[name]
    assert np.abs(joint_ranges(design) - [*row.knee_range, *row.hip_range]).max() <= 0.5
    assert grashof_margin(design) > 0


def test_other_readings_do_not_fit() -> None:
    """The TRT's seat angle fits no six-bar, gamma = 0 does not fit D1: no point of the rounding box does."""
    row, printed = table1()["d1"], load_design("d1", "printed")
    assert identify(printed, row, math.radians(30), math.radians(90)).feasible
    assert not identify(printed, row, math.radians(30), 0.0).feasible
    assert not identify(printed, row, math.radians(60), math.radians(90)).feasible


@pytest.mark.parametrize("group", RIDER_GROUPS)
def test_recovered_moments_give_the_printed_powers(group: str) -> None:
    """Within three of the evidence's own errors (0.1 W for the TRT, 0.4 W for the rounded six-bars)."""
    moments = load_moments(group)
    for name, row in table1().items():
        power = quasi_static(load_design(name), moments).power_mean
        assert power == pytest.approx(row.power[group], abs=0.3 if name == "trt" else 1.2), name


@pytest.mark.parametrize("group", RIDER_GROUPS)
def test_the_15_watts_of_section_3_are_predicted_without_being_used(group: str) -> None:
    rows = [row for row in load_evidence() if row.group == group]
    others = [row for row in rows if row.quantity != "crank_power"]
    (asked,) = (row for row in rows if row.quantity == "crank_power")
    mean, deviation = condition(others, choose_hyperparameters(load_evidence())).predict(functional(asked))
    assert abs(mean - 15.0) < 3 * math.hypot(deviation, asked.error)
    assert deviation < 1.0


def test_knee_plateau_of_section_7() -> None:
    """Near 20 N m in extension at 73 deg, near -1 N m in flexion (P1P2)."""
    from fes_mj.moments.torque_map import TorqueMap

    torque_map = TorqueMap(load_moments("p1p2"))
    assert torque_map.moment("knee", math.radians(73), 1.0) == pytest.approx(20, abs=4)
    assert torque_map.moment("knee", math.radians(73), -1.0) == pytest.approx(-1, abs=4)


def test_reference_ranges_are_those_of_table_1() -> None:
    assert np.degrees(PAPER_TRICYCLE.ranges.knee) == pytest.approx([69, 122], abs=0.5)
    assert np.degrees(PAPER_TRICYCLE.ranges.hip) == pytest.approx([85, 120], abs=0.5)


def test_cadences_of_equation_16() -> None:
    rpm = {name: load_design(name).linkage.cadence * 30 / np.pi for name in ("trt", "r1", "r2", "d1", "d2")}
    assert rpm == pytest.approx({"trt": 60.1, "r1": 93.2, "r2": 83.1, "d1": 96.4, "d2": 93.6}, abs=0.05)
