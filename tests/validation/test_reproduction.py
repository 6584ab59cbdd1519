"""What `fes_mj reproduce` says of the paper: its methods on cases with known answers, and the pages as committed."""

import json
import math
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import fes_mj
from fes_mj import kinematics
from fes_mj.cli.app import run
from fes_mj.errors import InputError
from fes_mj.fourier import fourier
from fes_mj.geometry import transmission_angles
from fes_mj.moments import GROUPS, JointMoments
from fes_mj.paper.evidence import functional, load_evidence
from fes_mj.paper.gains import at_knee_speed, energy_swing
from fes_mj.paper.identification import range_misfit
from fes_mj.paper.metrics import extent, inactive_share, jump_weights, smoothing_weights
from fes_mj.paper.printed import DATA, table1
from fes_mj.paper.reconstruction import Posterior, choose_hyperparameters, condition, left_out_misses, reconstruct
from fes_mj.paper.recovery import evidence_table, left_out_table, predictive_table
from fes_mj.paper.runs import joint_speed
from fes_mj.paper.tables import explained_by
from fes_mj.reference_tricycle import PAPER_TRICYCLE
from fes_mj.statics import quasi_static
from fes_mj.table import Table
from fes_mj.torque_map import TorqueMap

RESULTS = Path(__file__).parents[2] / "results"
RECORD = json.loads((RESULTS / "reproduction.json").read_text(encoding="utf-8"))


@pytest.fixture(scope="module")
def posteriors() -> dict[str, Posterior]:
    return reconstruct(load_evidence()).posteriors


# Evidence and recovery


def test_the_shipped_covariance_is_the_posteriors(posteriors: dict[str, Posterior]) -> None:
    for group, posterior in posteriors.items():
        shipped = fes_mj.load_moments(group).covariance
        assert shipped is not None
        assert np.abs(shipped - posterior.covariance).max() < 1e-2  # (N m)^2, by the search for the hyperparameters
        design = fes_mj.load_design("d1")
        assert quasi_static(design, fes_mj.load_moments(group)).power_sd == pytest.approx(
            posterior.predict(quasi_static(design, fes_mj.load_moments(group)).power_weights)[1], rel=1e-3
        )


@pytest.mark.parametrize(
    ("old", "new", "name"),
    [
        ("value = 31.29", "value = 90.0", "p1p2 power in D1"),
        ("value = 16.2\n", "value = 61.0\n", "p1p3 power in TRT"),
        ("value = 20.0", "value = 400.0", "p1p2 knee extending at 73 deg"),
    ],
)
def test_evidence_that_contradicts_itself_is_named(old: str, new: str, name: str, tmp_path: Path) -> None:
    path, text = tmp_path / "evidence.toml", (DATA / "evidence.toml").read_text()
    assert old in text
    path.write_text(text.replace(old, new, 1))
    with pytest.raises(InputError, match=rf"evidence '{name}' contradicts the rest: it lies .* standard dev"):
        reconstruct(load_evidence(path))


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("value = 31.29", 'value = "much"', "value is 'much'; it must be a finite number"),
        ("error = 0.4", "error = true", "error is True; it must be a number above 0"),
        ("leg_m = 0.515", "leg_m = 0.0", "leg_m is 0.0; it must be from 0.475 to 1.0 m"),
        ("leg_m = 0.515\n", "", "leg_m is missing"),
        ("angle_deg = 73.0\n", "", "angle_deg is missing"),
        ('name = "p1p2 power in R1"', 'name = "p1p2 power in TRT"', "'p1p2 power in TRT' is given twice"),
        ('group = "p1p3"', 'group = "p1p2"', "there is no evidence for group 'p1p3'; both groups need some"),
        ("value = 31.29", f"value = 1{400 * '0'}", "it must be a finite number, at most 1e+06"),
        ('name = "p1p2 power in R1"', "name = [1]", "name is '[1]'; it must be a text"),
        ("[[evidence]]", "[[rumour]]", "there is no evidence for group 'p1p2'"),
    ],
)
def test_rows_that_are_no_evidence_are_named(old: str, new: str, words: str, tmp_path: Path) -> None:
    path, text = tmp_path / "evidence.toml", (DATA / "evidence.toml").read_text()
    assert old in text
    path.write_text(text.replace(old, new))
    with pytest.raises(InputError) as caught:
        load_evidence(path)
    assert words in str(caught.value)


def test_the_quick_way_to_leave_rows_out_is_the_long_one() -> None:
    """Closed form against conditioning on the other rows, and never below the residual."""
    evidence = load_evidence()
    chosen = choose_hyperparameters(evidence)
    for group in GROUPS:
        rows = [row for row in evidence if row.group == group]
        posterior = condition(rows, chosen)
        for row, miss in zip(rows, left_out_misses(rows, chosen), strict=True):
            weights, value, error = functional(row)
            mean, deviation = condition([other for other in rows if other is not row], chosen).predict(weights)
            assert miss == pytest.approx((value - mean) / math.hypot(deviation, error), rel=1e-6, abs=1e-9)
            assert abs(miss) >= abs(value - posterior.predict(weights)[0]) / error - 1e-9


