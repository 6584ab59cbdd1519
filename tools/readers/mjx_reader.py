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
    for motor, moment in job.get("controls", {}).items():
        data.actuator(motor).ctrl = moment
    model.opt.timestep = job.get("timestep", model.opt.timestep)
    put, start = mjx.put_model(model), mjx.put_data(model, data)
    jax.eval_shape(mjx.step, put, start)  # refuses what MJX does not know, without compiling
    loops = int((model.eq_type == mujoco.mjtEq.mjEQ_CONNECT).sum())
    answer = {"joints": int(put.njnt), "loops": loops, "keeps": keeps(model)}
    if "samples" not in job:
        return answer

    @jax.jit
    def advance(state: mjx.Data, steps: int) -> mjx.Data:
        return jax.lax.fori_loop(0, steps, lambda _, current: mjx.step(put, current), state)

    forward = jax.jit(mjx.forward)(put, start)
    jacobian = np.asarray(forward._impl.efc_J).reshape(-1, model.nv)[: int(forward._impl.ne)]
    answer["free"] = model.nv - int(np.linalg.matrix_rank(jacobian, tol=1e-6))
    answer["acceleration"] = {name: float(forward.qacc[model.joint(name).dofadr[0]]) for name in job["joints"]}
    # a loop wants its state to begin with the types that a step gives it
    kinds = jax.eval_shape(mjx.step, put, start)
    state, done = jax.tree.map(lambda part, kind: part.astype(kind.dtype), start, kinds), 0
    answer["states"] = []
    for count in job["samples"]:
        state, done = advance(state, count - done), count
        answer["states"].append([np.asarray(state.qpos).tolist(), np.asarray(state.qvel).tolist()])
    if "pedal" in job:
        data.qpos[:] = answer["states"][0][0]
        mujoco.mj_kinematics(model, data)
        answer["pedal"] = data.site("shank_pedal").xpos[[0, 2]].tolist()
    return answer


if __name__ == "__main__":
    serve(version("mujoco-mjx"), measure)
