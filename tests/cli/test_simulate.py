"""`fes_mj simulate`: the promised JSON, tables, files and exit codes."""

import json
import os
import sys
from pathlib import Path

import numpy as np
import pytest

from fes_mj.cli.app import run
from fes_mj.linkage.design_file import load_design
from fes_mj.simulation.time_step import steps_per_turn
from tests.cli.conftest import answer, names, result


def test_simulate_json_has_the_promised_keys(capsys: pytest.CaptureFixture[str]) -> None:
    code, out, err = result(capsys, "simulate", "r1", "--group", "p1p3", "--json")
    content = json.loads(out)
    assert (code, err) == (0, "")
    assert content["agrees"] is True
    assert content["relative_difference"] == pytest.approx(
        content["power_mean_W"] / content["static_power_mean_W"] - 1, abs=1e-12
    )
    assert 0 < content["loop_gap_max_m"] <= 1e-5
    assert 0 < content["cadence_ripple"] <= 1e-4
    assert {"name", "value", "limit", "ok"} <= set(content["checks"][0])
    assert all(check["ok"] for check in content["checks"])
    static = json.loads(result(capsys, "static", "r1", "--group", "p1p3", "--json")[1])
    for key in ("power_sd_total_W", "power_sd_by", "rider_power_mean_W", "rider_power_per_trt_interval"):
        assert content[key] == static[key]
    assert content["paper_power_mean_W"] == content["static_power_mean_W"]


def test_what_is_asked_is_short(capsys: pytest.CaptureFixture[str]) -> None:
    for command in (("simulate", "d2"), ("simulate", "r2", "--drive", "muscles")):
        lines = result(capsys, *command)[1].splitlines()
        assert len(lines) <= 12
        assert "checks hold" in lines[-1]


def test_tables_carry_units_and_the_verdict(capsys: pytest.CaptureFixture[str]) -> None:
    code, out, _ = result(capsys, "simulate", "trt", "-v", "--legs", "2", "--cadence", "55")
    assert code == 0
    for words in ("mean crank power", "knee angle, deg", "55.0 rpm", "Dynamic and static agree", "Energy over", "N"):
        assert words in out
    code, out, _ = result(capsys, "static", "r1", "-v")
    assert (code, "Joint reactions" in out) == (0, True)
    assert result(capsys, "simulate", "trt", "-q") == (0, "", "")


def test_a_run_that_does_not_agree_exits_with_1(capsys: pytest.CaptureFixture[str]) -> None:
    code, out, _ = result(capsys, "simulate", "d1", "--timestep", "0.004")
    assert code == 1
    assert "do not agree" in out
    assert "FAILED" in out


def test_out_writes_result_cycle_and_model(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    tmp_path /= "made"
    assert result(capsys, "simulate", "d2", "-q", "--out", str(tmp_path))[0] == 0
    assert names(tmp_path) == {"d2-p1p2.json", "d2-p1p2.csv", "d2-p1p2.xml"}
    power = json.loads((tmp_path / "d2-p1p2.json").read_text())["power_mean_W"]
    cycle = np.genfromtxt(tmp_path / "d2-p1p2.csv", delimiter=",", names=True)
    assert cycle["crank_power_W"].mean() == pytest.approx(power, rel=1e-6)
    assert cycle["quasi_static_power_W"].mean() == pytest.approx(power, rel=1e-3)


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write anywhere")
def test_a_folder_without_permission(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    tmp_path.chmod(0o500)
    assert "no permission" in result(capsys, "simulate", "d1", "--out", str(tmp_path))[2]


@pytest.mark.parametrize(("asked", "steps"), [([], None), (["--timestep", "0.0005"], 1245)])
def test_the_json_reports_the_step_it_was_simulated_with(
    asked: list[str], steps: int | None, capsys: pytest.CaptureFixture[str]
) -> None:
    """A whole number of a turn, chosen beforehand or nearest to what was asked for."""
    _, content = answer(capsys, "simulate", "d1", *asked)
    design = load_design("d1")
    steps = steps or steps_per_turn(design, design.linkage.cadence)
    assert content["timestep_s"] * steps == pytest.approx(60 / content["cadence_rpm"], rel=1e-12)


def test_results_replace_only_results(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """The folder is named, its files are not: what others put there stays, and nothing runs."""
    measured = tmp_path / "d1-m.csv"
    measured.write_text("crank_angle_deg,knee_Nm,hip_Nm\n0,1,2\n90,20,-3\n")
    (moments := tmp_path / "m.csv").symlink_to(measured)
    assert run(["simulate", "d1", "--moments", str(moments), "--out", str(tmp_path)]) == 2
    assert "d1-m.csv: cannot write the results: it would replace" in capsys.readouterr().err
    measured.rename(moments)
    for suffix in ("json", "csv", "xml"):
        (stranger := tmp_path / f"d1-m.{suffix}").write_text("{}")
        assert run(["simulate", "d1", "--moments", str(moments), "--out", str(tmp_path)]) == 2
        assert (
            f"d1-m.{suffix}: cannot write the results: a file has this name that fes_mj did not"
            in capsys.readouterr().err
        )
        assert {*tmp_path.iterdir()} == {moments, stranger}
        stranger.unlink()
    for _ in range(2):
        assert run(["simulate", "d1", "--moments", str(moments), "--out", str(tmp_path), "-q"]) in (0, 1)
    assert names(tmp_path) == {"m.csv", "d1-m.json", "d1-m.csv", "d1-m.xml"}


def test_a_video_does_not_replace_an_input(tmp_path: Path) -> None:
    (moments := tmp_path / "m.mp4").write_text("crank_angle_deg,knee_Nm,hip_Nm\n0,1,2\n90,20,-3\n")
    assert run(["simulate", "d1", "--moments", str(moments), "--render", str(moments)]) == 2
    assert moments.read_text().startswith("crank")


@pytest.mark.skipif(sys.platform != "linux", reason="other systems always have a screen")
@pytest.mark.parametrize("display", ["", ":99"])
def test_view_without_a_screen_is_one_message(
    display: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Also where a screen is named that does not answer."""
    monkeypatch.setenv("DISPLAY", display)
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    assert run(["simulate", "d1", "-q", "--view"]) == 3
    assert capsys.readouterr().err.startswith("fes_mj: the viewer needs a screen and there is none; make a video")
