import numpy as np
import pytest

from fes_mj.muscles.contraction import CURVATURE, PLATEAU, force_length, force_velocity, tension

MUSCLE = {"optimal": 0.1, "slack": 0.3, "pennation": 0.3, "max_speed": 8.0}


def test_force_at_rest_at_largest_speed_and_far_beyond():
    assert force_velocity(np.array([0.0, 1.0, 2.0, -1.0, -3.0])) == pytest.approx([1, 0, 0, PLATEAU, PLATEAU])
    assert force_length(np.array([1.0, 1.45, 0.55])) == pytest.approx([1, np.exp(-1), np.exp(-1)])


def test_shortening_follows_hills_hyperbola():
    speed = np.linspace(0, 1, 11)
    assert (force_velocity(speed) + CURVATURE) * (speed + CURVATURE) == pytest.approx(CURVATURE * (1 + CURVATURE))


def test_lengthening_is_steeper_than_shortening():
    step = np.array([1e-9])
    shorter, longer = (1 - force_velocity(step)) / step, (force_velocity(-step) - 1) / step
    assert shorter == pytest.approx(5.0, rel=1e-6)  # 1 + 1 / CURVATURE
    assert longer == pytest.approx(0.4 * (1 + 30.24), rel=1e-6)


def test_slack_muscle_pulls_with_nothing():
    force, _ = tension(np.array([0.25, 0.3]), np.zeros(2), **MUSCLE)
    assert force == pytest.approx([0, 0])


def test_fibres_do_the_work_that_the_tendon_does():
    seconds = np.linspace(0, 1, 20001)
    length, speed = 0.39 + 0.02 * np.sin(5 * seconds), 0.1 * np.cos(5 * seconds)
    force, cosine = tension(length, speed, **MUSCLE)
    fibre = np.hypot(length - 0.3, 0.1 * np.sin(0.3))  # constant thickness
    fibre_speed = np.gradient(fibre, seconds, edge_order=2)
    assert force / cosine * fibre_speed == pytest.approx(force * speed, abs=1e-7)
