"""`fes_mj ride`: the promised JSON, tables, files and exit codes."""

import json
from functools import partial
from pathlib import Path

import numpy as np
import pytest

import fes_mj
from fes_mj.common.console import output
from fes_mj.crosscheck import ride_case
from tests.cli.conftest import answer, names, result

KEYS = {
    "design", "group", "transmission", "slope_percent", "duration_s", "rides", "speed_kmh", "cadence_rpm",
    "speed_ripple", "distance_m", "freewheel_share", "stopped_at_s", "power_muscle_W", "power_road_W", "agrees",
    "checks", "verdict", "stopped_because", "numerical_uncertainty",
}  # fmt: skip


def test_json_of_a_ride(capsys: pytest.CaptureFixture[str]) -> None:
    code, content = answer(capsys, "ride", "r1", "--group", "p1p3", "--duration", "3", "--transmission", "fixed")
    assert code == 0
    assert set(content) >= KEYS
    assert (content["rides"], content["stopped_at_s"], content["agrees"]) == (True, None, True)
    assert (content["drive"], content["group"], content["freewheel_share"]) == ("muscles", "p1p3", 0)
    # wheel of 0.66 m, crank turns per wheel turn: the transmission ties the two means together
    wheel = content["cadence_rpm"] / 60 / 2.03 * np.pi * 0.66
    assert content["speed_kmh"] / 3.6 == pytest.approx(wheel, rel=1e-3)


def test_a_tricycle_that_stops_is_a_result(capsys: pytest.CaptureFixture[str]) -> None:
    code, out, _ = result(capsys, "ride", "trt", "--slope", "20", "--duration", "4")
    assert code == 0
    assert "It stops after" in out
    assert "The two solvers agree" in out


def test_a_ride_on_which_the_solvers_do_not_agree_has_no_speed(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(ride_case, "relative", lambda one, other: 1.0)  # of ride_settled alone
    monkeypatch.setattr(output, "_force_terminal", True)
    code, content = answer(capsys, "ride", "trt", "--duration", "2")
    assert code == 1
    assert content["verdict"] == "no-agreement"
    empty = ("rides", "speed_kmh", "cadence_rpm", "distance_m", "stopped_at_s", "stopped_because", "reduced")
    assert {content[name] for name in empty} == {None}
    code, out, _ = result(capsys, "ride", "trt", "--duration", "2")
    assert code == 1
    assert "km/h" not in out
    assert "\x1b[32m" not in out
    assert "not agree" in out


def test_out_writes_result_ride_and_model(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    assert result(capsys, "ride", "trt", "--duration", "2", "-q", "--out", str(tmp_path)) == (0, "", "")
    assert names(tmp_path) == {f"trt-p1p2-muscles-ride.{suffix}" for suffix in ("json", "csv", "xml")}
    content = json.loads((tmp_path / "trt-p1p2-muscles-ride.json").read_text())
    table = np.genfromtxt(tmp_path / "trt-p1p2-muscles-ride.csv", delimiter=",", names=True)
    assert table["distance_m"].max() == pytest.approx(content["distance_m"], rel=1e-6)
    assert table["time_s"][-1] == pytest.approx(2.0)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--slope", "60"], '"60.0" for --slope. Must be <= 30.'),
        (["--launch", "0"], '"0.0" for --launch. Must be >= 0.1.'),
        (["--launch", "-3"], '"-3.0" for --launch'),
        (["--launch", "5", "--from-rest", "10"], "Mutually exclusive arguments: {--launch, --from-rest}"),
        (["--tricycle-mass", "-20"], '"-20.0" for --tricycle-mass. Must be >= 1.'),
        (["--rolling-mass", "-1"], '"-1.0" for --rolling-mass'),
        (["--duration", "0"], '"0.0" for --duration. Must be >= 1.'),
        (["--crr", "2"], '"2.0" for --crr'),
        (["--drag-area", "inf"], '"inf" for --drag-area'),
        (["--duty", "2"], '"2.0" for --duty'),
        (["--timing", "by-angle"], "a ride knows the windows of best and measured alone"),
        (["--moments", "own.csv"], "--moments say nothing of muscles"),
        (["--out", "nowhere/out"], "nowhere: cannot write the results: the folder does not exist"),
    ],
)
def test_bad_input(arguments: list[str], words: str, capsys: pytest.CaptureFixture[str]) -> None:
    code, out, err = result(capsys, "ride", "d1", *arguments)
    assert (code, out) == (2, "")
    assert words in err
    assert err.count("\n") == 1


def test_a_ride_by_moments_says_first_that_they_do_not_fall_with_speed(capsys: pytest.CaptureFixture[str]) -> None:
    code, out, _ = result(capsys, "ride", "trt", "--drive", "moments", "--duration", "1")
    assert code == 0
    assert out.startswith("Joint moments do not fall with speed")


@pytest.mark.long
def test_starts(capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("numba")
    pytest.importorskip("matplotlib")
    monkeypatch.setattr(fes_mj, "starts", partial(fes_mj.starts, angles=8))
    code, content = answer(capsys, "ride", "r1", "--starts", "--duration", "5", "--out", str(tmp_path))
    assert code == 0
    assert 0 < content["start_share"] < 1
    assert 0 < content["launch_speed_kmh"] < 5.71
    assert 0 < content["slope_limit_percent"] < 30
    assert len(content["start_angles_deg"]) == round(16 * content["start_share"])
    assert "fes_mj" in (tmp_path / "r1-p1p2-muscles-ride.svg").read_text()[:40]
