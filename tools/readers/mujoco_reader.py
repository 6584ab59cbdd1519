"""MuJoCo itself, in a process of its own: the reference for the other readers, and how far it can be trusted."""

from __future__ import annotations

import mujoco
import numpy as np
from protocol import Answer, Job, serve

# How soft Drake's loops are per the inverse inertia that they feel: its solver's near-rigid regularisation with
# beta = 0.1, which is what its accelerations show (TRT, one leg: to 7e-6 rad/s^2).
NEAR_RIGID = 0.1**2 / (4 * np.pi**2)


def measure(job: Job) -> Answer:
    model = mujoco.MjModel.from_xml_path(job["model"])
    answer = counted(model, start(model)) | {"keeps": keeps(model)}
    return answer | motion(model, job) if "samples" in job else answer


def counted(model: mujoco.MjModel, data: mujoco.MjData) -> dict[str, int]:
    """Joints, loops, and the degrees of freedom that they and a fixed gear leave."""
    jacobian = np.asarray(data.efc_J).reshape(-1, model.nv)[: int(data.ne)]
    free = model.nv - int(np.linalg.matrix_rank(jacobian, tol=1e-6))
    return {"joints": model.njnt, "loops": int(data.ne) // 3, "free": free}


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


def start(model: mujoco.MjModel, controls: dict[str, float] | None = None) -> mujoco.MjData:
    """The state of the keyframe, with its accelerations."""
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    for motor, moment in (controls or {}).items():
        data.actuator(motor).ctrl = moment
    mujoco.mj_forward(model, data)
    return data


def run(model: mujoco.MjModel, data: mujoco.MjData, job: Job) -> Answer:
    """States at the samples, and the pedal at the first."""
    states, answer, done = [], {}, 0
    for count in job["samples"]:
        for _ in range(count - done):
            mujoco.mj_step(model, data)
        done = count
        states.append([data.qpos.tolist(), data.qvel.tolist()])
        if "pedal" in job and len(states) == 1:
            probe = mujoco.MjData(model)
            probe.qpos[:] = data.qpos
            mujoco.mj_kinematics(model, probe)
            answer["pedal"] = probe.site("shank_pedal").xpos[[0, 2]].tolist()
    return answer | {"states": states}


def motion(model: mujoco.MjModel, job: Job) -> Answer:
    """Acceleration and pedal, and how much they change with softer loops and with half the time step."""
    controls = job["controls"]
    acceleration, answer = accelerations(model, start(model, controls)), run(model, start(model, controls), job)
    near_rigid = accelerations(model, start(model, controls), NEAR_RIGID)
    if "pedal" in job:
        answer["step_change"] = step_change(model, job)
    model.eq_solimp[:, :2] = 1 - 2 * (1 - model.eq_solimp[:, :2])
    softer = accelerations(model, start(model, controls))
    names = [model.joint(i).name for i in range(model.njnt)]
    return answer | {
        "acceleration": dict(zip(names, acceleration[0].tolist(), strict=True)),
        "without_velocity_term": dict(zip(names, acceleration[1].tolist(), strict=True)),
        "softness_change": float(np.abs(softer - acceleration).max()),
        "near_rigid": dict(zip(names, near_rigid[1].tolist(), strict=True)),
        "near_rigid_change": float(np.abs(near_rigid - acceleration)[1].max()),
        "loop_gain": loop_gain(model, start(model, controls)),
    }


def loop_gain(model: mujoco.MjModel, data: mujoco.MjData) -> float:
    """Largest joint acceleration, rad/s^2, if every coordinate of every loop asks for 1 m/s^2 in the worst direction.

    Near a dead centre it is large: there a small gap takes a large turn to close.
    """
    jacobian, mass = data.efc_J.reshape(-1, model.nv)[: int(data.ne)], np.zeros((model.nv, model.nv))
    mujoco.mj_fullM(model, data, mass)
    weighted = jacobian.T * data.efc_D[: int(data.ne)]
    return float(np.abs(np.linalg.solve(mass + weighted @ jacobian, weighted)).sum(axis=1).max())


def step_change(model: mujoco.MjModel, job: Job) -> float:
    """How far half the time step moves the pedal at the first sample with an integrator of first order, m."""
    integrator, step, count = model.opt.integrator, model.opt.timestep, job["samples"][0]
    model.opt.integrator, pedals = mujoco.mjtIntegrator.mjINT_EULER, []
    for parts in (1, 2):
        model.opt.timestep = step / parts
        pedals.append(run(model, start(model), job | {"samples": [parts * count]})["pedal"])
    model.opt.integrator, model.opt.timestep = integrator, step
    return float(np.linalg.norm(np.subtract(*pedals)))


def accelerations(model: mujoco.MjModel, data: mujoco.MjData, softness: float | None = None) -> np.ndarray:
    """Joint accelerations, rad/s^2, shape (2, joints): MuJoCo's, and what it gives without dJ/dt v in its loops.

    Some readers lack that term: their loops follow the velocity, not the acceleration, of the motion. softness: of a
    loop, per the size (root mean square) of the inverse inertia that it feels, J M^-1 J'; by default MuJoCo's own.
    """
    jacobian, mass, loops = data.efc_J.reshape(-1, model.nv), np.zeros((model.nv, model.nv)), slice(int(data.ne))
    mujoco.mj_fullM(model, data, mass)
    stiffness, damping, impedance = data.efc_KBIP[loops, :3].T
    reference = -damping * data.efc_vel[loops] - stiffness * impedance * data.efc_pos[loops]
    rigidity = data.efc_D[loops].copy()
    if softness:
        felt = jacobian[loops] @ np.linalg.solve(mass, jacobian[loops].T)
        for loop in (slice(row, row + 3) for row in range(0, int(data.ne) // 3 * 3, 3)):
            rigidity[loop] = 3 / (softness * np.linalg.norm(felt[loop, loop]))
    weighted = jacobian[loops].T * rigidity
    forces = mass @ data.qacc_smooth + jacobian[data.ne :].T @ data.efc_force[data.ne :]  # the road's friction slips
    without = np.linalg.solve(mass + weighted @ jacobian[loops], forces + weighted @ reference)
    return np.array([data.qacc, without])


if __name__ == "__main__":
    serve(mujoco.__version__, measure)
