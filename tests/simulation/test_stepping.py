"""A run that breaks down says so, and leaves no log behind."""

from pathlib import Path

import pytest

import fes_mj
from fes_mj.common.errors import UnstableError


def test_a_run_that_breaks_down_says_so(
    smooth_moments: fes_mj.JointMoments, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    huge = fes_mj.JointMoments("huge", smooth_moments.crank_angle, 1e13 * smooth_moments.knee, smooth_moments.hip)
    with pytest.raises(UnstableError, match=r"d1: .* 0\.216 ms"):
        fes_mj.simulate(fes_mj.load_design("d1"), huge)
    assert not list(tmp_path.iterdir())  # MuJoCo's own log stays out of the user's folder
