"""Force that falls with activation, against the equation solved over every turn."""

import numpy as np
import pytest

from fes_mj.linkage.design_file import load_design
from fes_mj.muscles.fatigue import FALL, FLOOR, RECOVERY, force_factor, power_over_time, recovery_for
from fes_mj.muscles.power import best_turn


def test_the_mean_activation_of_a_turn_stands_for_its_course():
    """Activation 0.3 s on and 0.7 s off, the equation solved exactly in every phase of three minutes."""
    factor, course = 1.0, []
    for _ in range(180):
        factor = FLOOR + (factor - FLOOR) * np.exp(-0.3 / FALL)
        factor = 1 + (factor - 1) * np.exp(-0.7 / RECOVERY)
        course.append(factor)
    assert force_factor(0.3, np.arange(1.0, 181)) == pytest.approx(np.array(course), abs=0.005)


def test_ends_of_fatigue():
    assert force_factor(np.array([0.0, 0.4, 1.0]), 0.0) == pytest.approx(1)
    assert force_factor(0.0, 1e6) == pytest.approx(1)
    assert force_factor(1.0, 1e6) == pytest.approx(FLOOR)
    assert force_factor(0.5, 1e6, recovery_for(0.33, 0.5)) == pytest.approx(0.33)


def test_power_is_the_groups_by_their_factors(riders):
    turn, _ = best_turn(riders, load_design("trt"))
    fresh, tired = power_over_time(turn, np.array([0.0, 1800.0]))
    assert fresh == pytest.approx(turn.power_mean)
    factor = force_factor(turn.activation.mean(axis=-1), 1800.0)
    assert tired == pytest.approx(np.sum(factor * turn.group_power, axis=0))
    assert np.all(tired < fresh)
