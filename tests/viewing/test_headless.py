"""An OpenGL from each source, and one message where there is none."""

import os
import subprocess
import sys
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

import pytest

from fes_mj.cli.app import run
from fes_mj.viewing import headless
from tests.viewing.conftest import frames_of

pytest.importorskip("mediapy")


def test_without_opengl_there_is_one_message_and_nothing_is_begun(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(headless, "_works", lambda _: False)
    monkeypatch.setattr(headless, "_WHEEL", "no-such-wheel")
    assert run(["simulate", "trt", "--render", str(tmp_path / "out.mp4")]) == 3
    captured = capsys.readouterr()
    assert not captured.out
    assert captured.err.count("\n") == 1
    assert "pip install --no-deps" in captured.err
    assert not list(tmp_path.iterdir())


@pytest.mark.process
@pytest.mark.skipif(sys.platform != "linux", reason="the wheel is for Linux")
def test_the_wheel_serves_where_the_system_has_nothing(tmp_path: Path) -> None:
    """In a process of its own, with every system backend refused."""
    try:
        version("lavavu-osmesa")
    except PackageNotFoundError:
        pytest.skip("the OSMesa wheel is not installed")
    script = (
        "import sys; from fes_mj.viewing import headless, render; headless._works = lambda _: False; "
        "render.LOOP = 0.1; from fes_mj.cli.app import run; "
        "sys.exit(run(['simulate', 'd1', '-q', '--render', sys.argv[1]]))"
    )
    path = tmp_path / "out.mp4"
    clean = {key: value for key, value in os.environ.items() if key not in ("MUJOCO_GL", "PYOPENGL_PLATFORM")}
    done = subprocess.run([sys.executable, "-c", script, str(path)], capture_output=True, text=True, env=clean)
    assert (done.returncode, done.stderr) == (0, "")
    assert len(frames_of(path)[1]) == 6


@pytest.mark.skipif(sys.platform != "linux", reason="other systems always have a screen")
def test_glfw_without_a_screen_does_not_count(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """It makes no context, says nothing, and fails only when something is drawn."""
    for name in ("DISPLAY", "WAYLAND_DISPLAY"):
        monkeypatch.delenv(name, raising=False)
    assert not headless._works("glfw")
