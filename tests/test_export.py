"""The exported MJCF: reloads bit for bit."""

from __future__ import annotations

import math

import mujoco
import numpy as np
import pytest
from numpy.typing import NDArray

from fes_mj import load_design
from fes_mj.design_file import CATALOGUE
from fes_mj.mjcf import build_mjcf
from fes_mj.segments import inertias


def compiled_bytes(model: mujoco.MjModel) -> NDArray[np.uint8]:
    """The whole compiled model, as MuJoCo would write it to a binary file."""
    buffer = np.zeros(mujoco.mj_sizeModel(model), np.uint8)
    mujoco.mj_saveModel(model, None, buffer)
    return buffer


@pytest.mark.parametrize("legs", [1, 2])
@pytest.mark.parametrize("variant", ["sites", "bodies"])
@pytest.mark.parametrize("name", CATALOGUE)
def test_reloads_bit_for_bit(name: str, variant: str, legs: int) -> None:
    design = load_design(name)
    for cadence in (None, 1.0, 2 * math.pi):
        spec = build_mjcf(design, variant=variant, legs=legs, cadence=cadence)
        written = spec.compile()
        reloaded = mujoco.MjModel.from_xml_string(spec.to_xml())
        assert np.array_equal(compiled_bytes(written), compiled_bytes(reloaded))


@pytest.mark.parametrize("legs", [1, 2])
@pytest.mark.parametrize("name", CATALOGUE)
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
    assert np.array_equal(np.abs(model.jnt_axis), np.tile([0, 1, 0], (model.njnt, 1)))
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    mujoco.mj_forward(model, data)
    for loop in range(model.neq):
        first, second = (data.site_xpos[ends[loop]] for ends in (model.eq_obj1id, model.eq_obj2id))
        assert first[1] == second[1]
        assert np.linalg.norm(first - second) < 1e-15
