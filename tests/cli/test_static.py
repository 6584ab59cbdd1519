"""`fes_mj static`: the promised JSON and notes."""

import json
from pathlib import Path

import numpy as np
import pytest

import fes_mj
from fes_mj.common.units import RPM
from fes_mj.common.writing import json_text
from fes_mj.linkage.design_file import load_design
from fes_mj.moments.files import load_moments
from fes_mj.muscles.riders import load_riders
from fes_mj.statics.turn import quasi_static, ratio_sd
from tests.cli.conftest import answer, result
from tests.linkage.test_design_file import written

ROCKER = ("rocker_pivot", "rocker_joint")


def test_static_json_has_the_promised_keys(capsys: pytest.CaptureFixture[str]) -> None:
    code, out, err = result(capsys, "static", "d1", "--json", "--curves")
    content = json.loads(out)
    assert (code, err) == (0, "")
    assert (content["design"], content["group"]) == ("d1", "p1p2")
    assert content["cadence_rpm"] == pytest.approx(96.4, abs=0.05)
    assert content["work_per_turn_J"] == pytest.approx(content["power_mean_W"] * 60 / content["cadence_rpm"])
    assert content["crank_angle_deg"] == list(range(360))
    moment = np.array(content["crank_moment_Nm"])
    assert moment.mean() * 2 * np.pi == pytest.approx(content["work_per_turn_J"], rel=1e-3)
    from_top = np.array(content["crank_angle_from_tdc_deg"])
    turned = np.arange(360) - content["top_dead_centre_deg"]
    assert from_top == pytest.approx(turned % 360)
    assert from_top[int(np.argmin(content["knee_deg"]))] % 359 < 1  # the leg is bent most at top dead centre
    assert content["crank_angle_zero"] == "the crank points backwards (+x)"
    assert set(content) >= {"knee_Nm", "hip_Nm"}
    for joint in ("knee", "hip"):
        low, high = content[f"{joint}_range_deg"]
        assert low <= min(content[f"{joint}_deg"]) <= max(content[f"{joint}_deg"]) <= high


def test_curves_are_printed_without_json(capsys: pytest.CaptureFixture[str]) -> None:
    code, out, _ = result(capsys, "static", "d1", "--curves")
    assert code == 0
    assert "crank angle 0: the crank points backwards (+x); tdc: top dead centre" in out
    content = json.loads(result(capsys, "static", "d1", "--curves", "--json")[1])
    row = next(line.split() for line in out.splitlines() if line.split()[:1] == ["120"])
    columns = ("crank_angle_from_tdc_deg", "crank_moment_Nm", "knee_deg", "hip_deg", "knee_Nm", "hip_Nm")
    assert [float(cell) for cell in row[1:]] == pytest.approx([content[name][120] for name in columns], abs=0.006)


