"""MuJoCo itself, in a process of its own: the reference for the other readers, and how far it can be trusted."""

from __future__ import annotations

import mujoco
import numpy as np
from protocol import Answer, Job, serve


def measure(job: Job) -> Answer:
    model = mujoco.MjModel.from_xml_path(job["model"])
    data = start(model)
    jacobian = data.efc_J.reshape(-1, model.nv)
    answer = {
        "joints": model.njnt,
        "loops": int(data.ne // 3),
        "free": model.nv - int(np.linalg.matrix_rank(jacobian, tol=1e-6)),
        "keeps": keeps(model),
    }
    return answer | motion(model, job) if "steps" in job else answer


def keeps(model: mujoco.MjModel) -> dict[str, int]:
    """Parts of the model by kind."""
    return {
        "geoms": model.ngeom,
        "cameras": model.ncam,
        "sites": model.nsite,
        "motors": int((model.actuator_biastype == 0).sum()),
        "servo": int((model.actuator_biastype != 0).sum()),
        "sensors": model.nsensor,
        "keyframe": model.nkey,
    }


def start(model: mujoco.MjModel) -> mujoco.MjData:
    """The state of the keyframe, with its accelerations."""
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    mujoco.mj_forward(model, data)
    return data


def motion(model: mujoco.MjModel, job: Job) -> Answer:
    """Acceleration and pedal, and how much they change with loops twice as soft and with half the time step."""
    acceleration = accelerations(model)
    pedal = final_pedal(model, job["steps"])
    model.opt.timestep /= 2
    finer_pedal = final_pedal(model, 2 * job["steps"])
    model.opt.timestep *= 2
    model.eq_solimp[:, :2] = 1 - 2 * (1 - model.eq_solimp[:, :2])
    softer = accelerations(model)
    names = [model.joint(i).name for i in range(model.njnt)]
    return {
        "acceleration": dict(zip(names, acceleration[0].tolist(), strict=True)),
        "without_velocity_term": dict(zip(names, acceleration[1].tolist(), strict=True)),
        "pedal": pedal.tolist(),
        "softness_change": float(np.abs(softer - acceleration).max()),
        "step_change": float(np.linalg.norm(finer_pedal - pedal)),
    }


def accelerations(model: mujoco.MjModel) -> np.ndarray:
    """Joint accelerations, rad/s^2, shape (2, joints): MuJoCo's, and what it gives without dJ/dt v in its loops.

    Some readers lack that term: their loops follow the velocity, not the acceleration, of the motion.
    """
    data = start(model)
    jacobian, mass = data.efc_J.reshape(-1, model.nv), np.zeros((model.nv, model.nv))
    mujoco.mj_fullM(model, data, mass)
    stiffness, damping, impedance = data.efc_KBIP[:, :3].T
    reference = -damping * data.efc_vel - stiffness * impedance * data.efc_pos
    weighted = jacobian.T * data.efc_D
    without = np.linalg.solve(mass + weighted @ jacobian, mass @ data.qacc_smooth + weighted @ reference)
    return np.array([data.qacc, without])


def final_pedal(model: mujoco.MjModel, steps: int) -> np.ndarray:
    """Where the pedal is (x, z; m) after so many steps from the keyframe."""
    data = start(model)
    for _ in range(steps):
        mujoco.mj_step(model, data)
    mujoco.mj_kinematics(model, data)
    return data.site("shank_pedal").xpos[[0, 2]].copy()


if __name__ == "__main__":
    serve(mujoco.__version__, measure)