def test_leaving_the_trt_out_leaves_its_twin_out_too(posteriors: dict[str, Posterior]) -> None:
    """Without both, the TRT is predicted three times less surely than with the 15 W item."""
    evidence = load_evidence()
    rows = left_out_table(evidence, reconstruct(evidence)).records()
    for group in GROUPS:
        alone, both = (row for row in rows if row["group"] == group and row["design"] == "TRT")
        assert both["left out"] == "itself and the 15 W item"
        assert both["sd, W"] > 2 * alone["sd, W"]


def test_a_row_left_out_is_predicted_less_surely() -> None:
    evidence = load_evidence()
    for row in evidence_table(evidence, reconstruct(evidence)).records():
        fitted, left_out = (float(row[key].split(" +- ")[1]) for key in ("recovered", "left out"))
        assert left_out >= fitted, row["evidence"]


def test_what_was_used_comes_back(posteriors: dict[str, Posterior]) -> None:
    evidence = load_evidence()
    rows = {row["statement"]: row for row in predictive_table(reconstruct(evidence)).records()}
    used = rows["7.2: knee extending at 73 deg, p1p2"]["recovered"]
    assert abs(float(used.split(" +- ")[0]) - 20) < 2


def test_functionals_of_shares_are_shares() -> None:
    """On curves with only a knee moment the hip's share is 0 and the knee's 1, whatever the curve."""
    coefficients = np.zeros(98)
    coefficients[:5] = 3.0, 1.0, -2.0, 0.5, 4.0
    for row in (row for row in load_evidence() if row.quantity == "work_share" and row.direction == "both"):
        knee, hip = (functional(replace(row, joint=joint, value=0.0))[0] @ coefficients for joint in ("knee", "hip"))
        assert hip == 0
        whole = next(other for other in load_evidence() if other.group == row.group and other.quantity == "crank_power")
        assert knee == pytest.approx(functional(whole)[0] @ coefficients)


def test_a_reading_that_cannot_fit_misses_by_what_is_left() -> None:
    """A seat angle off by 30 deg shifts both hip limits by 30 deg; the rounding takes back less than 4."""
    miss = range_misfit(fes_mj.load_design("r1", "printed"), table1()["r1"], math.radians(60), math.radians(90))
    assert 26 < miss < 30


# Metrics


def test_extent_and_transmission_angle_of_the_trt() -> None:
    """By the law of cosines at the two ends, and the crank circle with the knee above it."""
    motion = kinematics.solve(PAPER_TRICYCLE.design)
    frame, crank = abs(PAPER_TRICYCLE.design.linkage.crank_centre), PAPER_TRICYCLE.design.linkage.crank
    thigh, shank = PAPER_TRICYCLE.design.rider.thigh, float(PAPER_TRICYCLE.design.knee_to_pedal)

    def at_knee(span: float) -> float:
        angle = math.degrees(math.acos((thigh**2 + shank**2 - span**2) / (2 * thigh * shank)))
        return min(angle, 180 - angle)

    assert transmission_angles(motion)["knee"] == pytest.approx(
        min(at_knee(frame - crank), at_knee(frame + crank)), abs=0.01
    )
    assert extent(motion)[0] == pytest.approx(-PAPER_TRICYCLE.design.linkage.crank_centre.real + crank, abs=1e-5)


def test_smoothing_against_the_solver() -> None:
    """The functional against powers of moments smoothed by hand along the motion."""
    random, few = np.random.default_rng(5), np.tile(np.r_[1, 1, 1, np.zeros(22), 1, 1, np.zeros(22)], 2)
    coefficients, angle = random.normal(size=98) * few, np.radians(np.arange(0, 360, 0.1))
    moments = JointMoments("random", angle, *(fourier(angle) @ half for half in np.split(coefficients, 2)))
    result, width = quasi_static(fes_mj.load_design("r1"), moments), math.radians(5)
    smoothed, torque_map = np.zeros(result.crank_angle.shape), TorqueMap(moments)
    for joint, at in result.joint_angle.items():
        rate = result.motion.joint_rate[joint]
        own, other = (torque_map.moment(joint, at, sign * rate) for sign in (1, -1))
        inside = np.clip(np.minimum(at - at.min(), at.max() - at) / width, 0, 1)
        smoothed += rate * ((own + other) / 2 + inside * (own - other) / 2)
    expected = result.power_mean - result.cadence * smoothed.mean()
    assert smoothing_weights(result, width) @ coefficients == pytest.approx(expected, abs=2e-4)
    low = result.joint_angle.knee.min()
    jump = torque_map.moment("knee", low, 1.0) - torque_map.moment("knee", low, -1.0)
    assert jump_weights(result)[0] @ coefficients == pytest.approx(float(jump), abs=1e-3)


