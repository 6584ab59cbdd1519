"""The video of a ride: the tricycle on its road beside its speed and its muscles' power, with a cursor that moves."""

import math
from collections.abc import Iterator
from pathlib import Path

import mujoco
import numpy as np

from fes_mj.arrays import IntArray, Picture
from fes_mj.ride_case import RideCase
from fes_mj.simulation.appearance import Spec, lowest_point
from fes_mj.simulation.road import RoadRun, build_road_mjcf
from fes_mj.viewing.render import (
    FRAMES_PER_SECOND,
    HEIGHT,
    PLOT_WIDTH,
    SCENE_WIDTH,
    place,
    require_video,
    set_stage,
    turn_camera,
    write_video,
)

LONGEST = 12.0  # s that are shown, in real time, from the start
AFTER_STOP = 1.0  # s that are shown of a tricycle that has stopped
_TILE = 0.5  # m of a light and a dark tile of the road each


def render_ride(case: RideCase, path: Path, quiet: bool = False) -> None:
    """Write an H.264 video of the begin of a ride to `path`; raises as render.require_video and write_video."""
    require_video()
    from fes_mj.viewing.ride_panel import RidePanel

    run = case.simulation
    trace = run.trace
    end = min(LONGEST, float(trace.time[-1]), (trace.stopped_at or math.inf) + AFTER_STOP)
    shown = (np.arange(0, end, 1 / FRAMES_PER_SECOND) / run.timestep).astype(int)
    panel = RidePanel(case, end, PLOT_WIDTH, HEIGHT)
    pictures = (
        np.hstack([scene, panel.frame(int(step))]) for step, scene in zip(shown, _scenes(run, shown), strict=True)
    )
    write_video(path, pictures, len(shown), quiet)


def _scenes(run: RoadRun, steps: IntArray) -> Iterator[Picture]:
    """Pictures of the tricycle on its road at the given steps, shape (HEIGHT, SCENE_WIDTH, 3)."""
    spec = build_road_mjcf(run.ride, run.timestep)
    set_stage(spec)
    _add_road(spec, run)
    model = spec.compile()
    data, camera = mujoco.MjData(model), turn_camera(run.ride.design)
    camera.distance *= 1.3  # room for the road
    trace, middle = run.trace, np.array(camera.lookat)
    joints = {name: model.joint(name).qposadr[0] for name in run.sensors.joints}
    with mujoco.Renderer(model, HEIGHT, SCENE_WIDTH) as renderer:
        for step in steps:
            for name, address in joints.items():
                data.qpos[address] = run.sensors[f"{name}_angle"][step]
            place(model, data)
            camera.lookat = middle - (trace.distance[step], 0.0, 0.0)
            renderer.update_scene(data, camera)
            yield renderer.render()


def _add_road(spec: Spec, run: RoadRun) -> None:
    """A plane in tiles, so that one sees it pass."""
    tiles = spec.add_texture(name="tiles", type=mujoco.mjtTexture.mjTEXTURE_2D, width=64, height=64)
    tiles.builtin, tiles.rgb1, tiles.rgb2 = mujoco.mjtBuiltin.mjBUILTIN_CHECKER, [0.80] * 3, [0.70, 0.72, 0.75]
    material = spec.add_material(name="road", texuniform=True, texrepeat=[1 / (2 * _TILE)] * 2)
    material.textures[mujoco.mjtTextureRole.mjTEXROLE_RGB] = "tiles"
    length = float(run.trace.distance.max())
    spec.worldbody.add_geom(
        name="road",
        type=mujoco.mjtGeom.mjGEOM_PLANE,
        material="road",
        pos=(-length / 2, 0, lowest_point(run.ride.design) - 0.1),
        size=(length / 2 + 10, 3, 0.1),
        contype=0,
        conaffinity=0,
    )
