"""Muscles in a ride against what knows of none: statics of a turn, and their own equations along a motion."""

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import cumulative_simpson, solve_ivp

import fes_mj
from fes_mj.linkage import kinematics
from fes_mj.muscles.activation import trapezium
from fes_mj.muscles.contraction import force_velocity
from fes_mj.muscles.drive import Muscles
from fes_mj.muscles.prior import ramp
from fes_mj.muscles.pull import pull
from fes_mj.muscles.riders import load_riders
from fes_mj.riding.muscle_table import speed_factor
from fes_mj.riding.ride import Ride, Road, balancing_slope
from fes_mj.riding.stimulated import StimulatedRider, stimulated_rider
from fes_mj.riding.trace import Trace, ride as ride_by_equation
from fes_mj.simulation.road import ride_on_road
from fes_mj.statics.muscle_static import MuscleStatic

RIDERS = load_riders("p1p2").taken(slice(0, 8))
MUSCLES = Muscles(RIDERS)
SOLVERS = {"equation": ride_by_equation, "MuJoCo": lambda ride: ride_on_road(ride).trace}
# So heavy, and so little held back, that no leg changes its speed.
STEADY = Road(tricycle_mass=1e6, rolling_mass=0.0, rolling_resistance=0.0, drag_area=0.0)


@pytest.mark.parametrize("name", ["trt", "d1"])
@pytest.mark.parametrize("solver", SOLVERS)
def test_at_a_constant_crank_speed_muscles_give_what_statics_say(name: str, solver: str) -> None:
    """From the second turn on, when activations repeat; MuscleStatic knows whole degrees and the periodic answer."""
    design = fes_mj.load_design(name)
    cadence = float(design.linkage.cadence)
    rider, turns = stimulated_rider(MUSCLES, design), 3
    ride = Ride(design, rider, STEADY, "fixed", duration=turns * 2 * math.pi / cadence)
    trace = SOLVERS[solver](ride)
    turn = 2 * math.pi / cadence
    assert np.ptp(trace.crank_speed) < 1e-4 * cadence
    static = MuscleStatic.solve(design, RIDERS, cadence, "best")
    power = (trace.muscle_work[-1] - np.interp(trace.time[-1] - turn, trace.time, trace.muscle_work)) / turn
    assert power == pytest.approx(2 * static.powers[static.stimulated.most_probable], rel=2e-3)


def work(trace: Trace, rider: StimulatedRider) -> NDArray[np.floating]:
    """Work of all muscles since the start along the motion of a ride, J: activations by SciPy, forces by `pull`."""
    member, power = rider.riders, np.zeros(len(trace.time))
    rise, fall, delay = (float(values.item()) for values in (member["rise_s"], member.fall, member["delay_s"]))
    ahead = np.arctan(trace.crank_speed * rise) - np.arctan(rider.cadence * rise) - rider.cadence * delay
    for phase in (0.0, np.pi):
        angle = trace.crank_angle - phase
        pulled = pull(member, kinematics.solve(trace.ride.design, angle), trace.crank_speed)
        for group in range(3):
            on, width = (math.radians(values[group, 0, 0]) for values in (rider.windows.on, rider.windows.width))
            given = trapezium(angle + ahead - on, width, rider.cadence * ramp())

            def answering(time: float, active: NDArray[np.floating], given: NDArray[np.floating] = given) -> float:
                missing = float(np.interp(time, trace.time, given) - active[0])
                return missing / (rise if missing > 0 else fall)

            answer = solve_ivp(answering, trace.time[[0, -1]], [0.0], t_eval=trace.time, max_step=0.004, rtol=1e-7)
            power += answer.y[0] * pulled.power[group, 0, 0]
    return np.asarray(cumulative_simpson(power, x=trace.time, initial=0))


@pytest.mark.parametrize("solver", SOLVERS)
def test_muscles_do_what_their_equations_say(solver: str) -> None:
    """On a slope that slows the tricycle down until it rolls back, through speeds at which windows move."""
    design = fes_mj.load_design("trt")
    rider = stimulated_rider(MUSCLES, design)
    trace = SOLVERS[solver](Ride(design, rider, Road(slope=0.15), "fixed", launch=2.0, duration=2.5))
    assert trace.crank_speed[0] > 1.2 * rider.cadence
    assert trace.crank_speed[-1] < 0
    every = slice(None, None, max(1, len(trace.time) // 2500))
    columns = {name: getattr(trace, name)[every] for name in ("time", "crank_angle", "crank_speed", "muscle_work")}
    thinned = replace(trace, **columns)
    exact = work(thinned, rider)
    assert np.ptp(exact) > 10
    assert np.abs(thinned.muscle_work - exact).max() < 2e-3 * np.ptp(exact)


def test_a_slope_that_the_muscles_balance_is_ridden_at_that_speed() -> None:
    """Statics of the slope against a ride on it that has settled, without air."""
    design = fes_mj.load_design("trt")
    ride = Ride(
        design, stimulated_rider(MUSCLES, design), Road(drag_area=0.0, tricycle_mass=2000.0), "fixed", duration=20.0
    )
    trace = ride_by_equation(replace(ride, road=replace(ride.road, slope=balancing_slope(ride))))
    assert trace.mean_speed == pytest.approx(ride.launch, rel=5e-3)


def test_the_force_velocity_relation_is_that_of_the_turn() -> None:
    speeds = np.linspace(-2, 2, 401)
    assert [speed_factor(speed) for speed in speeds.tolist()] == pytest.approx(force_velocity(speeds), abs=1e-15)


def test_only_timings_with_windows_can_be_ridden() -> None:
    design = fes_mj.load_design("trt")
    measured = stimulated_rider(Muscles(RIDERS, "measured"), design)
    on, _ = measured.windows_deg["quadriceps"] or (None, None)
    static = MuscleStatic.solve(design, RIDERS, float(design.linkage.cadence), "measured").windows_deg
    assert static is not None
    assert static["quadriceps"] is not None
    assert on == static["quadriceps"][0]
    with pytest.raises(fes_mj.InputError, match="timing is 'by-angle'"):
        stimulated_rider(Muscles(RIDERS, "by-angle"), design)


def test_joints_beyond_the_muscles_lengths_are_refused() -> None:
    far = fes_mj.load_design("trt").with_linkage(seat_angle=math.radians(5))
    rider = stimulated_rider(MUSCLES, fes_mj.load_design("trt"))
    with pytest.raises(fes_mj.InputError, match=r"^trt: the (knee|hip) bends"):
        ride_by_equation(Ride(far, rider, duration=1.0))
