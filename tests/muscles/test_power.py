import numpy as np
import pytest

from fes_mj.linkage import kinematics
from fes_mj.linkage.design_file import load_design
from fes_mj.muscles.power import best_power, best_turn
from fes_mj.muscles.timing import TURN_ANGLES


def test_batch_is_each_of_its_designs_and_none_for_what_cannot_turn(riders):
    design = load_design("d1")
    cranks = design.linkage.crank * np.array([[0.98], [1.0], [3.0]])
    gears = np.array([[2.0], [design.linkage.gear_ratio], [2.0]])
    batch = best_power(riders, design.with_linkage(crank=cranks, gear_ratio=gears))
    alone, _ = best_turn(riders, design)
    assert batch[1] == pytest.approx(alone.power_mean.mean(), rel=1e-5)  # windows are chosen in single precision
    assert np.isfinite(batch).tolist() == [True, True, False]


def test_joints_do_the_work_of_the_muscles_and_two_legs_are_half_a_turn_apart(riders):
    design = load_design("trt")
    turn, _ = best_turn(riders, design)
    rates = kinematics.solve(design, TURN_ANGLES).joint_rate
    joints = design.linkage.cadence * (turn.moment.knee * rates.knee + turn.moment.hip * rates.hip)
    assert joints == pytest.approx(turn.power, abs=1e-11)
    assert turn.two_legs == pytest.approx(turn.power + np.roll(turn.power, 180, axis=-1))
