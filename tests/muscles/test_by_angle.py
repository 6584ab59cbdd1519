import numpy as np
import pytest

from fes_mj.linkage.design_file import load_design
from fes_mj.muscles.by_angle import null_test
from fes_mj.muscles.prior import prior_draws
from fes_mj.muscles.riders import Riders


def test_rule_gives_the_measured_tricycle_back_and_makes_gains_for_riders_who_have_less():
    riders = Riders("known", prior_draws(60, np.random.default_rng(7)), np.zeros(60))
    gains = null_test(riders, [load_design(name) for name in ("trt", "r1", "r2", "d1", "d2")])
    assert gains.true[0] == pytest.approx(1, rel=1e-9)
    assert gains.by_angle[0] == pytest.approx(1, abs=2e-3)  # moments are read between whole degrees
    truth, said = (np.median(gain[1:], axis=1) for gain in gains)
    assert (said > truth).all()
    # an able rule would put riders in the right order; this one hardly knows who gains
    correlation = [np.corrcoef(*pair)[0, 1] for pair in zip(gains.true[1:], gains.by_angle[1:], strict=True)]
    assert max(correlation) < 0.5
