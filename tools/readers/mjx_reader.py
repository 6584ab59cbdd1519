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
    if "steps" not in job:
        return answer

    @jax.jit
    def advance(state: mjx.Data, steps: int) -> mjx.Data:
        return jax.lax.fori_loop(0, steps, lambda _, current: mjx.step(put, current), state)

    first, last = advance(start, 1), advance(start, job["steps"])
    # accelerations and loops are those of the state before the step
    jacobian = np.asarray(first._impl.efc_J).reshape(-1, model.nv)
    answer["free"] = model.nv - int(np.linalg.matrix_rank(jacobian, tol=1e-6))
    answer["acceleration"] = {name: float(first.qacc[model.joint(name).dofadr[0]]) for name in job["joints"]}
    data.qpos[:] = last.qpos
    mujoco.mj_kinematics(model, data)
    answer["pedal"] = data.site("shank_pedal").xpos[[0, 2]].tolist()
    return answer


if __name__ == "__main__":
    serve(version("mujoco-mjx"), measure)
