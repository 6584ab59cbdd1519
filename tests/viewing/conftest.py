"""Reading a video back."""

import subprocess
from pathlib import Path

import numpy as np
from numpy.typing import NDArray


def frames_of(path: Path) -> tuple[str, NDArray[np.uint8]]:
    """What ffmpeg says of a video, and its frames."""
    import imageio_ffmpeg

    ffmpeg = [
        imageio_ffmpeg.get_ffmpeg_exe(),
        "-hide_banner",
        "-i",
        str(path),
        "-f",
        "rawvideo",
        "-pix_fmt",
        "rgb24",
        "-",
    ]
    done = subprocess.run(ffmpeg, capture_output=True, check=True)
    return done.stderr.decode(), np.frombuffer(done.stdout, np.uint8).reshape(-1, 720, 1280, 3)
