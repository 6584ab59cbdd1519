"""Every example runs, and what it computes is held against an exact or independent value."""

import runpy
from pathlib import Path

import numpy as np
import pytest

EXAMPLES = Path(__file__).parents[1] / "examples"


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


def test_no_example_is_left_out() -> None:
    tested = {name.removeprefix("test_") for name in globals() if name.startswith("test_")}
    assert {path.stem for path in EXAMPLES.glob("*.py")} <= tested
