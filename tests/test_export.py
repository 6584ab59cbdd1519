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
