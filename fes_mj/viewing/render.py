"""Videos of a cross-check: legs and linkage beside the crank power, or the tricycle on its road beside its speed."""

import math
import signal
import subprocess
import sys
from collections.abc import Iterable, Iterator
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from typing import Any

import mujoco
import numpy as np

from fes_mj.budget.answer import Answer
from fes_mj.common.arrays import IntArray, Picture
from fes_mj.common.console import progress_bar
from fes_mj.common.errors import InputError, MissingPartError, require_extra
from fes_mj.common.writing import replacing, temporary_beside
from fes_mj.crosscheck.ride_case import RideCase
from fes_mj.crosscheck.turn_case import Case
from fes_mj.simulation.appearance import Spec
from fes_mj.simulation.bench import Simulation
from fes_mj.simulation.mjcf import build_mjcf
from fes_mj.simulation.road import RoadRun
from fes_mj.simulation.road_mjcf import build_road_mjcf
from fes_mj.viewing.headless import use_offscreen_gl
from fes_mj.viewing.stage import PLOT_WIDTH, SIDE, stage
from fes_mj.viewing.wheels import add_wheels, ground

FRAMES_PER_SECOND = 30
LOOP = 4.0  # s that a turn takes in slow motion, and that the turns shown take at least
REPEATS = 2  # of these turns
LONGEST = 12.0  # s of a ride that are shown, in real time, from the start
AFTER_STOP = 1.0  # s that are shown of a tricycle that has stopped
_DISTANCE = 1.3  # of the camera, per that of a bench: room for the road
_TILE = 0.5  # m of a light and a dark tile of the road each


def slow_motion(cadence: float) -> float:
    """Speed of a video, per the true one, in which a turn of the crank (rad/s) takes LOOP."""
    return 2 * np.pi / (cadence * LOOP)


