"""The video: frames that differ, and one message where its packages are missing."""

import sys
from pathlib import Path

import numpy as np
import pytest

from fes_mj.cli.app import run
from tests.viewing.conftest import frames_of

pytest.importorskip("mediapy")


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


def test_without_the_video_packages_the_message_names_the_extra(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setitem(sys.modules, "mediapy", None)
    assert run(["simulate", "trt", "--render", str(tmp_path / "out.mp4")]) == 3
    assert "pip install 'fes-mj[video]'" in capsys.readouterr().err
    assert not list(tmp_path.iterdir())


@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")  # mediapy leaves the encoder's pipe
@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs /dev/full")
def test_a_full_disk_is_one_message(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """The encoder, a process of its own, meets it."""
    import mediapy

    class Full(mediapy.VideoWriter):
        def __init__(self, path: Path, *arguments: object, **options: object) -> None:
            super().__init__("/dev/full", *arguments, ffmpeg_args="-f mp4", **options)

    monkeypatch.setattr("fes_mj.viewing.render.FRAMES", 2)
    monkeypatch.setattr(mediapy, "VideoWriter", Full)
    assert run(["simulate", "d1", "-q", "--render", str(tmp_path / "v.mp4")]) == 2
    error = capsys.readouterr().err
    assert error.startswith(f"fes_mj: {tmp_path}/v.mp4: cannot be written: the encoder stopped: ")
    assert error.count("\n") == 1
    assert not [*tmp_path.iterdir()]


def test_without_ffmpeg_the_message_names_the_extra(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    import imageio_ffmpeg

    def missing() -> str:
        raise RuntimeError("No ffmpeg exe could be found.")

    monkeypatch.setattr(imageio_ffmpeg, "get_ffmpeg_exe", missing)
    assert run(["simulate", "d1", "-q", "--render", str(tmp_path / "v.mp4")]) == 3
    assert "there is no ffmpeg; it comes with: pip install 'fes-mj[video]'" in capsys.readouterr().err
