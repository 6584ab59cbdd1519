"""What is handed to a workshop, read back by other means than it was written by."""

import csv
import io
import math
import re
from pathlib import Path
from typing import Any

import ezdxf
import ezdxf.bbox
import numpy as np
import pytest
import shapely

import fes_mj
from fes_mj.drawing.folder import contents
from fes_mj.drawing.pen import PEN_LAYERS
from fes_mj.linkage.design import Design
from fes_mj.statics.sizes import Build, build

DESIGNS = ("trt", *(pytest.param(name, marks=pytest.mark.long) for name in ("r1", "d1")))


@pytest.fixture(scope="module", params=DESIGNS)
def made(request: pytest.FixtureRequest) -> Build:
    return build(fes_mj.quasi_static(fes_mj.load_design(request.param), fes_mj.load_moments("p1p2"), points=360))


@pytest.fixture(scope="module")
def files(made: Build) -> dict[Path, Any]:
    return contents(made)


def _lengths(design: Design) -> dict[str, list[float]]:
    """Distances between the holes of each link, mm, in growing order, from the design file's numbers."""
    linkage = design.linkage
    lengths = {"crank": [linkage.crank]}
    if linkage.kind == "crt":
        lengths["rocker"] = [linkage.rocker, linkage.pedal_arm, linkage.rocker + linkage.pedal_arm]
        lengths["coupler"] = [linkage.coupler]
    if linkage.kind == "cdt":
        third = linkage.coupler**2 + linkage.pedal_arm**2
        third -= 2 * linkage.coupler * linkage.pedal_arm * math.cos(linkage.coupler_angle)
        lengths |= {"rocker": [linkage.rocker], "coupler": [linkage.coupler, linkage.pedal_arm, math.sqrt(third)]}
    return {body: sorted(1000 * length for length in own) for body, own in lengths.items()}


def test_links_read_back(made: Build, files: dict[Path, Any]) -> None:
    """Hole distances to 1 um, area and mass to 0.1 %, by polygons along the arcs."""
    for body, lengths in _lengths(made.design).items():
        document = ezdxf.read(io.StringIO(files[Path("links") / f"{body}.dxf"]))
        assert document.units == ezdxf.units.MM
        space = document.modelspace()
        centres = [complex(*circle.dxf.center.vec2) for circle in space.query('CIRCLE[layer=="HOLES"]')]
        pairs = [abs(one - other) for place, one in enumerate(centres) for other in centres[:place]]
        assert sorted(pairs) == pytest.approx(lengths, abs=1e-3)
        (outline,) = space.query('LWPOLYLINE[layer=="OUTLINE"]')
        corners = [tuple(point.vec2) for point in ezdxf.path.make_path(outline).flattening(0.001)]
        area = shapely.Polygon(corners).area
        area -= sum(math.pi * circle.dxf.radius**2 for circle in space.query('CIRCLE[layer=="HOLES"]'))
        plate = made.plates[body]
        assert 1e-6 * area == pytest.approx(plate.area, rel=1e-3)
        mass = 1e-6 * area * plate.thickness * made.material.density
        assert mass == pytest.approx(made.mass[body], rel=1e-3)
        assert len(space.query('LINE[layer=="CENTRE"]')) == 2 * len(centres)
        shown = [dimension.get_measurement() for dimension in space.query("DIMENSION")]
        assert {round(number, 6) for number in shown} >= {round(number, 6) for number in lengths[:1]}


def test_the_holes_of_the_table_are_those_of_the_drawings(made: Build, files: dict[Path, Any]) -> None:
    rows = list(csv.DictReader(io.StringIO(files[Path("links.csv")])))
    for body in made.plates:
        space = ezdxf.read(io.StringIO(files[Path("links") / f"{body}.dxf"])).modelspace()
        circles = [(*circle.dxf.center.vec2, 2 * circle.dxf.radius) for circle in space.query('CIRCLE[layer=="HOLES"]')]
        keys = ("x_m", "y_m", "hole_diameter_m")
        table = [[1000 * float(row[key]) for key in keys] for row in rows if row["link"] == body]
        assert np.array(circles) == pytest.approx(np.array(table), abs=1e-6)


def test_forces_of_the_table_keep_every_link_in_balance(made: Build, files: dict[Path, Any]) -> None:
    """Pushed, without masses: on links but the crank, whose axle holds it, forces and moments add up to nothing."""
    rows = list(csv.DictReader(io.StringIO(files[Path("pin_forces.csv")])))
    motion, joints = made.stack.side.motion, made.design.linkage.architecture.joints
    assert len(rows) == 360
    for body in made.plates.keys() - {"crank"}:
        total, moment = np.zeros(360, complex), np.zeros(360)
        for joint in (hole.joint for hole in made.plates[body].holes):
            x, y = (np.array([float(row[f"{joint}_pushed_{axis}_N"]) for row in rows]) for axis in "xy")
            force = (1 if joints[joint][1] == body else -1) * (x + 1j * y)
            place = np.broadcast_to(motion.points[joint].value, (720,))[::2]
            total, moment = total + force, moment + (np.conj(place) * force).imag
        assert np.abs(total).max() < 1e-4  # nine digits of some kN
        assert np.abs(moment).max() < 1e-4


def test_moments_of_the_table_are_those_of_the_forces_beyond(made: Build, files: dict[Path, Any]) -> None:
    """Pushed: the crank bears the pedal's virtual work, a link of three holes what its last pin does on its arm."""
    moments = list(csv.DictReader(io.StringIO(files[Path("link_moments.csv")])))
    motion, linkage = made.stack.side.motion, made.design.linkage
    pedal = motion.points["pedal"]
    force = 1500 * (pedal.value / np.abs(pedal.value))[::2]
    (crank,) = (key for key in moments[0] if key.startswith("crank_crank_centre_to_") and key.endswith("_pushed_Nm"))
    work = (np.conj(force) * pedal.first[::2]).real
    assert np.array([float(row[crank]) for row in moments]) == pytest.approx(work, abs=1e-4)
    if linkage.kind == "crt":
        key = "rocker_rocker_joint_to_pedal_pushed_Nm"
        arm = (pedal.value - motion.points["rocker_joint"].value)[::2]
        bending = np.array([float(row[key]) for row in moments])
        assert bending == pytest.approx((np.conj(arm) * force).imag, abs=1e-4)


def test_lines_of_the_pictures_are_as_thick_as_the_layers_say(files: dict[Path, Any]) -> None:
    widths = {float(width) for width in re.findall(rb"stroke-width: ([\d.]+)", files[Path("sheet.svg")])}
    assert {round(width * 25.4 / 72, 2) for width in widths} == {width / 100 for _, width, _ in PEN_LAYERS.values()}


@pytest.mark.long
def test_the_same_design_gives_the_same_bytes(made: Build, files: dict[Path, Any]) -> None:
    again = contents(made)
    assert {name for name in files if files[name] != again[name]} == set()


def test_nothing_on_the_sheet_overlaps(files: dict[Path, Any]) -> None:
    """No two texts, and none of them leaves the frame; their width by the letters' mean of the font."""
    space = ezdxf.read(io.StringIO(files[Path("sheet.dxf")])).modelspace()
    boxes = []
    for text in space.query('TEXT[layer=="TEXT"]'):
        extents = ezdxf.bbox.extents([text])
        boxes.append((text.dxf.text, shapely.box(*extents.extmin.vec2, *extents.extmax.vec2)))
    frame = shapely.box(20, 10, 584, 410)
    for place, (name, box) in enumerate(boxes):
        assert frame.contains(box), name
        for other, second in boxes[:place]:
            assert not box.intersects(second), (name, other)
