"""What both solvers of a ride share, against its definitions: command by crank angle, lag, Hill's relation.

On the tricycle of the measurement, where the moment at a crank angle is the one that was measured there.
"""

import tomllib
from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import cumulative_simpson, solve_ivp

import fes_mj
from fes_mj.common.reading import DATA
from fes_mj.linkage import kinematics
from fes_mj.moments.reference_tricycle import PAPER_TRICYCLE
from fes_mj.moments.torque_velocity import load_torque_velocity
from fes_mj.riding.ride import Ride
from fes_mj.riding.trace import Trace, ride as ride_by_equation
from fes_mj.simulation.road import ride_on_road

TRICYCLE, CADENCE = PAPER_TRICYCLE.design, PAPER_TRICYCLE.cadence
HILL = tomllib.loads((DATA / "torque_velocity.toml").read_text(encoding="utf-8"))["hill"]
TURN = np.linspace(0, 2 * np.pi, 14401)

Curve = NDArray[np.floating]


def hill(moment: Curve, speed: Curve, joint: str) -> Curve:
    """Moment per moment at rest: (1 - v) / (1 + v / k) in shortening, a hyperbola to the plateau in lengthening."""
    v, k = np.sign(moment) * speed / HILL["max_speed_rad_s"][joint], HILL["curvature"]
    excess = HILL["eccentric_plateau"] - 1
    longer = -np.minimum(v, 0) * (1 + 1 / k)  # the same slope at rest
    return np.where(v >= 0, (1 - v) / (1 + v / k), 1 + excess * longer / (excess + longer))


def work(trace: Trace, moments: fes_mj.JointMoments, lag: float, relation: bool) -> Curve:
    """Work of all muscles since the start along the motion of a ride, J."""
    motion = kinematics.solve(TRICYCLE, TURN)
    power = np.zeros(len(trace.time))
    ahead = np.arctan(trace.crank_speed * lag) - np.arctan(CADENCE * lag)
    for phase in (0.0, np.pi):
        for joint, samples in (("knee", moments.knee), ("hip", moments.hip)):
            rate = motion.joint_rate[joint]
            from_top = (TURN - PAPER_TRICYCLE.top_dead_centre) % (2 * np.pi)
            measured = np.interp(from_top, moments.crank_angle, samples, period=2 * np.pi)
            if relation:
                measured = measured / hill(measured, CADENCE * rate, joint)
            command = measured + lag * CADENCE * np.gradient(measured, TURN)
            angle = trace.crank_angle - phase
            given = np.interp(angle + ahead, TURN, command, period=2 * np.pi)
            if lag:
                answer = solve_ivp(
                    lambda t, a, given=given: (np.interp(t, trace.time, given) - a) / lag,
                    (0, trace.time[-1]),
                    given[:1],
                    t_eval=trace.time,
                    max_step=0.005,
                    rtol=1e-8,
                ).y[0]
            else:
                answer = given
            speed = trace.crank_speed * np.interp(angle, TURN, rate, period=2 * np.pi)
            power += answer * speed * (hill(answer, speed, joint) if relation else 1.0)
    return cumulative_simpson(power, x=trace.time, initial=0)


@pytest.mark.parametrize("solver", ["equation", "MuJoCo"])
@pytest.mark.parametrize(("lag", "relation"), [(0.0, False), (0.0, True), (0.1, True)])
def test_muscles_do_what_they_are_defined_to_do(
    lag: float, relation: bool, solver: str, smooth_moments: fes_mj.JointMoments
) -> None:
    moments = replace(smooth_moments, torque_velocity=load_torque_velocity("hill") if relation else None)
    ride = Ride(TRICYCLE, moments, transmission="fixed", lag=lag, launch=2.5, duration=3.0)
    trace = ride_by_equation(ride) if solver == "equation" else ride_on_road(ride).trace
    exact = work(trace, smooth_moments, lag, relation)
    assert np.ptp(exact) > 50
    assert np.abs(trace.muscle_work - exact).max() < 1e-3 * np.ptp(exact)
