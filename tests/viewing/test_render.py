"""The video: frames that differ, an OpenGL from each source, and one message where there is none."""

import os
import subprocess
import sys
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

pytest.importorskip("mediapy")

import imageio_ffmpeg

from fes_mj.cli.app import run
from fes_mj.viewing import headless


def frames_of(path: Path) -> tuple[str, NDArray[np.uint8]]:
    """What ffmpeg says of a video, and its frames."""
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


def test_the_video_moves(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("fes_mj.viewing.render.FRAMES", 6)
    path = tmp_path / "out.mp4"
    assert run(["simulate", "r1", "-q", "--render", str(path)]) == 0
    about, frames = frames_of(path)
    assert "Video: h264" in about
    assert "yuv420p" in about  # what browsers play
    assert len(frames) == 12
    scene, panel = frames[0][:, :720], frames[0][:, 720:]
    moved = frames[3]
    assert np.mean(np.abs(moved[:, :720].astype(int) - scene) > 40) > 0.01  # legs
    assert np.mean(np.abs(moved[:, 720:].astype(int) - panel) > 40) > 0.0005  # cursor
    assert len(np.unique(scene.reshape(-1, 3), axis=0)) > 500  # a picture, not a blank


def test_without_opengl_there_are_numbers_and_one_message(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(headless, "_works", lambda _: False)
    monkeypatch.setattr(headless, "_WHEEL", "no-such-wheel")
    assert run(["simulate", "trt", "--render", str(tmp_path / "out.mp4")]) == 3
    captured = capsys.readouterr()
    assert "Dynamic and static agree" in captured.out
    assert captured.err.count("\n") == 1
    assert "pip install --no-deps" in captured.err
    assert not list(tmp_path.iterdir())


def test_without_the_video_packages_the_message_names_the_extra(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setitem(sys.modules, "mediapy", None)
    assert run(["simulate", "trt", "--render", str(tmp_path / "out.mp4")]) == 3
    assert "pip install 'fes-mj[video]'" in capsys.readouterr().err
    assert not list(tmp_path.iterdir())


@pytest.mark.skipif(sys.platform != "linux", reason="the wheel is for Linux")
def test_the_wheel_serves_where_the_system_has_nothing(tmp_path: Path) -> None:
    """In a process of its own, with every system backend refused."""
    try:
        version("lavavu-osmesa")
    except PackageNotFoundError:
        pytest.skip("the OSMesa wheel is not installed")
    script = (
        "import sys; from fes_mj.viewing import headless, render; headless._works = lambda _: False; "
        "render.FRAMES = 2; from fes_mj.cli.app import run; "
        "sys.exit(run(['simulate', 'd1', '-q', '--render', sys.argv[1]]))"
    )
    path = tmp_path / "out.mp4"
    clean = {key: value for key, value in os.environ.items() if key not in ("MUJOCO_GL", "PYOPENGL_PLATFORM")}
    done = subprocess.run([sys.executable, "-c", script, str(path)], capture_output=True, text=True, env=clean)
    assert (done.returncode, done.stderr) == (0, "")
    assert len(frames_of(path)[1]) == 4
