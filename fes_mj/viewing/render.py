"""The video of a cross-check: the moving legs and linkage beside the crank power over the turn."""

import subprocess
from collections.abc import Iterable, Iterator
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from fes_mj.common.arrays import IntArray, Picture
from fes_mj.common.console import progress_bar
from fes_mj.common.errors import InputError, MissingPartError, require_extra
from fes_mj.common.writing import replacing
from fes_mj.crosscheck.turn_case import Case
from fes_mj.simulation.bench import Simulation
from fes_mj.simulation.mjcf import build_mjcf
from fes_mj.viewing.headless import use_offscreen_gl
from fes_mj.viewing.stage import SIDE, stage

PLOT_WIDTH = 560  # pixels
FRAMES_PER_SECOND = 30
LOOP = 4.0  # s that a turn takes in slow motion, and that the turns shown take at least
REPEATS = 2  # of these turns


def slow_motion(cadence: float) -> float:
    """Speed of a video, per the true one, in which a turn of the crank (rad/s) takes LOOP."""
    return 2 * np.pi / (cadence * LOOP)


def steps_shown(run: Simulation, speed: float) -> IntArray:
    """Steps of a run's first turn that are the frames of a video at this speed: of whole turns, for LOOP at least."""
    turn = 2 * np.pi / (run.cadence * speed)  # s
    turns = max(1, int(np.ceil(LOOP / turn - 1e-9)))
    steps, frames = len(run.crank_angle) // run.turns, max(2, round(turns * turn * FRAMES_PER_SECOND))
    return (np.arange(frames) * turns * steps // frames) % steps


def render_video(case: Case, path: Path, speed: float | None = None, quiet: bool = False) -> None:
    """Write an H.264 video of whole turns, REPEATS times, to `path`; raises as require_video and write_video.

    speed: of the video, 1 is the true one; by default that of slow_motion.
    """
    require_video()
    speed = speed or slow_motion(case.cadence)
    shown = steps_shown(case.simulation, speed)
    write_video(path, pictures(case, shown, speed), len(shown), quiet, REPEATS)


def pictures(case: Case, steps: IntArray, speed: float) -> Iterator[Picture]:
    """The frames at these steps of the first turn, shape (SIDE, SIDE + PLOT_WIDTH, 3)."""
    from fes_mj.viewing.power_panel import PowerPanel

    run, panel = case.simulation, PowerPanel(case, PLOT_WIDTH, SIDE)
    spec = build_mjcf(run.design, cadence=run.cadence, timestep=run.timestep, legs=len(run.legs))
    with stage(spec, run.design, speed, len(run.legs)) as scene:
        for step in steps:
            pose = {name: angle[step] for name, angle in run.joint_angle.items()}
            yield np.hstack([scene.picture(pose), panel.frame(int(step))])


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
        TemporaryDirectory() as folder,
    ):
        once = Path(folder) / "once.mp4"
        try:
            with mediapy.VideoWriter(once, shape, **look) as writer:
                for frame in frames:
                    writer.add_image(frame)
                    advance(1)
            copy = ["-v", "error", "-y", "-stream_loop", str(repeats - 1), "-i", str(once), "-c", "copy", str(beside)]
            subprocess.run([encoder.get_ffmpeg_exe(), *copy], check=True, capture_output=True, text=True)
        except (
            RuntimeError,
            BrokenPipeError,
            subprocess.CalledProcessError,
        ) as error:  # it ended, with words or without
            said = error.stderr if isinstance(error, subprocess.CalledProcessError) else str(error)
            reason = said.strip().rpartition("] ")[2].strip()
            raise InputError(f"{path}: cannot be written: the encoder stopped: {reason}") from None
