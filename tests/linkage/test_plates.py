"""Plates weigh what their outlines say, by closed forms and by the polygon that shapely makes of them."""

import math

import numpy as np
import pytest
import shapely

import fes_mj
from fes_mj.linkage.design import BODIES
from fes_mj.linkage.kinematics import FULL_TURN, solve
from fes_mj.linkage.plates import Hole, Plate, hole_places


def test_a_disc_with_a_hole_and_a_stadium() -> None:
    """By hand: two half discs and a rectangle, less two holes; moments of inertia about the middle."""
    length, margin, hole, thickness, density = 0.2, 0.02, 0.012, 0.008, 2700.0
    plate = Plate("crank", (Hole("a", 0j, hole), Hole("b", complex(length), hole)), margin, thickness)
    area = length * 2 * margin + math.pi * margin**2 - 2 * math.pi * hole**2 / 4
    rectangle = length * 2 * margin * (length**2 + (2 * margin) ** 2) / 12
    # a half disc's centre of area is 4 r / 3 pi from its diameter
    off, half = 4 * margin / (3 * math.pi), math.pi * margin**2 / 2
    caps = 2 * (half * margin**2 / 2 - half * off**2 + half * (length / 2 + off) ** 2)
    holes = 2 * math.pi * hole**2 / 4 * (hole**2 / 8 + (length / 2) ** 2)
    mass, centre, moment = plate.inertia(density)
    assert plate.area == pytest.approx(area, rel=1e-12)
    assert mass == pytest.approx(density * thickness * area, rel=1e-12)
    assert centre == pytest.approx(length / 2, rel=1e-12)
    assert moment == pytest.approx(density * thickness * (rectangle + caps - holes), rel=1e-12)


@pytest.mark.parametrize("third", [0.05 + 0.1j, 0.05 - 0.1j, -0.1 + 0.01j, 0.3 + 0.2j])
def test_a_triangle_against_shapelys_polygon(third: complex) -> None:
    """Whichever side the third hole is on; the polygon's circles have 4,096 corners, 4e-7 too little area."""
    holes = (Hole("a", 0j, 0.01), Hole("b", 0.25 + 0j, 0.014), Hole("c", third, 0.02))
    plate = Plate("coupler", holes, 0.03, 0.01)
    outline = shapely.convex_hull(shapely.MultiPoint([(h.place.real, h.place.imag) for h in holes]))
    outline = outline.buffer(plate.margin, quad_segs=1024)
    for hole in holes:
        outline -= shapely.Point(hole.place.real, hole.place.imag).buffer(hole.diameter / 2, quad_segs=1024)
    assert plate.area == pytest.approx(outline.area, rel=1e-6)
    assert plate.inertia(1.0).centre == pytest.approx(complex(outline.centroid.x, outline.centroid.y), abs=1e-8)


def test_holes_are_the_joints(design: fes_mj.Design) -> None:
    """In every position the holes of two links that are joined lie on each other."""
    motion, places = solve(design), hole_places(design)
    joined = design.linkage.architecture.joints
    for body, holes in places.items():
        assert {joint for joint, pair in joined.items() if body in pair} == holes.keys()
        origin = np.broadcast_to(motion.points[BODIES[body][0]].value, FULL_TURN.shape)
        for joint, place in holes.items():
            where = origin + motion.direction(body) * place
            assert np.abs(where - motion.points[joint].value).max() < 1e-12
