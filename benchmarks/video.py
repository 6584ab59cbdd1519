"""Drawing and encoding a video's frames, in ratios within one run to the plain way: MuJoCo's smoothing and sky, twice.

Prints a table and writes results/benchmarks/video.json.
"""

import tempfile
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import mediapy
import mujoco
import numpy as np

from benchmarks import record
from fes_mj.common.arrays import Picture
from fes_mj.common.console import print_table
from fes_mj.crosscheck.turn_case import Case
from fes_mj.linkage.design_file import load_design
from fes_mj.linkage.legs import LEGS
from fes_mj.moments.files import load_moments
from fes_mj.simulation.mjcf import build_mjcf
from fes_mj.viewing import render
from fes_mj.viewing.panel import power_panel
from fes_mj.viewing.stage import PLOT_WIDTH, SIDE, Camera

ROUNDS = 3  # of both ways in turn; medians and ratios are over rounds
CASE = Case(load_design("d1"), load_moments())


def plain(path: Path) -> None:
    """Smoothed edges and a sky as MuJoCo draws them; all frames first, then encoded twice as the encoder likes."""
    run = CASE.simulation
    spec = build_mjcf(run.design, cadence=run.cadence, timestep=run.timestep)
    spec.visual.global_.offwidth = spec.visual.global_.offheight = SIDE
    sky = spec.add_texture(name="sky", type=mujoco.mjtTexture.mjTEXTURE_SKYBOX, width=64, height=64)
    sky.builtin, sky.rgb1, sky.rgb2 = mujoco.mjtBuiltin.mjBUILTIN_GRADIENT, [1, 1, 1], [0.86, 0.89, 0.93]
    frames = list(_plain_frames(spec.compile()))
    with mediapy.VideoWriter(path, (SIDE, SIDE + PLOT_WIDTH), fps=render.FRAMES_PER_SECOND, crf=20) as writer:
        for frame in frames * render.REPEATS:
            writer.add_image(frame)


def _plain_frames(model: mujoco.MjModel) -> Iterator[Picture]:
    run, data, panel = CASE.simulation, mujoco.MjData(model), power_panel(CASE, None)
    camera = Camera(run.design, LEGS[1][0]).forwards(0)
    with mujoco.Renderer(model, SIDE, SIDE) as renderer:
        for step in render.steps_shown(run, render.slow_motion(run.cadence)):
            for name, angle in run.joint_angle.items():
                data.joint(name).qpos[0] = angle[step]
            mujoco.mj_forward(model, data)
            renderer.update_scene(data, camera)
            yield np.hstack([renderer.render(), panel(int(step))])


def ours(path: Path) -> None:
    """As simulate --render does."""
    render.render_video(CASE, path, quiet=True)


def main() -> None:
    """Measure in turn, print, write."""
    render.require_video()
    count = len(render.steps_shown(CASE.simulation, render.slow_motion(CASE.cadence)))
    rates: dict[str, list[float]] = {}
    sizes: dict[str, int] = {}
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "v.mp4"
        for _ in range(ROUNDS + 1):
            for encode in (plain, ours):
                start = time.perf_counter()
                encode(path)
                rates.setdefault(encode.__name__, []).append(count / (time.perf_counter() - start))
                sizes[encode.__name__] = path.stat().st_size
    measured = {name: np.array(values[1:]) for name, values in rates.items()}
    report: dict[str, Any] = {
        name: {
            "median_frames_per_s": float(np.median(values)),
            "ratio_to_plain": float(np.median(values / measured["plain"])),
            "size_kB": sizes[name] / 1000,
        }
        for name, values in measured.items()
    }
    rows = [
        (name, f"{row['median_frames_per_s']:.1f} frames/s", f"{row['ratio_to_plain']:.2f}", f"{row['size_kB']:.0f}")
        for name, row in report.items()
    ]
    print_table(f"A video of {count} frames, shown twice", ("video", "rate", "ratio", "size, kB"), rows)
    record("video", {"rates": report})


if __name__ == "__main__":
    main()
