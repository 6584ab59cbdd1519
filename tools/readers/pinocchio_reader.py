"""Pinocchio: rigid-body dynamics with loop constraints; it has no simulator, so steps are taken here."""

from __future__ import annotations

import numpy as np
import pinocchio
from protocol import Answer, Job, serve

# Of a loop that opens, rad/s: stiff against the motion, soft against the time step.
STABILISATION = 500.0


def measure(job: Job) -> Answer:
    model, loops = pinocchio.buildModelAndLegacyConstraintsFromMJCF(job["model"])
    data = model.createData()
    pictures = pinocchio.buildGeomFromMJCF(model, job["model"], pinocchio.GeometryType.VISUAL)
    keyframes = [item.key() for item in model.referenceConfigurations if item.key() != "qpos0"]
    answer: Answer = {
        "joints": model.njoints - 1,
        "loops": len(loops),
        "keeps": {
            "geoms": pictures.ngeoms,
            "sites": sum(frame.name.endswith(("_pedal", "_crank_pin", "_torque")) for frame in model.frames),
            "keyframe": len(keyframes),
        },
    }
    if "samples" not in job:
        return answer
    position, speed = np.zeros(model.nq), np.zeros(model.nv)
    for name, (angle, rate) in job["joints"].items():
        joint = model.joints[model.getJointId(name)]
        position[joint.idx_q], speed[joint.idx_v] = angle, rate
    for loop in loops:
        loop.setBaumgarteCorrectorParameters(
            pinocchio.BaumgarteCorrectorParameters(STABILISATION**2, 2 * STABILISATION)
        )
    parts = pinocchio.StdVec_RigidConstraintData()
    parts.extend(loop.createData() for loop in loops)
    pinocchio.initConstraintDynamics(model, data, loops, parts)
    none = np.zeros(model.nv)
    # in the plane one of a loop's three rows is empty, which only the proximal solver bears
    settings = pinocchio.ProximalSettings(1e-12, 1e-8, 50)

    def rates(state: np.ndarray) -> np.ndarray:
        position, speed = np.split(state, 2)
        return np.r_[speed, pinocchio.constraintDynamics(model, data, position, speed, none, loops, parts, settings)]

    state, step = np.r_[position, speed], job["timestep"]
    first = rates(state)[model.nq :]
    jacobian = pinocchio.getConstraintsJacobian(model, data, loops, parts)
    answer["free"] = model.nv - int(np.linalg.matrix_rank(jacobian, tol=1e-6))
    answer["acceleration"] = {name: float(first[model.joints[model.getJointId(name)].idx_v]) for name in job["joints"]}
    places, done, answer["states"] = [model.joints[model.getJointId(name)].idx_q for name in job["joints"]], 0, []
    for count in job["samples"]:
        for _ in range(count - done):  # Runge-Kutta of fourth order
            k1 = rates(state)
            k2 = rates(state + step / 2 * k1)
            k3 = rates(state + step / 2 * k2)
            k4 = rates(state + step * k3)
            state = state + step / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
        done, (position, speed) = count, np.split(state, 2)
        answer["states"].append([position[places].tolist(), speed[places].tolist()])
        if "pedal" in job and len(answer["states"]) == 1:
            pinocchio.framesForwardKinematics(model, data, position)
            answer["pedal"] = data.oMf[model.getFrameId("shank_pedal")].translation[[0, 2]].tolist()
    return answer


if __name__ == "__main__":
    serve(pinocchio.__version__, measure)
