import numpy as np
import pytest
from scipy.integrate import solve_ivp

from fes_mj.muscles.activation import periodic_activation, trapezium

ANGLE = np.linspace(0, 2 * np.pi, 360, endpoint=False)
WIDTH, RAMP, TURN = np.radians(100), np.radians(27), 1.0


def test_trapezium_has_the_area_of_its_middle_width_and_begins_at_the_on_angle():
    dense = np.linspace(0, 2 * np.pi, 100_000, endpoint=False)
    assert 2 * np.pi * trapezium(dense - 3.0, WIDTH, RAMP).mean() == pytest.approx(WIDTH - RAMP, abs=1e-6)
    assert not trapezium(np.array([-0.01, WIDTH + 0.01]), WIDTH, RAMP).any()
    assert trapezium(RAMP / 2, WIDTH, RAMP) == pytest.approx(0.5)
    assert trapezium(WIDTH / 8, WIDTH / 4, RAMP) == pytest.approx(WIDTH / 8 / RAMP)  # too short to get to the top
    assert not trapezium(ANGLE, 0.0, RAMP).any()


def test_equal_times_filter_every_harmonic():
    """Exact for one constant: the answer to e^(ikt) is e^(ikt) / (1 + ik w tau)."""
    wave, constant = 0.5 + 0.4 * np.cos(3 * ANGLE), 0.07
    exact = 0.5 + (0.4 * np.exp(3j * ANGLE) / (1 + 3j * 2 * np.pi / TURN * constant)).real
    assert periodic_activation(wave, TURN, constant, constant) == pytest.approx(
        exact, abs=3e-4
    )  # linear between the angles
    finer = np.linspace(0, 2 * np.pi, 7200, endpoint=False)
    exact = 0.5 + (0.4 * np.exp(3j * finer) / (1 + 3j * 2 * np.pi / TURN * constant)).real
    assert periodic_activation(0.5 + 0.4 * np.cos(3 * finer), TURN, constant, constant) == pytest.approx(
        exact, abs=1e-6
    )


def test_slower_fall_is_the_differential_equation():
    rise, fall = 0.05, 0.09

    def change(time, activation):
        goal = trapezium(2 * np.pi * time / TURN, WIDTH, RAMP)
        return (goal - activation) / np.where(goal > activation, rise, fall)

    times = 2 + ANGLE / (2 * np.pi)
    exact = solve_ivp(change, (0, 3), [0.0], t_eval=times, max_step=2e-3, rtol=1e-6, atol=1e-8).y[0]
    assert periodic_activation(trapezium(ANGLE, WIDTH, RAMP), TURN, rise, fall) == pytest.approx(exact, abs=2e-3)


def test_turn_ends_where_it_began_and_answers_shift_with_their_windows():
    windows = np.stack([trapezium(ANGLE - shift, WIDTH, RAMP) for shift in np.radians([0.0, 75.0])])
    first, second = periodic_activation(windows, TURN, 0.05, np.array([0.1, 0.1]))
    assert second == pytest.approx(np.roll(first, 75), abs=1e-6)


def test_many_cases_are_answered_as_alone():
    """In blocks, and from a start that is far away."""
    random = np.random.default_rng(3)
    rise, fall = random.uniform([[0.02], [0.1]], [[0.1], [0.4]], (2, 2500))
    stimulation = trapezium(ANGLE[::12] - random.uniform(0, 6, (2500, 1)), 1.5, 0.3)
    together = periodic_activation(stimulation, 0.6, rise, fall, start=1.0)
    for case in (0, 2047, 2048, 2499):
        alone = periodic_activation(stimulation[case], 0.6, rise[case], fall[case])
        assert together[case] == pytest.approx(alone, abs=2e-7)
