"""mjcf/ is what tools/make_models.py writes, and its users get the promised power without fes_mj."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import mujoco
import numpy as np
import pytest

from fes_mj import load_design, load_moments
from fes_mj.cli import run
from fes_mj.design_file import CATALOGUE
from fes_mj.statics import quasi_static
from tools.make_models import HEIGHT, WIDTH, model_files

ROOT = Path(__file__).parents[1]
NUMBER = re.compile(r"-?\d+\.?\d*(?:e-?\d+)?")


@pytest.mark.parametrize("name", CATALOGUE)
def test_the_folder_holds_what_the_tool_writes(name: str) -> None:
    """Word by word, numbers to the last digits, which differ between mathematical libraries."""
    for file, text in model_files(load_design(name)).items():
        kept = (ROOT / "mjcf" / name / file).read_text(encoding="utf-8")
        assert NUMBER.sub("#", kept) == NUMBER.sub("#", text), f"{file}: run tools/make_models.py"
        kept_numbers, numbers = ([float(number) for number in NUMBER.findall(of)] for of in (kept, text))
        assert kept_numbers == pytest.approx(numbers, rel=1e-8, abs=1e-12), f"{file}: run tools/make_models.py"


@pytest.mark.parametrize("name", CATALOGUE)
def test_the_folder_has_a_picture(name: str) -> None:
    picture = (ROOT / "mjcf" / name / f"{name}.png").read_bytes()
    assert picture[:8] == b"\x89PNG\r\n\x1a\n"
    assert [int.from_bytes(picture[at : at + 4]) for at in (16, 20)] == [WIDTH, HEIGHT]


def test_the_folder_holds_nothing_else() -> None:
    found = {path.name for path in (ROOT / "mjcf").iterdir()}
    assert found == set(CATALOGUE)
    for name in CATALOGUE:
        files = {path.name for path in (ROOT / "mjcf" / name).iterdir()}
        assert files == {f"{name}.xml", "scene.xml", f"{name}.csv", "README.md", f"{name}.png"}


def replay(model: Path) -> float:
    """Mean crank power, W, that the example prints in a process that cannot import fes_mj."""
    command = [sys.executable, "-I", "-c", _REPLAY, str(ROOT / "examples" / "replay_moments.py"), str(model)]
    process = subprocess.run(command, capture_output=True, text=True, cwd=model.parent)
    assert process.returncode == 0, process.stderr
    return float(re.search(r"crank power ([\d.-]+) W", process.stdout)[1])  # type: ignore[index]


_REPLAY = """
import runpy, sys
sys.modules["fes_mj"] = None
sys.argv = sys.argv[1:]
runpy.run_path(sys.argv[0])
"""


@pytest.mark.parametrize("name", CATALOGUE)
def test_a_user_gets_the_power_of_statics_from_the_files(name: str) -> None:
    expected = quasi_static(load_design(name), load_moments()).power_mean
    assert replay(ROOT / "mjcf" / name / f"{name}.xml") == pytest.approx(expected, rel=5e-3)


@pytest.mark.parametrize("variant", ["two-legs", "compatible", "bodies"])
def test_a_user_gets_it_from_the_variants(variant: str, tmp_path: Path) -> None:
    model = tmp_path / "model.xml"
    arguments = ["export", "d1", "--group", "p1p3", "-o", str(model), "--variant", variant]
    assert run(arguments) == 0
    legs = 2 if variant == "two-legs" else 1
    expected = legs * quasi_static(load_design("d1"), load_moments("p1p3")).power_mean
    assert replay(model) == pytest.approx(expected, rel=5e-3)


def test_the_round_trip_would_notice_wrong_moments(tmp_path: Path) -> None:
    """Exchanged joints miss the power by far more than the limit of the tests above."""
    (tmp_path / "model.xml").write_text((ROOT / "mjcf/d1/d1.xml").read_text())
    table = (ROOT / "mjcf/d1/d1.csv").read_text()
    (tmp_path / "model.csv").write_text(
        table.replace("knee_Nm", "x").replace("hip_Nm", "knee_Nm").replace("x", "hip_Nm")
    )
    expected = quasi_static(load_design("d1"), load_moments()).power_mean
    assert abs(replay(tmp_path / "model.xml") / expected - 1) > 0.1


def test_the_scene_loads_from_anywhere() -> None:
    for name in CATALOGUE:
        model = mujoco.MjModel.from_xml_path(str(ROOT / "mjcf" / name / "scene.xml"))
        assert np.isfinite(model.key_qpos).all()
