"""`fes_mj optimize`: the promised JSON, files that other commands take, one message for bad input."""

import json
import math
from pathlib import Path

import pytest

import fes_mj
from fes_mj.cli.app import run
from fes_mj.optimization.problem_file import DEFAULT

QUICK = ["--budget", "6000", "--searches", "1", "--seed", "2"]


def test_the_winner_is_what_the_other_commands_see(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    pytest.importorskip("jinja2")
    best, page = tmp_path / "best.toml", tmp_path / "best.html"
    command = ["optimize", "cdt", "--group", "p1p3", "--speeds-of", "d2", "--start", "d2", *QUICK, "-o", str(best)]
    assert run([*command, "--report", str(page), "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["feasible"]
    assert found["violations"] == []
    assert found["evaluations"] == 6000
    assert found["design_file"] == str(best)
    assert found["gain_W"] > 0
    assert found["gain_deviation_W"] > 0
    assert found["mean_knee_speed_deg_s"] <= 162.93
    assert run(["static", str(best), "--group", "p1p3", "--json"]) == 0
    static = json.loads(capsys.readouterr().out)
    assert static["power_mean_W"] == pytest.approx(found["power_mean_W"], rel=1e-12)
    assert static["cadence_rpm"] == pytest.approx(found["cadence_rpm"], rel=1e-12)
    assert found["agrees"]
    assert run(["simulate", str(best), "--group", "p1p3", "--timestep", str(found["timestep_s"]), "--json"]) == 0
    simulated = json.loads(capsys.readouterr().out)
    assert simulated["power_mean_W"] == pytest.approx(found["simulated_power_mean_W"], rel=1e-9)
    text = page.read_text(encoding="utf-8")
    assert f"{found['power_mean_W']:.3f}" in text
    assert "<svg" in text
    import mujoco

    model = mujoco.MjModel.from_xml_path(str(tmp_path / "best.xml"))
    assert model.neq == 2


def test_the_default_speed_limit_is_that_of_the_trt(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["optimize", "crt", *QUICK, "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["mean_knee_speed_deg_s"] <= 107.14
    assert found["mean_knee_speed_deg_s"] > 95
    assert run(["optimize", "crt", *QUICK, "--knee-speed-limit", "80", "--json"]) == 0
    slower = json.loads(capsys.readouterr().out)
    assert slower["mean_knee_speed_deg_s"] <= 80.0
    assert slower["power_mean_W"] < found["power_mean_W"]


def test_a_front_beside_the_design(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    pytest.importorskip("pymoo")
    out = tmp_path / "front.toml"
    assert run(["optimize", "cdt", "--method", "nsga-ii", "--budget", "4000", "-o", str(out), "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    lines = (tmp_path / "front-front.csv").read_text().splitlines()
    assert len(lines) == len(found["front"]) + 1
    design = fes_mj.load_design(out)
    for group in ("p1p2", "p1p3"):
        power = fes_mj.quasi_static(design, fes_mj.load_moments(group)).power_mean
        assert any(math.isclose(power, point["power_mean_W"][group], rel_tol=1e-4) for point in found["front"])
    averages = [sum(point["power_mean_W"].values()) for point in found["front"]]
    own = sum(fes_mj.quasi_static(design, fes_mj.load_moments(group)).power_mean for group in ("p1p2", "p1p3"))
    assert own == pytest.approx(max(averages), rel=1e-4)


def test_own_moments_have_no_error_bar(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    moments = tmp_path / "mine.csv"
    moments.write_text("crank_angle_deg,knee_Nm,hip_Nm\n0,5,1\n60,25,2\n180,5,-1\n270,-5,0\n")
    assert run(["optimize", "crt", "--moments", str(moments), *QUICK, "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["gain_W"] is None
    assert found["group"] == "mine"


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["cdt", "--start", "d1"], "the start d1 is not feasible: knee_speed is 164.6 deg/s (limit 107.1)"),
        (["crt", "--start", "d1"], "--start d1 is a cdt, not a crt"),
        (["crt", "--start", "r2", "--speeds-of", "r2"], "the start r2 is not feasible: grashof is"),
        (["cdt", "--knee-speed-limit", "-3"], "the knee speed limit is -3 deg/s; it must be above 0"),
        (["cdt", "--hip-speed-limit", "nan"], "the hip speed limit is nan deg/s"),
        (["cdt", "--seed", "-1"], "--seed is -1; it must not be negative"),
        (["cdt", "--budget", "5"], "--budget is 5; it must be at least 1000"),
        (["cdt", "--caution", "1", "--method", "nsga-ii"], "--caution needs the error bars of one group"),
        (["cdt", "--smooth"], "--smooth is an objective of its own"),
        (["cdt", "--group", "p1p2", "--moments", "x.csv"], "--group and --moments exclude each other"),
        (["cdt", "--out", "best.txt"], "best.txt: cannot write the design: the name must end in .toml"),
        (["cdt", "--report", "nowhere/best.html"], "the folder does not exist"),
        (["cdt", "--problem", "missing.toml"], "missing.toml: cannot read the problem"),
        (["cdt", "--jobs", "0"], "--jobs is 0; it must be at least 1"),
    ],
)
def test_bad_input_is_one_message(arguments: list[str], said: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["optimize", *arguments]) == 2
    captured = capsys.readouterr()
    assert said in captured.err.replace("\n", " ")
    assert "Traceback" not in captured.err
    assert captured.out == ""


def test_a_problem_that_nothing_solves(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "mine.toml"
    path.write_text(DEFAULT.read_text().replace("hip_deg = [85.0, 120.0]", "hip_deg = [5.0, 6.0]"))
    assert run(["optimize", "crt", "--problem", str(path), *QUICK]) == 2
    message = capsys.readouterr().err.replace("\n", " ")
    assert "no feasible crt found in 6000 evaluations; the closest violates: " in message
    assert "hip_max" in message


def test_a_missing_extra_is_named(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    import sys

    monkeypatch.setitem(sys.modules, "cma", None)
    assert run(["optimize", "crt", "--method", "cma-es", *QUICK]) == 3
    assert "pip install 'fes-mj[optimize]'" in capsys.readouterr().err.replace("\n", " ")