def test_inactive_share_and_energy_swing_of_a_sine() -> None:
    angle = np.linspace(0, 2 * np.pi, 3600, endpoint=False)
    assert inactive_share(np.sin(angle)) == pytest.approx(0.5, abs=1e-3)
    assert inactive_share(2 + np.sin(angle)) == 0
    # the integral of A sin(wt) swings by 2 A / w
    assert energy_swing(10 + 4 * np.sin(angle), 5.0) == pytest.approx(2 * 4 / 5.0, rel=1e-3)


def test_equal_knee_speed_scales_power() -> None:
    result = quasi_static(fes_mj.load_design("d1"), fes_mj.load_moments("p1p2"))
    slowed = at_knee_speed(result, joint_speed(result, "knee")[0] / 2)
    assert slowed.power_mean == pytest.approx(result.power_mean / 2)
    assert joint_speed(slowed, "knee")[0] == pytest.approx(joint_speed(result, "knee")[0] / 2)


# Tables and files


def test_what_explains_a_difference() -> None:
    cases = {0.004: "rounding", -0.3: "1 sd", 0.7: "2 sd", -0.9: "none: beyond 2 sd"}
    assert {difference: explained_by(difference, 0.4) for difference in cases} == cases


def test_markdown() -> None:
    table = Table("Title", {"design": "", "power, W": ".2f"}, [("D1", 31.114), ("R2", None)], "Note.")
    lines = ["| design | power, W |", "| ------ | -------: |", "| D1     |    31.11 |", "| R2     |        - |"]
    assert table.markdown() == "\n".join(["## Title", "", *lines, "", "Note.", ""])
    assert table.records()[0] == {"design": "D1", "power, W": 31.114}


def test_committed_powers_are_todays(posteriors: dict[str, Posterior]) -> None:
    """results/reproduction.json against statics now: a change of the model must not leave the pages behind."""
    rows = RECORD["powers"]["Table 1: mean crank power"]
    assert len(rows) == 10
    for row in rows:
        result = quasi_static(fes_mj.load_design(row["design"].lower()), fes_mj.load_moments(row["group"]))
        assert result.power_mean == pytest.approx(row["identified: static, W"], rel=1e-9)
        assert result.power_sd == pytest.approx(row["sd, W"], rel=1e-9)
        assert row["dynamic, W"] == pytest.approx(row["identified: static, W"], rel=5e-4)
        assert row["paper, W"] == table1()[row["design"].lower()].power[row["group"]]


def test_committed_inputs_are_todays() -> None:
    from fes_mj.paper.reproduce import inputs
    from fes_mj.provenance import provenance

    now = provenance(inputs())["inputs"]
    assert len(now) == len(inputs())
    assert RECORD["provenance"]["inputs"].keys() == now.keys()
    changed = [name for name, value in now.items() if RECORD["provenance"]["inputs"][name] != value]
    assert not changed, f"run `fes_mj reproduce` again: {changed} changed"


def test_committed_pages_and_figures_are_small_and_complete() -> None:
    from fes_mj.paper.figures import FIGURES

    assert {path.name for path in (RESULTS / "figures").iterdir()} == {f"{name}.png" for name in FIGURES}
    assert all(path.stat().st_size < 300_000 for path in (RESULTS / "figures").iterdir())


def test_a_folder_that_cannot_be_made(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    assert run(["reproduce", "--out", str(tmp_path / "no" / "such")]) == 2
    assert "cannot write the results: the folder does not exist" in capsys.readouterr().err
    (tmp_path / "file").write_text("")
    assert run(["reproduce", "--out", str(tmp_path / "file")]) == 2
    assert "is not a folder" in capsys.readouterr().err


def test_without_matplotlib_the_extra_is_named(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    assert run(["reproduce", "--out", str(tmp_path)]) == 3
    assert "pip install 'fes-mj[video]'" in capsys.readouterr().err
    assert not list(tmp_path.iterdir())


@pytest.mark.long
def test_everything_is_written_again_with_the_same_numbers(tmp_path: Path) -> None:
    assert run(["reproduce", "-q", "--out", str(tmp_path)]) == 0
    written = {str(path.relative_to(tmp_path)) for path in tmp_path.rglob("*") if path.is_file()}
    committed = {str(path.relative_to(RESULTS)) for path in RESULTS.rglob("*") if path.is_file()}
    assert written <= committed
    record = json.loads((tmp_path / "reproduction.json").read_text(encoding="utf-8"))
    for page in ("powers", "gains", "metrics"):
        assert_close(record[page], RECORD[page], page)


def assert_close(new: Any, old: Any, where: str) -> None:
    """The same structure, texts without numbers the same, numbers within 1 % (optimisers differ between machines)."""
    if isinstance(old, dict):
        assert new.keys() == old.keys(), where
        for key in old:
            assert_close(new[key], old[key], f"{where}: {key}")
    elif isinstance(old, list):
        assert len(new) == len(old), where
        for number, (one, other) in enumerate(zip(new, old, strict=True)):
            assert_close(one, other, f"{where} {number}")
    elif isinstance(old, float):
        assert new == pytest.approx(old, rel=0.01, abs=0.01), where
