"""`fes_mj simulate --view` where there is no screen."""

import sys

import pytest

from fes_mj.cli.app import run


@pytest.mark.skipif(sys.platform != "linux", reason="other systems always have a screen")
@pytest.mark.parametrize("display", ["", ":99"])
def test_without_a_screen_there_is_one_message(
    display: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Also where a screen is named that does not answer."""
    monkeypatch.setenv("DISPLAY", display)
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    assert run(["simulate", "d1", "-q", "--view"]) == 3
    assert capsys.readouterr().err.startswith("fes_mj: the viewer needs a screen and there is none; make a video")