def test_both_numbers_with_their_intervals(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    content = answer(capsys, "static", "r1")[1]
    whole = fes_mj.answer(
        load_design("r1"), [quasi_static(load_design("r1"), load_moments("p1p2"))], load_riders("p1p2")
    )
    assert content.items() >= json.loads(json_text(whole.summary())).items()
    assert content["paper_power_mean_W"] == content["power_mean_W"]
    text = result(capsys, "static", "r1")[1]
    (low, high), mean = content["rider_power_interval_W"], content["rider_power_mean_W"]
    assert f"{mean:.1f}" in text
    assert f"{low:.1f} to {high:.1f}" in text
    assert "+-" not in text
    by_muscles = answer(capsys, "static", "r1", "--drive", "muscles")[1]
    assert {key: by_muscles[key] for key in whole.summary()} == {key: content[key] for key in whole.summary()}
    slow = answer(capsys, "static", "r1", "--cadence", "40")[1]  # then the tricycle is as slow
    assert slow["rider_power_per_trt"] > content["rider_power_per_trt"]


def test_own_moments_have_no_muscles(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    own = tmp_path / "own.csv"
    own.write_text("crank_angle_deg,knee_Nm,hip_Nm\n0,10,0\n90,20,0\n180,0,5\n270,-10,0\n")
    content = answer(capsys, "static", "d1", "--moments", str(own))[1]
    missing = ("power_sd_W", "power_sd_total_W", "power_sd_by", "paper_power_interval_W", "rider_power_mean_W")
    assert [content[key] for key in missing] == [None] * len(missing)
    assert "for a rider: no muscles belong to these moments" in result(capsys, "static", "d1", "--moments", str(own))[1]
    beside = result(capsys, "static", "trt", "d1", "--moments", str(own))[1]
    assert "for a rider, trt, d1: no muscles belong to these moments" in beside


def test_own_moments_and_own_muscles_are_two_runs(capsys: pytest.CaptureFixture[str]) -> None:
    said = result(capsys, "static", "d1", "--moments", "own.toml", "--muscles", "rider.npz")[2]
    assert "exclusive arguments: {--moments, --muscles}" in said


def test_what_is_asked_is_short(capsys: pytest.CaptureFixture[str]) -> None:
    for command in (("static", "d2"), ("static", "r2", "--drive", "muscles"), ("static", "trt", "r1", "d1")):
        assert len(result(capsys, *command)[1].splitlines()) <= 12


def test_the_error_budget(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    content = json.loads(result(capsys, "static", "d1", "--json")[1])
    by = content["power_sd_by"]
    assert [*by] == ["moments", "dimensions", "rider", "extrapolation", "leg masses"]
    assert by["moments"] == pytest.approx(content["power_sd_W"])  # D1 stays inside the range of the moments
    assert by["leg masses"] == 0
    assert max(by.values()) < content["power_sd_total_W"]
    assert content["draws_that_do_not_turn"] < 0.02 * content["draws"]
    said = f"{content['power_mean_drawn_W']:.1f} +- {content['power_sd_total_W']:.1f} W with every unknown drawn"
    assert f"error budget of the mean power: {said}" in result(capsys, "static", "d1", "-v")[1].replace("\n", " ")
    content = json.loads(result(capsys, "static", str(written(tmp_path)), "--json")[1])
    assert content["power_sd_total_W"] > content["power_sd_W"]


def test_joint_angles_without_data_are_mentioned(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    path = written(tmp_path, seat_angle="50.0")
    code, out, _ = result(capsys, "static", str(path))
    assert code == 0
    assert "note: the hip moves 10.0 deg beyond the range of the moments (85.3 to 119.8 deg)" in out


def test_static_says_how_even_how_large_and_how_loaded(capsys: pytest.CaptureFixture[str]) -> None:
    content = json.loads(result(capsys, "static", "r2", "--json")[1])
    curve = np.array(json.loads(result(capsys, "static", "r2", "--json", "--curves")[1])["crank_moment_Nm"])
    assert content["inactive_zone_share"] == pytest.approx(np.mean(curve < 0), abs=1 / 360)
    assert content["power_peak_to_mean"] == pytest.approx(curve.max() / curve.mean(), rel=1e-2)
    for key in ("power_peak_to_peak_W", "energy_fluctuation", "transmission_angle_min_deg", "length_m", "height_m"):
        assert content[key] > 0
    forces, massive = content["peak_force_N"], content["peak_force_with_masses_N"]
    assert forces.keys() == massive.keys() == {*("hip", "knee", "pedal", "crank_centre", "crank_pin"), *ROCKER}
    assert content["knee_load_bodyweight"].keys() == {"shear", "compression"}
    assert "comes on top" in content["knee_load_note"]
    text = result(capsys, "static", "r2", "-v")[1]
    for words in ("inactive zone, % of the turn", "smallest transmission angle, deg", "crank pin", "knee shear, body"):
        assert words in text


def test_a_rider_by_name(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    path = tmp_path / "injured.toml"
    text = (Path(fes_mj.__file__).parent / "data/designs/identified/r1.toml").read_text()
    path.write_text('rider = "ansur-man-p95-sci"\n' + text.partition("[rider]")[0])
    content = json.loads(result(capsys, "static", str(path), "--json")[1])
    assert content["power_mean_W"] > 0
    assert content["peak_force_leg_mass_sd_N"].keys() == content["peak_force_N"].keys()


def test_several_designs_are_compared(capsys: pytest.CaptureFixture[str]) -> None:
    code, content = answer(capsys, "static", "trt", "d1", "r1", "--curves")
    alone = answer(capsys, "static", "d1", "--curves")[1]
    assert code == 0
    assert content["designs"][1] == {key: value for key, value in alone.items() if key != "provenance"}
    assert content["provenance"]["inputs"].keys() == {f"designs/identified/{name}.toml" for name in ("trt", "d1", "r1")}
    assert [ratio["design"] for ratio in content["ratios"]] == ["trt", "d1", "r1"]
    trt, d1 = (quasi_static(load_design(name), load_moments("p1p2")) for name in ("trt", "d1"))
    first, second, _ = content["ratios"]
    assert (first["power_ratio"], first["power_ratio_sd"]) == (1.0, 0.0)
    assert second["power_ratio"] == pytest.approx(d1.power_mean / trt.power_mean)
    assert second["power_ratio_sd"] == pytest.approx(ratio_sd(d1, trt))
    assert second["paper_power_ratio"] == second["power_ratio"]
    text = result(capsys, "static", "trt", "d1")[1]
    for kind in ("paper", "rider"):
        low, high = second[f"{kind}_power_ratio_interval"]
        assert f"{second[f'{kind}_power_ratio']:.2f} ({low:.2f} to {high:.2f})" in text


def test_two_legs_keep_the_mean_of_one_and_add_their_powers(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    one, two = (answer(capsys, "static", "r2", "--cadence", "50", "--legs", legs)[1] for legs in "12")
    assert two["power_mean_W"] == pytest.approx(one["power_mean_W"])
    power = quasi_static(load_design("r2"), load_moments("p1p2"), 50 * RPM).power
    both = power + np.roll(power, len(power) // 2)
    assert two["power_peak_to_peak_W"] == pytest.approx(np.ptp(both))
    assert two["inactive_zone_share"] == pytest.approx(np.mean(both < 0))
    own = tmp_path / "own.csv"
    own.write_text("crank_angle_deg,knee_Nm,hip_Nm\n0,10,0\n90,20,0\n180,0,5\n270,-10,0\n")
    weak = tmp_path / "weak.csv"
    weak.write_text("crank_angle_deg,knee_Nm,hip_Nm\n0,5,0\n90,10,0\n180,0,2.5\n270,-5,0\n")
    pair = answer(capsys, "static", "r2", "d1", "--legs", "2", "--moments", str(own), "--moments", str(weak))[1]
    strong = answer(capsys, "static", "r2", "--moments", str(own))[1]
    assert pair["designs"][0]["power_mean_W"] == pytest.approx(0.75 * strong["power_mean_W"], rel=1e-6)
    assert pair["ratios"][1]["power_ratio_sd"] is None
