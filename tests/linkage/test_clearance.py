"""Gaps and layers against outlines that are sampled point by point."""

import itertools

import numpy as np
import pytest

import fes_mj
from fes_mj.common.errors import InputError
from fes_mj.linkage.clearance import CLEARANCE, Side
from fes_mj.linkage.design import BODIES, Frame
from fes_mj.linkage.joints import JOINTS
from fes_mj.linkage.kinematics import FULL_TURN
from fes_mj.linkage.layers import stack
from fes_mj.linkage.plates import Hole, Plate, hole_places


def side(design: fes_mj.Design, margin: float = 0.015, pin: float = 0.012) -> Side:
    """Of a design whose links and pins all have one size, m."""
    plates = {
        body: Plate(body, tuple(Hole(joint, place, pin) for joint, place in places.items()), margin, 0.008)
        for body, places in hole_places(design).items()
    }
    return Side(design, plates, {joint: pin for joint in design.linkage.architecture.joints if joint not in JOINTS})


def _sampled(view: Side, part: str, place: int) -> np.ndarray:
    """Points a millimetre apart along the sides of a part's core, with its radius, at a place of the turn."""
    points = []
    for shape in view.shapes[part]:
        core = np.array(shape.core)
        if shape.body:
            origin = np.broadcast_to(view.motion.points[BODIES[shape.body][0]].value, FULL_TURN.shape)[place]
            core = origin + view.motion.direction(shape.body)[place] * core
        for start, end in itertools.pairwise([*core, core[0]]) if len(core) > 1 else [(core[0], core[0])]:
            points += [np.linspace(start, end, 2 + int(1000 * abs(end - start)))]
    return np.concatenate(points)


def test_gaps_are_those_of_sampled_outlines(design: fes_mj.Design) -> None:
    """At the crank angle that is named, and nowhere else in the turn is it less."""
    view = side(design)
    assert view.gaps
    for gap in view.gaps:
        if gap.distance < 0 or "ground" in gap.parts:
            continue
        radii = [view.shapes[part][0].radius for part in gap.parts]

        def nearest(place: int, gap=gap, radii=radii) -> float:  # type: ignore[no-untyped-def]
            one, other = (_sampled(view, part, place) for part in gap.parts)
            return float(np.abs(one[:, None] - other).min() - sum(radii))

        named = int(np.flatnonzero(gap.crank_angle == FULL_TURN)[0])
        # samples half a millimetre beside the nearest point are farther by less than (0.5 mm)^2 / 2 of the distance
        assert nearest(named) == pytest.approx(gap.distance, abs=1e-5)
        assert all(nearest(place) > gap.distance - 1e-9 for place in range(0, len(FULL_TURN), 48))


def test_the_ground_is_below_everything(design: fes_mj.Design) -> None:
    """Of a ground at the lowest point of the boot its gap is none."""
    from dataclasses import replace

    view = side(replace(design, frame=Frame(ground_height=-1.0)))
    gap = next(gap for gap in view.gaps if gap.parts == ("boot", "ground"))
    raised = side(replace(design, frame=Frame(ground_height=-1.0 + gap.distance)))
    assert next(g for g in raised.gaps if g.parts == ("boot", "ground")).distance == pytest.approx(0, abs=1e-12)
    assert ("boot", "ground") in {g.parts for g in raised.hindrances}


def test_what_shares_a_layer_never_meets(design: fes_mj.Design) -> None:
    view = side(design)
    layers, joints = stack(view).layers, design.linkage.architecture.joints
    for one, other in itertools.combinations(layers, 2):
        if layers[one] == layers[other]:
            assert view.gap(one, other).distance >= CLEARANCE
            assert {one, other} not in [{*pair} for pair in joints.values()]
    level = {"frame": 0, **layers, "shank": 9}
    for joint, link in itertools.product(view.pins, layers):
        low, high = sorted(level[body] for body in joints[joint])
        if low < level[link] < high and link not in joints[joint]:
            assert view.gap(link, joint).distance >= CLEARANCE


def test_links_that_overlap_in_every_layout_are_refused() -> None:
    """R2's coupler passes the pedal at 13.5 mm from middle to middle, and its rocker pivot at 91: with wider links
    neither the pedal's pin finds a way past the coupler nor the pivot's past it.
    """
    with pytest.raises(InputError, match=r"r2: the links cannot be laid out.*coupler - .*crank angle \d+ deg"):
        stack(side(fes_mj.load_design("r2"), margin=0.09))
