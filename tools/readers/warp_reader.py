"""MuJoCo Warp on the CPU: the same engine in single precision."""

from __future__ import annotations

from importlib.metadata import version

import mujoco
import mujoco_warp
import numpy as np
import warp
from mujoco_reader import keeps
from protocol import Answer, Job, serve

warp.config.quiet = True


def measure(job: Job) -> Answer:
    model = mujoco.MjModel.from_xml_path(job["model"])
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    for motor, moment in job.get("controls", {}).items():
        data.actuator(motor).ctrl = moment
    put, state = mujoco_warp.put_model(model), mujoco_warp.put_data(model, data)
    mujoco_warp.forward(put, state)
    jacobian = state.efc.J.numpy()[0, : int(state.ne.numpy()[0]), : model.nv]
    answer = {
        "joints": model.njnt,
        "loops": int(state.ne.numpy()[0]) // 3,
        "free": model.nv - int(np.linalg.matrix_rank(jacobian, tol=1e-4)),
        "keeps": keeps(model),
    }
    if "samples" in job:
        acceleration = state.qacc.numpy()[0]
        answer["acceleration"] = {name: float(acceleration[model.joint(name).dofadr[0]]) for name in job["joints"]}
        done, answer["states"] = 0, []
        for count in job["samples"]:
            for _ in range(count - done):
                mujoco_warp.step(put, state)
            done = count
            answer["states"].append([part.numpy()[0].astype(float).tolist() for part in (state.qpos, state.qvel)])
            if "pedal" in job and len(answer["states"]) == 1:
                mujoco_warp.kinematics(put, state)
                pedal = state.site_xpos.numpy()[0, model.site("shank_pedal").id, [0, 2]]
                answer["pedal"] = pedal.astype(float).tolist()
    return answer


if __name__ == "__main__":
    serve(version("mujoco-warp"), measure)
