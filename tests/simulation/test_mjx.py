"""The exported ride in MJX, where that is installed."""

from __future__ import annotations

from typing import Any

import mujoco
import numpy as np
import pytest

import fes_mj
from fes_mj.simulation.export import mjcf_text
from fes_mj.simulation.variants import variant_model, variant_options


@pytest.mark.long
def test_the_ride_rolls_out_in_mjx() -> None:
    """A thousand steps of the file: finite, forwards, where MuJoCo comes to, and its loops hold."""
    jax: Any = pytest.importorskip("jax")
    mjx: Any = pytest.importorskip("mujoco.mjx")
    jax.config.update("jax_enable_x64", True)
    design = fes_mj.load_design("d1")
    options = variant_options(["ride", "compatible"])
    spec = variant_model(design, fes_mj.load_moments(), design.linkage.cadence, options)
    model = mujoco.MjModel.from_xml_string(mjcf_text(spec))
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    put = mjx.put_model(model)

    @jax.jit
    def roll(state: Any) -> Any:
        begin = mjx.step(put, state)  # settles the types of the carry
        return jax.lax.fori_loop(1, 1000, lambda _, current: mjx.step(put, current), begin)

    final = np.asarray(roll(mjx.put_data(model, data)).qpos)
    model.dof_dampingpoly[:] = 0.0  # MJX leaves out the air's resistance
    mujoco.mj_step(model, data, nstep=1000)
    assert np.isfinite(final).all()
    assert final[0] == pytest.approx(data.joint("road").qpos[0], rel=2e-4)
    data.qpos[:] = final
    mujoco.mj_forward(model, data)
    gaps = [model.sensor(i).name for i in range(model.nsensor) if model.sensor(i).name.endswith("_gap")]
    assert max(float(np.linalg.norm(data.sensor(gap).data)) for gap in gaps) < 1e-5
