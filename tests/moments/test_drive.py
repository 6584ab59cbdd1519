"""What both solvers of a ride share, against its definition: the moment by crank angle.

On the tricycle of the measurement, where the moment at a crank angle is the one that was measured there.
"""

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import cumulative_simpson

import fes_mj
from fes_mj.linkage import kinematics
from fes_mj.moments.reference_tricycle import PAPER_TRICYCLE
from fes_mj.riding.ride import Ride
from fes_mj.riding.trace import Trace, ride as ride_by_equation
from fes_mj.simulation.road import ride_on_road

TURN = np.linspace(0, 2 * np.pi, 14401)


def work(trace: Trace, moments: fes_mj.JointMoments) -> NDArray[np.floating]:
    """Work of all joint moments since the start along the motion of a ride, J."""
    motion = kinematics.solve(PAPER_TRICYCLE.design, TURN)
    power = np.zeros(len(trace.time))
    from_top = (TURN - PAPER_TRICYCLE.top_dead_centre) % (2 * np.pi)
    for phase in (0.0, np.pi):
        for joint, samples in (("knee", moments.knee), ("hip", moments.hip)):
            measured = np.interp(from_top, moments.crank_angle, samples, period=2 * np.pi)
            virtual = measured * motion.joint_rate[joint]
            power += trace.crank_speed * np.interp(trace.crank_angle - phase, TURN, virtual, period=2 * np.pi)
    return np.asarray(cumulative_simpson(power, x=trace.time, initial=0))


@pytest.mark.parametrize("solver", ["equation", "MuJoCo"])
def test_moments_are_what_they_are_defined_to_be(solver: str, smooth_moments: fes_mj.JointMoments) -> None:
    ride = Ride(PAPER_TRICYCLE.design, smooth_moments, transmission="fixed", launch=2.5, duration=3.0)
    trace = ride_by_equation(ride) if solver == "equation" else ride_on_road(ride).trace
    exact = work(trace, smooth_moments)
    assert np.ptp(exact) > 50
    assert np.abs(trace.muscle_work - exact).max() < 1e-3 * np.ptp(exact)
