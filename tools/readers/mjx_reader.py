"""MJX: MuJoCo rewritten in JAX, here on the CPU and in double precision."""

from __future__ import annotations

import os
from importlib.metadata import version

os.environ |= {"JAX_PLATFORMS": "cpu", "JAX_ENABLE_X64": "1"}

import jax
import mujoco
import numpy as np
from mujoco import mjx
from mujoco_reader import keeps
from protocol import Answer, Job, serve


def measure(job: Job) -> Answer:
    model = mujoco.MjModel.from_xml_path(job["model"])
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    put, start = mjx.put_model(model), mjx.put_data(model, data)
    jax.eval_shape(mjx.step, put, start)  # refuses what MJX does not know, without compiling
    answer = {"joints": int(put.njnt), "loops": int(put.neq), "keeps": keeps(model)}
    if "steps" in job:
        first = jax.jit(mjx.forward)(put, start)
        jacobian = np.asarray(first._impl.efc_J).reshape(-1, model.nv)
        answer["free"] = model.nv - int(np.linalg.matrix_rank(jacobian, tol=1e-6))
        answer["acceleration"] = {name: float(first.qacc[model.joint(name).dofadr[0]]) for name in job["joints"]}
        last = jax.jit(lambda state: jax.lax.fori_loop(0, job["steps"], lambda _, s: mjx.step(put, s), state))(start)
        last = jax.jit(mjx.kinematics)(put, last)
        answer["pedal"] = np.asarray(last.site_xpos[model.site("shank_pedal").id])[[0, 2]].tolist()
    return answer


if __name__ == "__main__":
    serve(version("mujoco-mjx"), measure)