def steps_shown(run: Simulation, speed: float) -> IntArray:
    """Steps of a run's first turn that are the frames of a video at this speed: of whole turns, for LOOP at least."""
    turn = 2 * np.pi / (run.cadence * speed)  # s
    turns = max(1, int(np.ceil(LOOP / turn - 1e-9)))
    steps, frames = len(run.crank_angle) // run.turns, max(2, round(turns * turn * FRAMES_PER_SECOND))
    return (np.arange(frames) * turns * steps // frames) % steps


def render_video(
    case: Case | RideCase, path: Path, speed: float | None = None, quiet: bool = False, answer: Answer | None = None
) -> None:
    """Write an H.264 video: of a turn whole turns, REPEATS times; of a ride its begin, in true time.

    speed: of a turn's video, 1 is the true one; by default that of slow_motion. answer: the design's two numbers, which
    are written beside a turn. Raises MissingPartError as require_video, InputError if the file cannot be written.
    """
    require_video()
    if isinstance(case, RideCase):
        run = case.simulation
        end = min(LONGEST, float(run.trace.time[-1]), (run.trace.stopped_at or math.inf) + AFTER_STOP)
        shown = (np.arange(0, end, 1 / FRAMES_PER_SECOND) / run.timestep).astype(int)
        write_video(path, _ride_pictures(case, shown, end), len(shown), quiet)
    else:
        speed = slow_motion(case.cadence) if speed is None else speed
        shown = steps_shown(case.simulation, speed)
        write_video(path, turn_frames(case, shown, speed, answer), len(shown), quiet, REPEATS)


def turn_frames(case: Case, steps: IntArray, speed: float, answer: Answer | None = None) -> Iterator[Picture]:
    """The frames at these steps of the first turn, as render_video has them, shape (SIDE, SIDE + PLOT_WIDTH, 3)."""
    from fes_mj.viewing.panel import power_panel

    run, panel = case.simulation, power_panel(case, answer)
    spec = build_mjcf(run.design, cadence=run.cadence, timestep=run.timestep, legs=len(run.legs))
    with stage(spec, run.design, speed, len(run.legs)) as scene:
        for step in steps:
            pose = {name: angle[step] for name, angle in run.joint_angle.items()}
            yield np.hstack([scene.picture(pose), panel(int(step))])


def require_video() -> None:
    """Raise MissingPartError if OpenGL, ffmpeg or a package of the extra "video" is missing."""
    mediapy = require_extra("video", "mediapy", "imageio_ffmpeg", "matplotlib", "PIL")
    use_offscreen_gl()
    try:
        mediapy.set_ffmpeg(require_extra("video", "imageio_ffmpeg").get_ffmpeg_exe())
    except RuntimeError:
        raise MissingPartError("there is no ffmpeg; it comes with: pip install 'fes-mj[video]'") from None


def write_video(path: Path, frames: Iterable[Picture], count: int, quiet: bool = False, repeats: int = 1) -> None:
    """Write `count` frames, shape (SIDE, SIDE + PLOT_WIDTH, 3), so many times over, as video.

    They are encoded while the next is drawn, and once only: the repeats are copies. Raises InputError if it cannot.
    """
    mediapy, encoder = (require_extra("video", name) for name in ("mediapy", "imageio_ffmpeg"))
    shape, look = (SIDE, SIDE + PLOT_WIDTH), {"fps": FRAMES_PER_SECOND, "crf": 20, "ffmpeg_args": "-preset veryfast"}
    with (
        progress_bar("rendering, frames", count, quiet) as advance,
        replacing(path) as beside,
        temporary_beside(path) as once,
    ):
        try:
            with ExitStack() as writing:
                writer = mediapy.VideoWriter(once, shape, **look)
                writing.callback(_close_pipes, writer)
                with _held_signals():
                    writing.enter_context(writer)
                for frame in frames:
                    writer.add_image(frame)
                    advance(1)
            copy = ["-v", "error", "-y", "-stream_loop", str(repeats - 1), "-i", str(once), "-c", "copy", str(beside)]
            with _held_signals():
                subprocess.run([encoder.get_ffmpeg_exe(), *copy], check=True, capture_output=True, text=True)
        except (RuntimeError, BrokenPipeError, subprocess.CalledProcessError) as error:  # with words or without
            message = error.stderr if isinstance(error, subprocess.CalledProcessError) else str(error)
            reason = message.strip().rpartition("] ")[2].strip()
            raise InputError(f"{path}: cannot be written: the encoder stopped: {reason}") from None


def _close_pipes(writer: Any) -> None:
    """Of an encoder that failed: mediapy leaves them open."""
    for stream in (writer._proc.stdin, writer._proc.stderr) if writer._proc else ():
        with suppress(OSError):
            stream.close()


@contextmanager
def _held_signals() -> Iterator[None]:
    """Keep signals that end the run waiting: one that comes while the encoder starts would leave it running alone."""
    if sys.platform == "win32":
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT, signal.SIGTERM, signal.SIGHUP})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _ride_pictures(case: RideCase, steps: IntArray, end: float) -> Iterator[Picture]:
    """The frames at these steps of a ride that is shown until `end`, s; in true time."""
    from fes_mj.viewing.panel import ride_panel

    run, panel = case.simulation, ride_panel(case, end)
    spec = build_road_mjcf(run.ride, run.timestep)
    _add_road(spec, run)
    radii = add_wheels(spec, run.ride.design)
    with stage(spec, run.ride.design, speed=1.0, legs=2, road=_DISTANCE) as scene:
        for step in steps:
            pose = {name: run.sensors[f"{name}_angle"][step] for name in run.sensors.joints}
            distance = float(run.trace.distance[step])
            rolled = {name: distance / radius for name, radius in radii.items()}
            yield np.hstack([scene.picture(pose | rolled, distance), panel(int(step))])


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
        pos=(-length / 2, 0, ground(run.ride.design)),
        size=(length / 2 + 10, 3, 0.1),
        contype=0,
        conaffinity=0,
    )
