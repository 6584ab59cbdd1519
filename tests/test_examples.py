"""Every example runs, and what it computes is held against an exact or independent value."""

import re
import runpy
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from fes_mj import load_design, load_moments
from fes_mj.cli.app import run
from fes_mj.design_file import DESIGNS
from fes_mj.statics import quasi_static

ROOT = Path(__file__).parents[1]
EXAMPLES = ROOT / "examples"


def test_crank_length() -> None:
    names = runpy.run_path(str(EXAMPLES / "crank_length.py"))
    assert names["result"].agrees
    assert names["powers"][160] == pytest.approx(names["powers"][162], rel=0.01)  # a millimetre is no leap


def test_own_moments() -> None:
    """A constant moment in extension alone does moment times swing, whatever the linkage."""
    names = runpy.run_path(str(EXAMPLES / "own_moments.py"))
    assert names["static"].work_per_turn == pytest.approx(20 * names["swing"], rel=1e-4)


def test_pedal_force() -> None:
    names = runpy.run_path(str(EXAMPLES / "pedal_force.py"))
    simulated, exact = np.abs(names["run"].loop_force["pedal"]), np.abs(names["reactions"]["pedal"])
    assert simulated.mean() == pytest.approx(exact.mean(), rel=1e-3)


def replay(model: Path) -> float:
    """Mean crank power, W, that the example prints in a process that cannot import fes_mj."""
    command = [sys.executable, "-I", "-c", _REPLAY, str(EXAMPLES / "replay_moments.py"), str(model)]
    process = subprocess.run(command, capture_output=True, text=True, cwd=model.parent)
    assert process.returncode == 0, process.stderr
    return float(re.search(r"crank power ([\d.-]+) W", process.stdout)[1])  # type: ignore[index]


_REPLAY = """
import runpy, sys
sys.modules["fes_mj"] = None
sys.argv = sys.argv[1:]
runpy.run_path(sys.argv[0])
"""


@pytest.mark.parametrize("name", DESIGNS)
def test_replay_moments(name: str) -> None:
    """The files of mjcf/ and MuJoCo alone give the power of statics."""
    expected = quasi_static(load_design(name), load_moments()).power_mean
    assert replay(ROOT / "mjcf" / name / f"{name}.xml") == pytest.approx(expected, rel=5e-3)


@pytest.mark.parametrize("variant", ["two-legs", "compatible", "bodies"])
def test_replay_moments_of_variants(variant: str, tmp_path: Path) -> None:
    model = tmp_path / "model.xml"
    arguments = ["export", "d1", "--group", "p1p3", "-o", str(model), "--variant", variant]
    assert run(arguments) == 0
    legs = 2 if variant == "two-legs" else 1
    expected = legs * quasi_static(load_design("d1"), load_moments("p1p3")).power_mean
    assert replay(model) == pytest.approx(expected, rel=5e-3)


def test_replay_moments_notices_wrong_moments(tmp_path: Path) -> None:
    """Exchanged joints miss the power by far more than the limit of the tests above."""
    (tmp_path / "model.xml").write_text((ROOT / "mjcf/d1/d1.xml").read_text())
    table = (ROOT / "mjcf/d1/d1.csv").read_text()
    (tmp_path / "model.csv").write_text(
        table.replace("knee_Nm", "x").replace("hip_Nm", "knee_Nm").replace("x", "hip_Nm")
    )
    expected = quasi_static(load_design("d1"), load_moments()).power_mean
    assert abs(replay(tmp_path / "model.xml") / expected - 1) > 0.1


def test_no_example_is_left_out() -> None:
    tested = {name.removeprefix("test_") for name in globals() if name.startswith("test_")}
    assert {path.stem for path in EXAMPLES.glob("*.py")} <= tested
