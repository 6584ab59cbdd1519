"""Options that several commands share."""

import json
from pathlib import Path

import pytest

from tests.cli.conftest import result
from tests.linkage.test_design_file import written


def test_what_muscles_have_made_superfluous_names_them(capsys: pytest.CaptureFixture[str]) -> None:
    for command in ("static", "simulate", "ride", "sweep", "stimulation"):
        for option in (["--torque-velocity", "hill"], ["--torque-velocity=hill"], ["--lag", "0.1"]):
            code, out, err = result(capsys, command, "d1", *option)
            assert (code, out) == (2, "")
            assert err.startswith(f"fes_mj: {option[0].partition('=')[0]} is gone")
            assert "--drive muscles" in err
            assert err.count("\n") == 1


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
