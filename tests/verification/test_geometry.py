"""The instruments that find errors of kinematics."""

from pathlib import Path

import numpy as np
import pytest

import fes_mj
from fes_mj.linkage import kinematics
from fes_mj.linkage.design_file import DESIGNS, DIMENSIONS, design_path, design_toml
from fes_mj.linkage.kinematics import Rotation
from fes_mj.linkage.variables import VARIABLES
from fes_mj.verification.geometry import FILE_ANGLES, closure_error, file_error, measure, rate_errors


def test_rate_errors_see_an_error_of_a_millionth(design: fes_mj.Design, monkeypatch: pytest.MonkeyPatch) -> None:
    motion = kinematics.solve(design, np.linspace(0, 2 * np.pi, 512, endpoint=False))
    assert max(rate_errors(motion)) < 1e-10
    first, second = motion.rotation["thigh"]
    motion.rotation["thigh"] = Rotation(first * (1 + 1e-6), second)
    assert rate_errors(motion)[0] > 1e-8


def test_a_nan_anywhere_is_an_error(design: fes_mj.Design) -> None:
    """Whichever body it is in: the largest of a number and a NaN is the NaN."""
    for body in ("thigh", "shank"):
        motion = kinematics.solve(design, np.linspace(0, 2 * np.pi, 512, endpoint=False))
        first, second = motion.rotation[body]
        motion.rotation[body] = Rotation(first * np.nan, second * np.nan)
        assert np.isnan(rate_errors(motion)).all(), body
    for point in motion.points:
        motion = kinematics.solve(design, np.linspace(0, 2 * np.pi, 8, endpoint=False))
        motion.points[point] = motion.points[point]._replace(value=np.nan)
        assert np.isnan(closure_error(motion)), point


def error(path: Path, design: fes_mj.Design) -> float:
    return file_error(path, kinematics.solve(design, FILE_ANGLES))


@pytest.mark.parametrize("dims", DIMENSIONS)
@pytest.mark.parametrize("name", DESIGNS)
def test_designs_are_what_their_files_say(name: str, dims: str) -> None:
    if (name, dims) == ("r2", "printed"):
        return  # does not close all round
    assert error(design_path(name, dims), fes_mj.load_design(name, dims)) < 1e-14


def test_a_right_branch_and_a_negative_foot_too(tmp_path: Path) -> None:
    design = fes_mj.load_design("r1").with_linkage(branch="right", foot=-0.02, seat_angle=-3.0)
    (path := tmp_path / "own.toml").write_text(design_toml(design))
    assert error(path, design) < 1e-14


@pytest.mark.parametrize("name", ["trt", "r1", "d1"])
def test_a_slip_in_any_dimension_is_seen(name: str) -> None:
    design = fes_mj.load_design(name)
    path, seen = design_path(name), set()
    for symbol in measure(kinematics.solve(design, FILE_ANGLES)):
        variable = VARIABLES[symbol]
        if name not in variable.kinds and design.linkage.kind not in variable.kinds:
            continue  # a CRT has no gamma
        owner = getattr(design, variable.owner)
        slip = {variable.attribute: getattr(owner, variable.attribute) + 1e-6}
        other = design.with_rider(**slip) if variable.owner == "rider" else design.with_linkage(**slip)
        if symbol not in path.read_text():
            continue  # left to its default
        assert error(path, other) == pytest.approx(1e-6, rel=0.01), symbol
        seen.add(symbol)
    assert {"R1", "R2", "R6", "gear_ratio", "seat_angle"} <= seen
    assert name != "d1" or seen >= {"R7", "R8", "R9", "R10", "gamma"}


def test_a_linkage_that_does_not_close_is_an_error() -> None:
    long_crank = fes_mj.load_design("d1").with_linkage(crank=1.0)
    with np.errstate(invalid="ignore"):
        assert np.isnan(error(design_path("d1"), long_crank))
