"""The video of a ride: in true time, on a road that passes."""

from pathlib import Path

import numpy as np
import pytest

from fes_mj.cli.app import run
from tests.viewing.conftest import frames_of

pytest.importorskip("mediapy")


@pytest.mark.process
def test_it_plays_in_true_time_and_the_road_passes(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("fes_mj.viewing.render.LONGEST", 0.5)
    path = tmp_path / "ride.mp4"
    assert run(["ride", "r1", "--duration", "2", "-q", "--render", str(path)]) == 0
    about, frames = frames_of(path)
    assert "30 fps" in about
    assert len(frames) == 15  # half a second
    road = frames[:, 560:650, 20:700].astype(int)  # below the tricycle, above the key
    assert np.abs(road[1] - road[0]).mean() > 1  # 5 cm further, at tiles of half a metre
    assert np.abs(frames[-1, 15:60, 20:300].astype(int) - frames[0, 15:60, 20:300]).mean() < 1  # the speed stands still
