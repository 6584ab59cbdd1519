"""What the page holds is a design file's content: there and back, with the same refusals."""

from dataclasses import replace

import pytest

import fes_mj
from fes_mj.common.errors import InputError
from fes_mj.explore.dimensions import content_of, design_of, dimensions, of_kind
from fes_mj.linkage.design import Design
from fes_mj.linkage.variables import component


def test_there_and_back(design: Design) -> None:
    assert design_of(content_of(design)) == design


def test_every_dimension_has_its_place(design: Design) -> None:
    content, kind = content_of(design), design.linkage.kind
    for dimension in dimensions():
        if kind in dimension["kinds"]:
            value = content[dimension["owner"]][dimension["symbol"]]
            value = value if dimension["part"] is None else value[dimension["part"]]
            assert value == pytest.approx(component(design, dimension["name"]), rel=1e-15)
            assert dimension["low"] <= value * dimension["factor"] <= dimension["high"], dimension["name"]


def test_a_gear_ratio_within_its_bounds_can_be_run() -> None:
    bounds = next(dimension for dimension in dimensions() if dimension["name"] == "gear_ratio")
    content = content_of(fes_mj.load_design("d1"))
    for ratio, rpm in ((bounds["low"], 1), (bounds["high"], 200)):
        content["linkage"]["gear_ratio"] = ratio
        assert design_of(content).linkage.cadence * 30 / 3.141592653589793 == pytest.approx(rpm)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"R2": 5}, r"d1: linkage.R2 is 5"),
        ({"R1": 3}, r"d1: linkage.R1 is 3"),
        ({"R3": 1}, r"d1: unknown key linkage.R3"),
        ({"kind": "bicycle"}, r"d1: linkage.kind is 'bicycle'"),
    ],
)
def test_refusals_are_those_of_design_files(change: dict[str, object], message: str) -> None:
    content = content_of(fes_mj.load_design("d1"))
    content["linkage"] |= change
    with pytest.raises(InputError, match=message):
        design_of(content)


@pytest.mark.parametrize("kind", ["trt", "crt", "cdt"])
def test_another_kind_keeps_the_crank_where_it_is(design: Design, kind: str) -> None:
    other = of_kind(replace(design, linkage=replace(design.linkage, seat_angle=0.3)), kind)
    assert design_of(content_of(other)) == other  # a design that files may hold
    assert other.linkage.kind == kind
    assert (other.linkage.crank, other.linkage.foot) == (design.linkage.crank, design.linkage.foot)
    assert (other.linkage.seat_angle, other.rider) == (0.3, design.rider)
    assert other.linkage.crank_centre == pytest.approx(design.linkage.crank_centre, abs=1e-12)
    if kind == design.linkage.kind:
        assert other.linkage == replace(design.linkage, seat_angle=0.3)


def test_six_bars_keep_their_branch() -> None:
    right = fes_mj.load_design("d1").with_linkage(branch="right")
    assert of_kind(right, "crt").linkage.branch == "right"
    assert of_kind(right, "trt").linkage.branch == "left"  # it has none


def test_a_cadence_that_no_command_runs_is_refused() -> None:
    content = content_of(fes_mj.load_design("d1"))
    content["linkage"]["gear_ratio"] = 20
    with pytest.raises(InputError, match=r"d1: linkage.gear_ratio is 20, which makes 918 rpm"):
        design_of(content)


@pytest.mark.parametrize("content", [None, [], {}, {"name": 3}])
def test_what_is_no_design(content: object) -> None:
    with pytest.raises(InputError):
        design_of(content)
