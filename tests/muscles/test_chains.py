"""Chains of riders: they stay in a posterior, and find the way into one."""

import numpy as np
import pytest

from fes_mj.linkage import kinematics
from fes_mj.moments.reference_tricycle import PAPER_TRICYCLE
from fes_mj.moments.uncertainty import power_weights
from fes_mj.muscles.chains import moved
from fes_mj.muscles.identification import WHOLE, Measured
from fes_mj.muscles.power import muscle_turn
from fes_mj.muscles.prior import normal_score, prior_draws, priors, quantile
from fes_mj.muscles.riders import Riders
from fes_mj.muscles.rules import trial_windows

POWER = power_weights(kinematics.solve(PAPER_TRICYCLE.design), PAPER_TRICYCLE.cadence, PAPER_TRICYCLE)


def measured_power(value, deviation):
    return Measured(POWER[None], np.array([WHOLE]), np.array([value]), np.array([[deviation**2]]))


@pytest.fixture(scope="module")
def many():
    return Riders("prior", prior_draws(300, np.random.default_rng(1)), np.zeros(300))


def test_scores_are_the_inverse_of_quantiles():
    scores = np.array([-2.0, -0.3, 0.4, 1.9])
    for name in priors():
        if name != "passive_included":
            assert normal_score(name, quantile(name, scores)) == pytest.approx(scores)
        values = quantile(name, scores)
        assert quantile(name, normal_score(name, values)) == pytest.approx(values)


def test_chains_stay_in_the_prior_where_nothing_was_measured(many):
    """A power known to 1 kW says nothing: means and spreads of all that is drawn stay within their error."""
    after = moved(many, measured_power(0.0, 1000.0), np.random.default_rng(2), 10)
    assert np.mean(after.values["rise_s"] != many.values["rise_s"]) > 0.9
    for name in ("rise_s", "max_speed", "quadriceps_on_deg", "residual_loss_W"):
        before = normal_score(name, after.values[name])
        assert abs(before.mean()) < 4 / np.sqrt(len(many))
        assert before.std() == pytest.approx(1, abs=0.2)


def test_chains_find_what_was_measured(many):
    """A power of 40 W, larger than nearly all of the prior's."""
    few = many.taken(slice(0, 60))
    after = moved(few, measured_power(40.0, 1.0), np.random.default_rng(3), 20)
    design = PAPER_TRICYCLE.design
    turn = muscle_turn(after, design, PAPER_TRICYCLE.cadence, trial_windows(after, design))
    power = turn.power_mean[:, 0] - after.values["residual_loss_W"]
    assert np.median(power) == pytest.approx(40, abs=3)
