"""What makes a gain comparable, on cases with known answers."""

import numpy as np
import pytest

import fes_mj
from fes_mj.paper.gains import at_knee_speed, energy_swing
from fes_mj.paper.runs import joint_speed
from fes_mj.statics import quasi_static


def test_equal_knee_speed_scales_power() -> None:
    result = quasi_static(fes_mj.load_design("d1"), fes_mj.load_moments("p1p2"))
    slowed = at_knee_speed(result, joint_speed(result, "knee")[0] / 2)
    assert slowed.power_mean == pytest.approx(result.power_mean / 2)
    assert joint_speed(slowed, "knee")[0] == pytest.approx(joint_speed(result, "knee")[0] / 2)


def test_energy_swing_of_a_sine() -> None:
    """The integral of A sin(wt) swings by 2 A / w."""
    angle = np.linspace(0, 2 * np.pi, 3600, endpoint=False)
    assert energy_swing(10 + 4 * np.sin(angle), 5.0) == pytest.approx(2 * 4 / 5.0, rel=1e-3)
