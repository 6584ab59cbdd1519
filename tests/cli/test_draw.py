"""`fes_mj draw`: files, JSON, and one message for what cannot be drawn."""

import json
import re
from pathlib import Path
from typing import get_args

import pytest

import fes_mj
from fes_mj.cli.app import run
from fes_mj.cli.draw import MaterialName
from fes_mj.statics.materials import materials
from fes_mj.statics.sizes import FORCE_POINTS, build

OWN = """
[linkage]
kind = "trt"
R1 = [-0.736, -0.304]
R2 = 0.15
R6 = 0.069
gear_ratio = 1.31
seat_angle = 60.0
[frame]
ground_height = {ground}
wheel_diameter = 0.5
wheel_centre = [0.4, -0.2]
"""


@pytest.mark.long
def test_files_and_numbers(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "own.toml").write_text(OWN.format(ground=-0.75))
    arguments = ["draw", str(tmp_path / "own.toml"), "-o", str(tmp_path / "own"), "--json"]
    assert run(arguments) == 0
    content = json.loads(capsys.readouterr().out)
    assert content["layers"] == {"crank": 1}
    assert content["clearance_min_m"]["boot - ground"] > 0.005
    assert content["clearance_min_m"]["boot - tube"] is None
    written = {path.relative_to(tmp_path / "own").as_posix() for path in (tmp_path / "own").rglob("*.*")}
    drawings = {"links/crank.dxf", "sheet.dxf", "sheet.svg", "sheet.pdf"}
    assert {name for name in written if not name.rpartition("/")[2].startswith(".")} == drawings | {
        "links.csv",
        "pin_forces.csv",
        "link_moments.csv",
    }
    assert run(arguments) == 0  # over its own files


@pytest.mark.long
def test_a_foot_in_the_ground_is_said_and_fails(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "own.toml").write_text(OWN.format(ground=-0.5))
    assert run(["draw", str(tmp_path / "own.toml"), "-o", str(tmp_path / "own")]) == 1
    assert "Cannot be built so" in capsys.readouterr().out


def test_what_is_printed_has_the_units_of_its_heads(capsys: pytest.CaptureFixture[str]) -> None:
    """34 teeth at the wheel by 26 at the crank are 0.18 % less than 1.31; the pedal's axle is one of 9/16 inch."""
    from fes_mj.cli.draw import _print

    made = build(fes_mj.quasi_static(fes_mj.load_design("trt"), fes_mj.load_moments(), points=FORCE_POINTS))
    _print(made)
    text, crank = capsys.readouterr().out, made.plates["crank"]
    width, thickness = f"{1000 * crank.width:g}", f"{1000 * crank.thickness:g}"
    assert re.search(rf"crank +{width} +{thickness} +{made.mass['crank']:.3f} +1\b", text)
    assert re.search(r"pedal +14\.3 +\d+ +1500\b", text)
    assert re.search(r"ratio 1\.31: 26 .* 34 .* -0\.18 %", text)
    assert f"{1000 * made.stack.feet:.0f} mm" in text


@pytest.mark.parametrize(
    ("arguments", "names"),
    [
        (["d1", "--material", "wood"], ["--material", '"wood"', '"aluminium", "steel", "stainless"']),
        (["d1", "-o", "{file}"], ["{file}", "not a folder"]),
        (["r2", "--dims", "printed"], ["r2", "cannot close"]),
        (["r2"], ["r2", "no pin in stock bears", "N on the"]),
        (["nobody"], ["nobody", "no such design"]),
    ],
)
def test_bad_input(arguments: list[str], names: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """One line on standard error, exit code 2, nothing left behind."""
    file = tmp_path / "file"
    file.write_text("x")
    words = [word.format(file=file) for word in arguments]
    assert run(["draw", *words] + ([] if "-o" in words else ["-o", str(tmp_path / "new")])) == 2
    printed = capsys.readouterr()
    assert not printed.out
    (line,) = printed.err.splitlines()
    assert all(name.format(file=file) in line for name in names), line
    assert [path.name for path in tmp_path.iterdir()] == ["file"]


def test_the_materials_of_the_command_line_are_those_that_there_are() -> None:
    assert get_args(MaterialName) == materials()
