"""dm_control, which needs an older MuJoCo than this project: its Physics and its own MJCF parser."""

from __future__ import annotations

from importlib.metadata import version

import mujoco
from dm_control import mjcf
from mujoco_reader import counted, keeps, run
from protocol import Answer, Job, serve


def measure(job: Job) -> Answer:
    physics = mjcf.Physics.from_mjcf_model(mjcf.from_path(job["model"]))
    model, data = physics.model.ptr, physics.data.ptr
    physics.reset(keyframe_id=0)
    for motor, moment in job.get("controls", {}).items():
        data.ctrl[model.actuator(motor).id] = moment
    mujoco.mj_forward(model, data)
    answer = counted(model, data) | {"keeps": keeps(model)}
    if "samples" in job:
        answer["acceleration"] = {name: float(data.qacc[model.joint(name).dofadr[0]]) for name in job["joints"]}
        answer |= run(model, data, job)
    return answer


if __name__ == "__main__":
    serve(f"{version('dm-control')} with mujoco {mujoco.__version__}", measure)
