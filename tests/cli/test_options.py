"""Options that several commands share."""

import json
import sys
from pathlib import Path

import pytest

from fes_mj.linkage.design_file import design_toml, load_design
from fes_mj.muscles.riders import load_riders
from fes_mj.optimization.limits import DEFAULT
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


MUSCLES = ["--drive", "muscles", "--muscles", "riders.npz"]
OWN = ["own.toml", "--moments", "trial.toml"]
READING = [
    (["simulate", *OWN], ["--render=out.mp4"]),
    (["simulate", "own.toml", *MUSCLES], ["--render=out.mp4"]),
    (["ride", *OWN, "--drive", "moments"], ["--render=out.mp4"]),
    (["ride", "own.toml", *MUSCLES], ["--render=out.mp4"]),
    (["validate", *OWN], ["--report=out.html", "--junit=out.xml"]),
    (["validate", "own.toml", *MUSCLES], ["--report=out.html", "--junit=out.xml"]),
    (["fit", *OWN], ["-o=out.toml"]),
    (["fit", *OWN, "--population"], ["--plot=out.png"]),
    (
        ["optimize", "crt", "--start", "own.toml", "--problem", "problem.toml", "--moments", "trial.toml"],
        ["-o=out.toml", "--report=out.html"],
    ),
    (["optimize", "crt", "--like", "own.toml", *MUSCLES], ["-o=out.toml"]),
    (["optimize", "crt", "--speeds-of", "own.toml"], ["-o=out.toml"]),
    (["stimulation", "own.toml", *MUSCLES], ["--csv=out.csv", "-o=out.svg"]),
    (["export", *OWN], ["-o=out.xml"]),
    (["moments", "trial.toml"], ["-o=out.csv", "--plot=out.png"]),
    (["moments", "trial.toml", "--fit-muscles"], ["-o=out.npz"]),
    (["sweep", "study.toml", "-o", "folder", *MUSCLES], ["--csv=out.csv", "--plot=out.png"]),
]


@pytest.mark.parametrize(
    ("command", "option"), [(command, option) for command, options in READING for option in options], ids=str
)
def test_no_output_replaces_a_file_that_is_named(
    command: list[str], option: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Under whatever name: the output is a link to each of the inputs in turn."""
    monkeypatch.chdir(tmp_path)
    Path("own.toml").write_text(design_toml(load_design("r1")))
    load_riders("p1p2").taken(slice(0, 3)).save(Path("riders.npz"))
    Path("problem.toml").write_text(DEFAULT.read_text())
    Path("mine.csv").write_text("crank_angle_deg,knee_Nm,hip_Nm\n0,10,0\n90,20,0\n180,0,5\n270,-10,0\n")
    Path("trial.toml").write_text('[moments]\nfile = "mine.csv"\n')
    Path("study.toml").write_text('[grid]\ndesign = ["own.toml"]\nmoments = ["p1p2"]\nR2 = [0.1, 0.2]\n')
    named = {"study.toml", "own.toml"} if command[0] == "sweep" else set()
    named |= {"mine.csv"} if "trial.toml" in command else set()
    for name in {word for word in command if "." in word} | named:
        flag, _, out = option.partition("=")
        Path(out).hardlink_to(name)
        before = Path(name).read_bytes()
        code, said, err = result(capsys, *command, flag, out)
        assert (code, said) == (2, "")
        assert f"it would replace {name}, which this command reads" in err
        assert Path(name).read_bytes() == before
        Path(out).unlink()


@pytest.mark.parametrize(
    ("package", "command"),
    [
        ("pyarrow", ["sweep", "study.toml", "-o", "out"]),
        ("mediapy", ["simulate", "d1", "-o", "out", "--render", "out.mp4"]),
        ("mediapy", ["ride", "d1", "-o", "out", "--render", "out.mp4"]),
    ],
    ids=str,
)
def test_a_missing_part_is_said_before_anything_is_written(
    package: str,
    command: list[str],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setitem(sys.modules, package, None)
    Path("study.toml").write_text('[grid]\ndesign = ["d1"]\n')
    code, out, err = result(capsys, *command)
    assert (code, out) == (3, "")
    assert "pip install" in err
    assert [*Path().iterdir()] == [Path("study.toml")]
