"""What makes a gain comparable, on cases with known answers."""

import pytest

import fes_mj
from fes_mj.paper.gains import at_knee_speed
from fes_mj.paper.runs import joint_speed
from fes_mj.statics.turn import quasi_static


def test_equal_knee_speed_scales_power() -> None:
    result = quasi_static(fes_mj.load_design("d1"), fes_mj.load_moments("p1p2"))
    slowed = at_knee_speed(result, joint_speed(result, "knee")[0] / 2)
    assert slowed.power_mean == pytest.approx(result.power_mean / 2)
    assert joint_speed(slowed, "knee")[0] == pytest.approx(joint_speed(result, "knee")[0] / 2)
