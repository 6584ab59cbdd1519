"""The video of a ride: the tricycle on its road beside its speed and its muscles' power, with a cursor that moves."""

import math
from collections.abc import Iterator
from pathlib import Path

import mujoco
import numpy as np

from fes_mj.common.arrays import IntArray, Picture
from fes_mj.crosscheck.ride_case import RideCase
from fes_mj.simulation.appearance import Spec, lowest_point
from fes_mj.simulation.road import RoadRun
from fes_mj.simulation.road_mjcf import build_road_mjcf
from fes_mj.viewing.render import FRAMES_PER_SECOND, PLOT_WIDTH, require_video, write_video
from fes_mj.viewing.stage import SIDE, stage

LONGEST = 12.0  # s that are shown, in real time, from the start
AFTER_STOP = 1.0  # s that are shown of a tricycle that has stopped
_DISTANCE = 1.3  # of the camera, per that of a bench: room for the road
_TILE = 0.5  # m of a light and a dark tile of the road each


def render_ride(case: RideCase, path: Path, quiet: bool = False) -> None:
    """Write an H.264 video of the begin of a ride to `path`; raises as render.require_video and write_video."""
    require_video()
    run = case.simulation
    trace = run.trace
    end = min(LONGEST, float(trace.time[-1]), (trace.stopped_at or math.inf) + AFTER_STOP)
    shown = (np.arange(0, end, 1 / FRAMES_PER_SECOND) / run.timestep).astype(int)
    write_video(path, _pictures(case, shown, end), len(shown), quiet)


def _pictures(case: RideCase, steps: IntArray, end: float) -> Iterator[Picture]:
    """The frames at these steps of a ride that is shown until `end`, s; in true time."""
    from fes_mj.viewing.ride_panel import RidePanel

    run, panel = case.simulation, RidePanel(case, end, PLOT_WIDTH, SIDE)
    spec = build_road_mjcf(run.ride, run.timestep)
    _add_road(spec, run)
    with stage(spec, run.ride.design, speed=1.0, legs=2, road=_DISTANCE) as scene:
        for step in steps:
            pose = {name: run.sensors[f"{name}_angle"][step] for name in run.sensors.joints}
            yield np.hstack([scene.picture(pose, run.trace.distance[step]), panel.frame(int(step))])


def _add_road(spec: Spec, run: RoadRun) -> None:
    """A plane in tiles, so that one sees it pass."""
    tiles = spec.add_texture(name="tiles", type=mujoco.mjtTexture.mjTEXTURE_2D, width=64, height=64)
    tiles.builtin, tiles.rgb1, tiles.rgb2 = mujoco.mjtBuiltin.mjBUILTIN_CHECKER, [0.80] * 3, [0.70, 0.72, 0.75]
    material = spec.add_material(name="road", texuniform=True, texrepeat=[1 / (2 * _TILE)] * 2, emission=0.4)
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
