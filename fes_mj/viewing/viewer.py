"""A design running in MuJoCo's interactive viewer, with its drive and the crank servo."""

import time
import warnings

import glfw
import mujoco
import mujoco.viewer

from fes_mj.common.errors import MissingPartError
from fes_mj.linkage.design import Design
from fes_mj.linkage.legs import TWO_LEGS
from fes_mj.simulation.export import mjcf_text, scene_text
from fes_mj.simulation.mjcf import build_mjcf
from fes_mj.simulation.stepping import actuation
from fes_mj.statics.drive import Drive, torque_source


def show(design: Design, drive: Drive, cadence: float) -> None:
    """Run in real time, two legs, until the viewer is closed. Raises MissingPartError without a screen."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # the reason, which is always the same
        if not glfw.init():  # the viewer itself would end the process
            raise MissingPartError(
                "the viewer needs a screen and there is none; make a video instead: "
                "`fes_mj simulate ... --render out.mp4`"
            )
    model = mujoco.MjModel.from_xml_string(
        scene_text(design, "model.xml"), {"model.xml": mjcf_text(build_mjcf(design, cadence=cadence, legs=2)).encode()}
    )
    data, torque = mujoco.MjData(model), torque_source(drive, design, cadence)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    controls = {leg: torque.control(leg, model.opt.timestep) for leg in TWO_LEGS}
    act = actuation(controls, model, data, memoryview(data.qvel))
    with mujoco.viewer.launch_passive(model, data, show_left_ui=False, show_right_ui=False) as viewer:
        viewer.cam.type, viewer.cam.fixedcamid = mujoco.mjtCamera.mjCAMERA_FIXED, model.camera("side").id
        start = time.monotonic()
        while viewer.is_running():
            while data.time < time.monotonic() - start:
                act()
                mujoco.mj_step(model, data)
            viewer.sync()
            time.sleep(1 / 60)
