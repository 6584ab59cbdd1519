"""Against what the paper and Szecsi et al. print: identified dimensions, recovered moments, powers."""

import math
from pathlib import Path

import numpy as np
import pytest

from fes_mj import kinematics, load_design, load_moments, quasi_static
from fes_mj.errors import InputError
from fes_mj.fourier import fourier
from fes_mj.geometry import grashof_margin, joint_ranges
from fes_mj.moments import GROUPS
from fes_mj.paper.evidence import functional, load_evidence
from fes_mj.paper.identification import identify
from fes_mj.paper.printed import DATA, table1
from fes_mj.paper.reconstruction import choose_hyperparameters, condition
from fes_mj.reference_tricycle import PAPER_TRICYCLE
from fes_mj.uncertainty import power_weights

SIX_BARS = ("r1", "r2", "d1", "d2")


@pytest.mark.parametrize("name", SIX_BARS)
def test_identified_designs_move_as_table_1_says(name: str) -> None:
    design, row = load_design(name), table1()[name]
    assert np.abs(joint_ranges(design) - [*row.knee_range, *row.hip_range]).max() <= 0.5
    assert grashof_margin(design) > 0


def test_the_shipped_catalogue_is_the_output_of_the_identification() -> None:
    result = identify(load_design("r1", "printed"), table1()["r1"], math.radians(30))
    assert result.found
    shipped, printed = load_design("r1").linkage, load_design("r1", "printed").linkage
    assert shipped.crank - printed.crank == pytest.approx(result.shift[2], abs=1e-5)
    assert shipped.rocker - printed.rocker == pytest.approx(result.shift[8], abs=1e-5)


def test_other_readings_do_not_fit() -> None:
    """The TRT's seat angle fits no six-bar, gamma = 0 does not fit D1: no point of the rounding box does."""
    row, printed = table1()["d1"], load_design("d1", "printed")
    assert identify(printed, row, math.radians(30), math.radians(90)).found
    assert not identify(printed, row, math.radians(30), 0.0).found
    assert not identify(printed, row, math.radians(60), math.radians(90)).found


@pytest.mark.parametrize("group", GROUPS)
def test_recovered_moments_give_the_printed_powers(group: str) -> None:
    """Within three of the evidence's own errors (0.1 W for the TRT, 0.4 W for the rounded six-bars)."""
    moments = load_moments(group)
    for name, row in table1().items():
        power = quasi_static(load_design(name), moments).power_mean
        assert power == pytest.approx(row.power[group], abs=0.3 if name == "trt" else 1.2), name


@pytest.mark.parametrize("group", GROUPS)
def test_the_15_watts_of_section_3_are_predicted_without_being_used(group: str) -> None:
    rows = [row for row in load_evidence() if row.group == group]
    others = [row for row in rows if row.quantity != "crank_power"]
    (asked,) = (row for row in rows if row.quantity == "crank_power")
    mean, deviation = condition(others, choose_hyperparameters(load_evidence())).predict(functional(asked)[0])
    assert abs(mean - 15.0) < 3 * math.hypot(deviation, asked.error)
    assert deviation < 1.0


@pytest.mark.parametrize("group", GROUPS)
def test_the_shipped_csv_is_the_posterior_mean(group: str) -> None:
    rows = load_evidence()
    posterior = condition([row for row in rows if row.group == group], choose_hyperparameters(rows))
    shipped, fresh = load_moments(group), posterior.moments(group)
    assert np.abs(shipped.knee - fresh.knee).max() < 1e-3
    assert np.abs(shipped.hip - fresh.hip).max() < 1e-3


def test_power_is_the_linear_functional_it_is_said_to_be() -> None:
    """The weights of the reconstruction against the quasi-static solver, on curves of few harmonics."""
    from fes_mj.moments import JointMoments

    random = np.random.default_rng(1)
    coefficients = random.normal(size=2 * 49) * np.tile(np.r_[1, 1, 1, 1, np.zeros(21), 1, 1, 1, np.zeros(21)], 2)
    angle = np.radians(np.arange(0, 360, 0.1))
    knee, hip = (fourier(angle) @ half for half in np.split(coefficients, 2))
    for name in SIX_BARS:
        design = load_design(name)
        solved = quasi_static(design, JointMoments("random", angle, knee, hip)).power_mean
        weights = power_weights(kinematics.solve(design), design.linkage.cadence, PAPER_TRICYCLE)
        assert weights @ coefficients == pytest.approx(solved, abs=2e-3)


def test_knee_plateau_of_section_7() -> None:
    """Near 20 N m in extension at 73 deg, near -1 N m in flexion (P1P2)."""
    from fes_mj.torque_map import TorqueMap

    torque_map = TorqueMap(load_moments("p1p2"))
    assert torque_map.moment("knee", math.radians(73), 1.0) == pytest.approx(20, abs=4)
    assert torque_map.moment("knee", math.radians(73), -1.0) == pytest.approx(-1, abs=4)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('design = "d1"', 'design = "d9"', "design is 'd9'"),
        ('group = "p1p3"', 'group = "p9"', "group is 'p9'"),
        ('unit = "W"', 'unit = "kW"', "unit is 'kW'"),
        ("error = 0.4", "error = -0.4", "error is -0.4; it must be a number above 0"),
        ("leg_m = 0.542", "leg_m = 0.3", "leg_m is 0.3; it must be from 0.475 to 1.0 m"),
        ("leg_m = 0.542", "leg_m = 1e-320", "leg_m is 1e-320"),
        ("error = 0.4", "error = 0.0", "error is 0.0; it must be a number above 0"),
        ("value = 31.29", "value = nan", "value is nan; it must be a finite number"),
        ('source = "table1"', 'source = "rumour"', "source is 'rumour'"),
        ("value = 31.29", "vlaue = 31.29", "vlaue; allowed here: group, name"),
    ],
)
def test_bad_evidence_is_named(old: str, new: str, words: str, tmp_path: Path) -> None:
    text = (DATA / "evidence.toml").read_text()
    assert old in text
    path = tmp_path / "evidence.toml"
    path.write_text(text.replace(old, new, 1))
    with pytest.raises(InputError) as caught:
        load_evidence(path)
    assert words in str(caught.value)
    assert str(path) in str(caught.value)
