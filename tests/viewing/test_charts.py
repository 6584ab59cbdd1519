"""Charts: curves over a turn."""

import numpy as np
import pytest

pytest.importorskip("matplotlib")

import fes_mj
from fes_mj.viewing.charts import over_turn, page_axes, page_svg, plot_power, plot_residual


def test_a_turn_in_any_order_is_drawn_from_end_to_end() -> None:
    angle = np.radians(np.arange(100.0, 460.0))
    degrees, curve = over_turn(angle, np.cos(angle))
    assert degrees == pytest.approx(np.arange(361))
    assert curve == pytest.approx(np.cos(np.radians(degrees)))


def test_power_and_residual_of_a_case_close_and_the_residual_is_that_of_the_check() -> None:
    case = fes_mj.Case(fes_mj.load_design("d1"), fes_mj.load_moments())
    figure, (power, residual) = page_axes("D1", rows=(3, 1))
    plot_power(power, case)
    plot_residual(residual, case)
    curves = [np.array(line.get_data()) for axes in (power, residual) for line in axes.lines]
    curves = [curve for curve in curves if curve.shape[1] > 2]
    assert len(curves) == 4
    for angle, value in curves:
        assert (angle[-1] - angle[0], value[-1]) == pytest.approx((360, value[0]))
    missed = curves[-1][1][:-1] / 1e3
    check = next(check for check in case.checks if check.name == "inverse_dynamics")
    assert np.sqrt(np.mean(missed**2)) == pytest.approx(check.value, rel=0.02)  # every nth step
    assert page_svg(figure, power).count("exact, mW") == 1
