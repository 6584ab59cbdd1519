"""A run that breaks down says so, and leaves no log behind."""

from pathlib import Path

import numpy as np
import pytest

import fes_mj
from fes_mj.common.errors import UnstableError
from fes_mj.linkage.legs import ONE_LEG
from fes_mj.moments.torque_map import torque_map
from fes_mj.simulation.mjcf import build_mjcf
from fes_mj.simulation.stepping import Sensors, feedback_loop, run_loop


def test_a_run_that_breaks_down_says_so(
    smooth_moments: fes_mj.JointMoments, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    huge = fes_mj.JointMoments("huge", smooth_moments.crank_angle, 1e13 * smooth_moments.knee, smooth_moments.hip)
    with pytest.raises(UnstableError, match=r"d1: .* 0\.216 ms"):
        fes_mj.simulate(fes_mj.load_design("d1"), huge)
    assert not list(tmp_path.iterdir())  # MuJoCo's own log stays out of the user's folder


def test_speed_is_the_slope_of_the_angle(smooth_moments: fes_mj.JointMoments) -> None:
    """Of the step before and the step after together: MuJoCo's own speed is that of the step before alone."""
    model = build_mjcf(fes_mj.load_design("d1")).compile()
    loop = feedback_loop(torque_map(smooth_moments), ONE_LEG)
    rows, step = Sensors(model, run_loop(model, loop, 400).sensors), model.opt.timestep
    for joint in rows.joints:
        angle = rows[f"{joint}_angle"]
        rounding = 4 * np.finfo(float).eps * np.abs(angle).max() / step  # rad/s
        assert rows.speed(joint) == pytest.approx((angle[2:] - angle[:-2]) / (2 * step), rel=0, abs=rounding)
        assert rows[f"{joint}_speed"][1:-1] == pytest.approx((angle[1:-1] - angle[:-2]) / step, rel=0, abs=rounding)
