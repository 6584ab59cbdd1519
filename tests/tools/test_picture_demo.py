"""Committed pictures: README's is a frame of today's video, and `make pictures` makes all there are."""

from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).parents[2]
# glob -> what of `make pictures` writes them
MADE = {
    "docs/images/d1.png": "tools.picture_demo",
    "docs/images/explore.png": "tools.picture_explore",
    "mjcf/*/*.png": "tools/make_models.py --pictures",
    "results/figures/*.png": "reproduce",
    "results/muscles-*.png": "studies.muscles",
    "results/published.png": "studies.published",
    "results/ride-environment.png": "studies.ride_env",
    "results/optimization/ripple.png": "studies.ripple --picture",
}


def test_readmes_picture_is_a_frame_of_todays_video() -> None:
    pytest.importorskip("mediapy")
    from PIL import Image

    from tools.picture_demo import PICTURE, frame

    kept, today = (picture.astype(float) for picture in (np.asarray(Image.open(PICTURE)), frame()))
    assert kept.shape == today.shape == (720, 1280, 3)
    # OpenGL drivers may differ along edges; the next frame differs by 0.6
    assert np.abs(kept - today).mean() < 0.5, "run `make pictures`"


def test_one_command_makes_every_picture() -> None:
    there = {path for folder in ("docs/images", "mjcf", "results") for path in (ROOT / folder).rglob("*.png")}
    assert there == {path for pattern in MADE for path in ROOT.glob(pattern)}
    recipe = (ROOT / "Makefile").read_text().partition("\npictures:")[2].partition("\n\n")[0]
    assert all(maker in recipe for maker in MADE.values())
