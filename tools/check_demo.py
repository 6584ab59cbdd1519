"""Check what `make demo` left in a folder: the result agrees, the cycle and model are there, the video moves."""

import json
import subprocess
import sys
from itertools import pairwise
from pathlib import Path

import imageio_ffmpeg
import mujoco
import numpy as np


def main(folder: Path) -> None:
    """Raise SystemExit with the first thing that is wrong."""
    result = json.loads((folder / "d1-p1p2.json").read_text())
    if not (result["agrees"] and abs(result["relative_difference"]) <= 5e-4):
        raise SystemExit(f"dynamic and static do not agree: {result['checks']}")
    power = np.genfromtxt(folder / "d1-p1p2.csv", delimiter=",", names=True)["crank_power_W"].mean()
    if abs(power - result["power_mean_W"]) > 1e-3:
        raise SystemExit(f"mean of the cycle {power} W, in the result {result['power_mean_W']} W")
    model = mujoco.MjModel.from_xml_path(str(folder / "d1-p1p2.xml"))
    if model.neq != 2:
        raise SystemExit(f"{model.neq} loops in the model instead of 2")
    frames = video(folder / "d1.mp4")
    changes = [np.mean(np.abs(after.astype(int) - before) > 30) for before, after in pairwise(frames)]
    if len(frames) < 100 or min(changes) < 1e-3:
        raise SystemExit(f"{len(frames)} frames, the smallest change between two frames is {min(changes):.1e}")
    print(
        f"demo: {power:.3f} W, {1e2 * result['relative_difference']:+.4f} % off statics, {len(frames)} frames that move"
    )


def video(path: Path) -> np.ndarray:
    """Frames of the video, reduced to a quarter in each direction."""
    ffmpeg = [imageio_ffmpeg.get_ffmpeg_exe(), "-v", "error", "-i", str(path), "-vf", "scale=320:180"]
    raw = subprocess.run([*ffmpeg, "-f", "rawvideo", "-pix_fmt", "rgb24", "-"], capture_output=True, check=True).stdout
    return np.frombuffer(raw, np.uint8).reshape(-1, 180, 320, 3)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
