"""dm_control, which needs an older MuJoCo than this project: its Physics and its own MJCF parser."""

from __future__ import annotations

from importlib.metadata import version

import mujoco
import numpy as np
from dm_control import mjcf
from mujoco_reader import keeps
from protocol import Answer, Job, serve


def measure(job: Job) -> Answer:
    physics = mjcf.Physics.from_mjcf_model(mjcf.from_path(job["model"]))
    model, data = physics.model.ptr, physics.data.ptr
    physics.reset(keyframe_id=0)
    mujoco.mj_forward(model, data)
    jacobian = np.asarray(data.efc_J).reshape(-1, model.nv)
    answer = {
        "joints": model.njnt,
        "loops": int(data.ne) // 3,
        "free": model.nv - int(np.linalg.matrix_rank(jacobian, tol=1e-6)),
        "keeps": keeps(model),
    }
    if "steps" in job:
        answer["acceleration"] = {name: float(data.qacc[model.joint(name).dofadr[0]]) for name in job["joints"]}
        for _ in range(job["steps"]):
            mujoco.mj_step(model, data)
        mujoco.mj_kinematics(model, data)
        answer["pedal"] = data.site_xpos[model.site("shank_pedal").id][[0, 2]].tolist()
    return answer


if __name__ == "__main__":
    serve(f"{version('dm-control')} with mujoco {mujoco.__version__}", measure)
