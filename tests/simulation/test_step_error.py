"""The closed form of the time step's error against the simulation itself."""

import math

import numpy as np
import pytest

import fes_mj
from fes_mj.crosscheck.turn_case import Case
from fes_mj.simulation.time_step import predicted_errors


@pytest.mark.parametrize("name", ["trt", "r2", "d1", "d2"])
@pytest.mark.parametrize("steps", [720, 1440])
def test_the_predicted_error_is_the_measured_one(name: str, steps: int) -> None:
    """Power curve and loop gap, from the closed form and from MuJoCo, of legs that hang: it knows no joint moments."""
    design, still = fes_mj.load_design(name), np.zeros(2)
    cadence = design.linkage.cadence
    idle = fes_mj.JointMoments("idle", np.array([0.0, 3.0]), still, still)
    case = Case(design, idle, timestep=2 * math.pi / cadence / steps)
    predicted = predicted_errors(design, cadence, 2 * math.pi / steps)
    assert len(case.simulation.crank_angle) == steps
    assert case.rms_per_leg(case.simulation) == pytest.approx(predicted.inverse_dynamics, rel=0.02)
    assert case.simulation.loop_gap_max == pytest.approx(predicted.loop_gap, rel=0.02)


def test_errors_are_of_second_order() -> None:
    coarse, fine = (predicted_errors(fes_mj.load_design("d1"), 10.0, 2 * np.pi / n) for n in (4000, 8000))
    assert np.divide(coarse, fine) == pytest.approx(4, rel=0.01)
