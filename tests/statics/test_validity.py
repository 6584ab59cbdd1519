"""One rule for whether a design can be computed and at which cadence; an advice is one that helps."""

import math
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given

import fes_mj
from fes_mj.common.errors import InputError
from fes_mj.linkage.design import Design
from fes_mj.linkage.variables import replaced
from fes_mj.moments.reference_tricycle import PAPER_TRICYCLE
from fes_mj.statics.cycles import cycles
from fes_mj.statics.validity import obstacles, turning_in_range, valid_speed
from fes_mj.statics.work_table import WorkTable
from tests.linkages import designs


def flipped(name: str, **parts: complex) -> Design:
    """A design whose R1 (and R7) are multiplied in x and y by the real and imaginary part of the given factors."""
    design = fes_mj.load_design(name)
    changes = {
        part: complex(getattr(design.linkage, part).real * sign.real, getattr(design.linkage, part).imag * sign.imag)
        for part, sign in parts.items()
    }
    return design.with_linkage(**changes)


@pytest.mark.parametrize("name", ["r1", "r2", "d1", "d2"])
@pytest.mark.parametrize(
    ("sign", "said"),
    [
        (-1 + 1j, r"\+x"),
        (1 - 1j, "y is down"),
        (-1 - 1j, "x is forwards and y down"),
    ],
)
def test_a_mirrored_sketch_is_recognised(name: str, sign: complex, said: str) -> None:
    with pytest.raises(InputError, match=said):
        fes_mj.quasi_static(flipped(name, ground=sign, pivot_to_crank=sign), fes_mj.load_moments())


@pytest.mark.parametrize("name", ["trt", "r1", "r2", "d1", "d2"])
def test_a_wrong_sign_of_r1_is_recognised_before_anything_runs(name: str) -> None:
    wrong = flipped(name, ground=-1 + 1j)
    for run in (fes_mj.quasi_static, fes_mj.simulate):
        with pytest.raises(InputError, match="R1's x"):
            run(wrong, fes_mj.load_moments())


@given(designs())
def test_a_hip_that_never_enters_the_range_is_refused_and_one_that_does_is_not(design: Design) -> None:
    turning_in_range(design, PAPER_TRICYCLE)
    high = PAPER_TRICYCLE.ranges.hip[1]
    angle = fes_mj.quasi_static(design, fes_mj.load_moments(), points=360).joint_angle.hip
    beyond = replace(
        design, linkage=replace(design.linkage, seat_angle=design.linkage.seat_angle + angle.min() - high - 0.01)
    )
    with pytest.raises(InputError, match="the hip"):
        turning_in_range(beyond, PAPER_TRICYCLE)


@pytest.mark.parametrize("seat", range(-90, 100, 10))
def test_no_advice_leaves_a_design_refused(seat: int) -> None:
    """On the level y is neither up nor down, and what turns the knee's range round need not bring the hip into its."""
    linkage = fes_mj.Linkage("crt", -0.65 + 0j, 0.08, 0.10, -0.45 + 0j, 0.18, 0.44, 0.16, seat_angle=math.radians(seat))
    design = fes_mj.Design("level", linkage)
    said = _refusal(design)
    assert "y is down" not in said
    if advised := re.search(r'branch = "(left|right)"', said):
        assert not _refusal(design.with_linkage(branch=advised[1]))
    if advised := re.search(r"seat_angle = (\S+)", said):
        assert not _refusal(design.with_linkage(seat_angle=math.radians(float(advised[1]))))


def test_a_hip_out_of_range_alone_gets_a_seat_angle_that_helps() -> None:
    low = fes_mj.load_design("trt").with_linkage(seat_angle=math.radians(10))
    advised = re.search(r"another seat it does: seat_angle = (\S+)", _refusal(low))
    assert advised
    assert not _refusal(low.with_linkage(seat_angle=math.radians(float(advised[1]))))


def _refusal(design: Design) -> str:
    try:
        turning_in_range(design, PAPER_TRICYCLE)
    except InputError as error:
        return str(error)
    return ""


@pytest.mark.parametrize("ratio", [0.01, 4.4, 20.0])
def test_a_cadence_that_cannot_be_run_is_refused_by_all(ratio: float, tmp_path: Path) -> None:
    """Of the design's own gear ratio as of one that is given."""
    design, moments = fes_mj.load_design("d1").with_linkage(gear_ratio=ratio), fes_mj.load_moments()
    export = lambda design, moments: fes_mj.export(design, moments, tmp_path / "d1.xml")  # noqa: E731
    for run in (fes_mj.quasi_static, fes_mj.simulate, fes_mj.Case, export, valid_speed):
        with pytest.raises(InputError, match=r"d1: linkage\.gear_ratio is .* rpm.*from 1 to 200"):
            run(design, moments)
    assert valid_speed(design, moments, 6.0) == 6.0


def test_a_batch_is_refused_as_each_of_its_designs() -> None:
    design, moments = fes_mj.load_design("d1"), fes_mj.load_moments()
    values = {
        "R2": np.linspace(0.12, 0.2, 5),
        "seat_angle": np.linspace(-60.0, 90.0, 5),
        "gear_ratio": np.geomspace(0.01, 20, 4),
    }
    grid = dict(zip(values, np.stack(np.meshgrid(*values.values())).reshape(3, -1, 1), strict=True))
    batch = replaced(design, grid)
    refusing = obstacles(cycles(batch, WorkTable.of(moments)), np.ravel(batch.linkage.cadence))
    hindered = np.any([np.broadcast_to(obstacle.hindered, batch.size) for obstacle in refusing], axis=0)
    reasons = [bool(np.any(obstacle.hindered)) for obstacle in refusing]
    assert sum(reasons) >= 4  # the rocker, the leg, the hip, the cadence
    for row in range(batch.size):
        try:
            valid_speed(batch.single(row), moments)
        except InputError:
            assert hindered[row]
        else:
            assert not hindered[row]
