"""The video: frames that differ, its speed, and one message where its packages are missing."""

import sys
from pathlib import Path

import numpy as np
import pytest

import fes_mj
from fes_mj.cli.app import run
from tests.viewing.conftest import frames_of

pytest.importorskip("mediapy")
from fes_mj.viewing import render


@pytest.mark.process
def test_the_video_moves(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("fes_mj.viewing.render.LOOP", 0.2)
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
    assert np.abs(frames[:6].astype(int) - frames[6:]).max() == 0  # the second time is a copy


@pytest.mark.parametrize(("design", "speed"), [("trt", 1.0), ("d1", 1.0), ("d1", 0.5), ("d1", None)])
def test_the_video_turns_with_the_cadence(design: str, speed: float | None) -> None:
    """Turns per cadence times frames per second make the number of frames; the crank turns evenly between them."""
    case = fes_mj.Case(fes_mj.load_design(design), fes_mj.load_moments())
    rpm, rate = case.cadence * 60 / (2 * np.pi), render.FRAMES_PER_SECOND
    speed = speed or render.slow_motion(case.cadence)
    steps = render.steps_shown(case.simulation, speed)
    turns = 1 + int(np.sum(np.diff(steps) < 0))
    assert len(steps) == round(turns * 60 / rpm * rate / speed)
    assert turns == {"trt": 5, "d1": {1.0: 7, 0.5: 4}.get(speed, 1)}[design]  # in 4 s at 60.1 and 96.4 rpm
    angle = np.unwrap(case.simulation.crank_angle[steps])
    step = 2 * np.pi * rpm / 60 * speed / rate  # rad from frame to frame, but for the rounding of frames and of steps
    rounding = 0.5 * step / len(steps) + 1.001 * case.cadence * case.simulation.timestep
    assert np.diff(angle) == pytest.approx(step, abs=rounding)


def test_true_speed_tells_designs_apart_where_slow_motion_does_not() -> None:
    runs = {name: fes_mj.Case(fes_mj.load_design(name), fes_mj.load_moments()).simulation for name in ("trt", "d1")}
    turned = {}  # deg in ten frames
    for name, simulated in runs.items():
        for speed in (render.slow_motion(simulated.cadence), 1.0):
            angle = np.degrees(simulated.crank_angle[render.steps_shown(simulated, speed)])
            turned[name, speed == 1] = angle[10] - angle[0]
    assert turned["trt", False] == pytest.approx(360 * 10 / 120, abs=0.5)
    assert turned["d1", False] == pytest.approx(360 * 10 / 120, abs=0.5)
    assert turned["trt", True] == pytest.approx(360 * 60.13 / 60 / 3, rel=0.01)
    assert turned["d1", True] == pytest.approx(360 * 96.40 / 60 / 3, rel=0.01)


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["--speed", "1"], "Invalid values for group Video. --speed 1.0 needs --render."),
        *(
            (["--render", "v.mp4", "--speed", value], f"--speed is {value}; at 96.4 rpm it must be from 0.0104 to 6.23")
            for value in ("0", "nan", "1000")
        ),
    ],
)
def test_a_speed_that_nobody_can_watch_is_one_message(
    words: list[str], message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(["simulate", "d1", *words]) == 2
    error = capsys.readouterr().err
    assert error.startswith(f"fes_mj: {message}")
    assert error.count("\n") == 1


def test_without_the_video_packages_the_message_names_the_extra(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setitem(sys.modules, "mediapy", None)
    assert run(["simulate", "trt", "--render", str(tmp_path / "out.mp4")]) == 3
    assert "pip install 'fes-mj[video]'" in capsys.readouterr().err
    assert not list(tmp_path.iterdir())


@pytest.mark.process
@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")  # mediapy leaves the encoder's pipe
@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs /dev/full")
def test_a_full_disk_is_one_message(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """The encoder, a process of its own, meets it."""
    import mediapy

    class Full(mediapy.VideoWriter):
        def __init__(self, path: Path, *arguments: object, **options: object) -> None:
            super().__init__("/dev/full", *arguments, **options | {"ffmpeg_args": "-f mp4"})

    monkeypatch.setattr("fes_mj.viewing.render.LOOP", 0.1)
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


@pytest.mark.process
def test_a_ride_plays_in_true_time_and_the_road_passes(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("fes_mj.viewing.render.LONGEST", 0.5)
    path = tmp_path / "ride.mp4"
    assert run(["ride", "r1", "--drive", "moments", "--duration", "2", "-q", "--render", str(path)]) == 0
    about, frames = frames_of(path)
    assert "30 fps" in about
    assert len(frames) == 15  # half a second
    road = frames[:, 560:650, 20:700].astype(int)  # below the tricycle, above the key
    assert np.abs(road[1] - road[0]).mean() > 1  # 5 cm further, at tiles of half a metre
    assert np.abs(frames[-1, 15:60, 20:300].astype(int) - frames[0, 15:60, 20:300]).mean() < 1  # the speed stands still
