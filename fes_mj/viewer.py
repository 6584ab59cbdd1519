"""A design running in MuJoCo's interactive viewer, under the torque map and the crank servo."""

from __future__ import annotations

import time

import mujoco
import mujoco.viewer

from fes_mj.design import Design
from fes_mj.export import mjcf_text, scene_text
from fes_mj.mjcf import LEGS
from fes_mj.simulation import joint_drives
from fes_mj.torque import JointMoments, TorqueMap


def show(design: Design, moments: JointMoments, cadence: float) -> None:
    """Run in real time, two legs, until the viewer is closed."""
    model = mujoco.MjModel.from_xml_string(
        scene_text(design, "model.xml"), {"model.xml": mjcf_text(design, cadence=cadence, legs=2).encode()}
    )
    data, torque_map = mujoco.MjData(model), TorqueMap(moments)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    drives = {name: torque_map.feedback(joint) for name, joint in joint_drives(LEGS[2]).items()}
    with mujoco.viewer.launch_passive(model, data, show_left_ui=False, show_right_ui=False) as viewer:
        viewer.cam.type, viewer.cam.fixedcamid = mujoco.mjtCamera.mjCAMERA_FIXED, model.camera("side").id
        start = time.monotonic()
        while viewer.is_running():
            while data.time < time.monotonic() - start:
                for name, moment in drives.items():
                    joint = data.joint(name)
                    data.actuator(name).ctrl = moment(float(joint.qpos[0]), float(joint.qvel[0]))
                mujoco.mj_step(model, data)
            viewer.sync()
            time.sleep(1 / 60)
