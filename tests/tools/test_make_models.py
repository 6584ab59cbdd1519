"""mjcf/ is what tools/make_models.py writes."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import mujoco
import numpy as np
import pytest

from fes_mj import load_design
from fes_mj.linkage.design_file import DESIGNS
from tools.make_models import HEIGHT, SHIPPED, WIDTH, model_files

ROOT = Path(__file__).parents[2]
NUMBER = re.compile(r"-?\d+\.?\d*(?:e-?\d+)?")


@pytest.mark.parametrize("name", DESIGNS)
def test_the_folder_holds_what_the_tool_writes(name: str) -> None:
    """Word by word, numbers to the last digits, which differ between mathematical libraries."""
    for file, text in model_files(load_design(name)).items():
        kept = (ROOT / "mjcf" / name / file).read_text(encoding="utf-8")
        assert NUMBER.sub("#", kept) == NUMBER.sub("#", text), f"{file}: run tools/make_models.py"
        kept_numbers, numbers = ([float(number) for number in NUMBER.findall(of)] for of in (kept, text))
        assert kept_numbers == pytest.approx(numbers, rel=1e-8, abs=1e-12), f"{file}: run tools/make_models.py"


@pytest.mark.parametrize("name", DESIGNS)
def test_the_folder_has_a_picture(name: str) -> None:
    picture = (ROOT / "mjcf" / name / f"{name}.png").read_bytes()
    assert picture[:8] == b"\x89PNG\r\n\x1a\n"
    assert [int.from_bytes(picture[at : at + 4]) for at in (16, 20)] == [WIDTH, HEIGHT]


def test_the_folder_holds_nothing_else() -> None:
    folders = {path.name for path in (ROOT / "mjcf").iterdir()}
    assert folders == set(DESIGNS)
    for name in DESIGNS:
        files = {path.name for path in (ROOT / "mjcf" / name).iterdir()}
        models = {f"{name}.xml", *(f"{name}-{suffix}.xml" for suffix in SHIPPED)}
        assert files == {*models, "scene.xml", f"{name}.csv", "README.md", f"{name}.png"}
        assert sum((ROOT / "mjcf" / name / file).stat().st_size for file in models) < 100_000


def test_the_scene_loads_from_anywhere() -> None:
    for name in DESIGNS:
        model = mujoco.MjModel.from_xml_path(str(ROOT / "mjcf" / name / "scene.xml"))
        assert np.isfinite(model.key_qpos).all()


def lint(folder: Path) -> str:
    """What mjcf-doctor says of the models of a folder, by its static rules and after two seconds of motion."""
    pytest.importorskip("mjcf_doctor", reason="comes with the group `lint`")
    command = [sys.executable, "-m", "mjcf_doctor", "check", str(folder)]
    said = subprocess.run(command, capture_output=True, text=True).stdout
    return re.sub(r"\x1b\[\d*m", "", said)


@pytest.mark.process
def test_the_linter_finds_nothing() -> None:
    assert "5 model(s) loaded, 0 failed  ·  0 errors  0 warnings" in lint(ROOT / "mjcf")


@pytest.mark.process
@pytest.mark.parametrize("suffix", SHIPPED)
def test_the_linter_finds_nothing_in_the_variants(suffix: str) -> None:
    for name in ("trt", "d1"):
        assert f"{name}-{suffix}.xml  — clean" in lint(ROOT / "mjcf" / name / f"{name}-{suffix}.xml")


@pytest.mark.process
def test_the_linter_finds_an_inertia_in_wrong_units(tmp_path: Path) -> None:
    text = (ROOT / "mjcf" / "d1" / "d1.xml").read_text(encoding="utf-8")
    (tmp_path / "d1.xml").write_text(re.sub(r'diaginertia="[^"]*"', 'diaginertia="1e-9 1e-9 1e-9"', text))
    assert "inertia_too_small" in lint(tmp_path)
