"""Geoms are pictures only, and wear the colours of the plots."""

import itertools

import mujoco
import numpy as np
import pytest

from fes_mj import load_design
from fes_mj.common.style import COLOURS, LINKS, rgb
from fes_mj.linkage.design_file import DESIGNS
from fes_mj.linkage.inertia import inertias
from fes_mj.linkage.shapes import PARTS
from fes_mj.simulation.mjcf import build_mjcf


@pytest.mark.parametrize("legs", [1, 2])
@pytest.mark.parametrize("name", DESIGNS)
def test_geoms_are_pictures_only(name: str, legs: int) -> None:
    """Geoms neither weigh nor touch; every body wears one; hinges and pins stay in one plane."""
    design = load_design(name)
    model = build_mjcf(design, legs=legs).compile()
    assert not model.geom_contype.any()
    assert not model.geom_conaffinity.any()
    masses = inertias(design)
    for number in range(1, model.nbody):
        body = model.body(number)
        assert number in model.geom_bodyid, body.name
        segment = body.name.removeprefix("right_").removeprefix("left_")
        arms = legs if segment == "crank" else 1
        assert body.mass == pytest.approx(masses[segment].mass * arms if segment in masses else 0, rel=1e-15)
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    mujoco.mj_forward(model, data)
    for loop in range(model.neq):
        first, second = (data.site_xpos[ends[loop]] for ends in (model.eq_obj1id, model.eq_obj2id))
        assert first[1] == second[1]
        assert np.linalg.norm(first - second) < 1e-15


def test_no_link_hides_another() -> None:
    """Bars of one linkage that can cross in the side view lie in layers that do not touch."""
    model = build_mjcf(load_design("d1")).compile()
    reach = {}
    for body in ("crank", "coupler", "rocker"):
        geom = model.geom(f"{body}_bar")
        reach[body] = (geom.pos[1] - geom.size[0], geom.pos[1] + geom.size[0])
    for (low, high), (other_low, other_high) in itertools.combinations(reach.values(), 2):
        assert high < other_low or other_high < low


def test_the_model_wears_the_colours_of_the_plots() -> None:
    for name, colour in (LINKS | {joint: COLOURS[joint] for joint in ("knee", "hip")}).items():
        assert PARTS[name].colour == rgb(colour)
