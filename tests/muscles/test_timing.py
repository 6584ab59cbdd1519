import numpy as np
import pytest

from fes_mj.linkage.design_file import load_design
from fes_mj.muscles.power import best_turn
from fes_mj.muscles.prior import ramp
from fes_mj.muscles.riders import Riders
from fes_mj.muscles.timing import DUTY, TURN_ANGLES, WINDOW_STEP, Windows, activation, widths_up_to

DESIGN = load_design("d1")
CADENCE = DESIGN.linkage.cadence
ONS = np.arange(0.0, 360, WINDOW_STEP)


def changed(riders, **values):
    constant = {name: np.full(len(riders), value) for name, value in values.items()}
    return Riders(riders.name, riders.values | constant, riders.likelihood)


def every_power(pulled, riders, width):
    """Power of each group, W, shape (groups, members, 72), by every window of a width, each solved by itself."""
    solved = activation(Windows(ONS[:, None, None], np.full((len(ONS), 1, 1), width)), riders, CADENCE)
    return np.einsum("oma,gma->gmo", solved[:, :, 0], pulled.power[:, :, 0]) / solved.shape[-1]


@pytest.mark.parametrize("each_its_own", [False, True])
def test_no_other_window_of_any_width_is_better(riders, each_its_own):
    turn, windows = best_turn(riders, DESIGN, each_its_own=each_its_own)
    powers = [every_power(turn.pulled, riders, width) for width in (40.0, 85.0, 95.0, 100.0)]
    if not each_its_own:
        powers = [power.mean(axis=1, keepdims=True) for power in powers]
    others = np.max(powers, axis=(0, 3))
    chosen = np.mean(turn.activation * turn.pulled.power, axis=-1)[..., 0]
    chosen = chosen if each_its_own else chosen.mean(axis=1, keepdims=True)
    stimulated = windows.width[..., 0] > 0
    assert np.all((chosen - others)[stimulated] >= -1e-5 * others[stimulated])  # chosen in single precision
    assert np.all(windows.width <= 360 * DUTY)
    assert np.all(windows.on % WINDOW_STEP == 0)


def test_a_share_is_taken_to_the_nearest_degree():
    for share, widest in ((0.222, 80), (0.22, 75), (DUTY, 100), (1, 360)):
        assert widths_up_to(share)[-1] == widest


def test_equal_times_are_a_mean_with_the_adjoint(riders):
    """Power of any stimulation: that of the stimulation itself on what the filter's adjoint makes of the muscle."""
    alike = changed(riders, fall_per_rise=1.0)
    turn, windows = best_turn(alike, DESIGN)
    order = np.arange(181) * CADENCE
    shift = np.exp(-1j * order * alike["delay_s"]) / (1 + 1j * order * alike["rise_s"])
    adjoint = np.fft.irfft(np.fft.rfft(turn.pulled.power) * np.conj(shift), 360)
    stimulation = windows.at(TURN_ANGLES[None, None], CADENCE * ramp())
    exact = np.mean(stimulation * adjoint, axis=-1)
    solved = np.mean(turn.activation * turn.pulled.power, axis=-1)
    assert solved == pytest.approx(exact, rel=2e-3, abs=1e-3 * float(np.abs(exact).max()))


def test_delay_is_confounded_with_the_on_angle(riders):
    step = np.radians(WINDOW_STEP) / CADENCE
    early, late = (best_turn(changed(riders, delay_s=n * step), DESIGN)[1] for n in (1, 3))
    assert (early.on - late.on) % 360 == pytest.approx(2 * WINDOW_STEP)
    assert early.width == pytest.approx(late.width)


def test_groups_that_give_nothing_are_not_stimulated(riders):
    weak = changed(riders, gluteus_strength=1e-4)
    turn, windows = best_turn(weak, DESIGN, duty=0.2)
    assert windows.width[2] == 0
    assert not turn.activation[2].any()
    assert 0 < windows.width[0] <= 70
