import numpy as np
import pytest

from fes_mj.linkage.design_file import load_design
from fes_mj.muscles.recovery import gains, held
from tools.fit_muscles import measured

DESIGNS = [load_design(name) for name in ("r1", "r2", "d1", "d2")]


def test_gains_are_one_for_the_base_itself(riders):
    trt = load_design("trt")
    assert gains(riders, [trt], trt) == pytest.approx(np.ones((1, len(riders))))
    known = gains(riders, DESIGNS[2:3], trt, actual=riders.taken([3]))
    assert known[0, 0] == pytest.approx(gains(riders, DESIGNS[2:3], trt)[0, 3])


@pytest.mark.long
def test_intervals_of_80_percent_hold_the_truth_in_70_to_90_percent():
    share = held(measured("p1p2"), DESIGNS, load_design("trt"), riders=50, candidates=1000, seed=5)
    assert 0.7 <= share.mean() <= 0.9
