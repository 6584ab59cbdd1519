"""Options that several commands share."""

import json
from pathlib import Path

import pytest

from tests.cli.conftest import result
from tests.linkage.test_design_file import written


def test_torque_velocity_is_off_until_asked_for(capsys: pytest.CaptureFixture[str]) -> None:
    plain, hill = (
        json.loads(result(capsys, "static", "d1", "--json", *extra)[1]) for extra in ([], ["--torque-velocity", "hill"])
    )
    assert (plain["torque_velocity"], hill["torque_velocity"]) == (None, "hill")
    assert hill["power_mean_W"] < 0.85 * plain["power_mean_W"]
    assert "relation of Hill" in result(capsys, "static", "d1", "--torque-velocity", "hill")[1]
    code, out, _ = result(capsys, "simulate", "d1", "--torque-velocity", "hill", "--json")
    assert (code, json.loads(out)["agrees"]) == (0, True)


def test_own_design_and_own_moments_work_where_catalogue_names_do(
    capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    design, moments = written(tmp_path), tmp_path / "own.csv"
    moments.write_text("crank_angle_deg,knee_Nm,hip_Nm\n0,10,0\n90,20,0\n180,0,5\n270,-10,0\n")
    code, out, _ = result(capsys, "simulate", str(design), "--moments", str(moments), "--json")
    content = json.loads(out)
    assert (code, content["design"], content["group"]) == (0, "mine", "own")
    target = tmp_path / "mine.xml"
    assert result(capsys, "export", str(design), "-o", str(target))[0] == 0
    assert "<mujoco" in target.read_text()
