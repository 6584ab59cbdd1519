"""The reduced equation of motion: against inverse dynamics, conserved energy, exact rests, and itself refined."""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import fes_mj
from fes_mj.linkage import kinematics
from fes_mj.linkage.inertia import GRAVITY
from fes_mj.linkage.legs import TWO_LEGS
from fes_mj.moments.drive import DRIVE_POINTS
from fes_mj.moments.torque_map import torque_map
from fes_mj.riding.differences import speed_difference
from fes_mj.riding.leg_table import CELL_TOLERANCE, STEP_TOLERANCE, LegTable, leg_table
from fes_mj.riding.lookup import place
from fes_mj.riding.ride import Ride, Road, balancing_slope, steady_ripple
from fes_mj.riding.solver import lowest
from fes_mj.riding.trace import ride as solved
from fes_mj.statics.equilibrium import crank_moment

NOTHING = Road(rolling_resistance=0.0, drag_area=0.0)


class HeldStill(Ride):
    """Its legs do not recoil."""

    @property
    def table(self) -> LegTable:
        table = super().table
        return table._replace(masses=table.masses._replace(recoil=0 * table.masses.recoil))


@pytest.fixture
def no_moments() -> fes_mj.JointMoments:
    return fes_mj.JointMoments("none", np.array([0.0, 3.0]), np.zeros(2), np.zeros(2))


def test_the_table_is_the_inverse_dynamics(design: fes_mj.Design, no_moments: fes_mj.JointMoments) -> None:
    """At constant crank speed the crank takes -(dI/da w^2 / 2 + g dy/da), which inverse dynamics finds by loads."""
    masses, speed = leg_table(design, no_moments).masses, 9.0
    angle = np.linspace(0, 2 * np.pi, len(masses.inertia) - 1, endpoint=False)
    exact = sum(
        crank_moment(kinematics.solve(design, angle - leg.lag), torque_map(no_moments), speed) for leg in TWO_LEGS
    )
    mine = (-masses.inertia_rate / 2 * speed**2 - GRAVITY * masses.height_rate)[:-1]
    assert np.abs(mine - exact).max() < 1e-9 * np.abs(exact).max()


def test_rates_of_the_table_are_derivatives(design: fes_mj.Design, no_moments: fes_mj.JointMoments) -> None:
    """Fourier derivatives of I and X; the series is as good as exact but for the sharpest linkages."""
    masses = leg_table(design, no_moments).masses
    cells = len(masses.inertia) - 1
    frequency = 1j * np.fft.fftfreq(cells, 1 / cells)
    for curve, rate in ((masses.inertia, masses.inertia_rate), (masses.recoil, masses.recoil_rate)):
        derivative = np.fft.ifft(frequency * np.fft.fft(curve[:-1])).real
        assert np.abs(derivative - rate[:-1]).max() < 1e-8 * np.abs(rate).max()


@pytest.mark.parametrize("transmission", ["fixed", "freewheel"])
def test_energy_is_conserved_where_nothing_takes_it(transmission: str, no_moments: fes_mj.JointMoments) -> None:
    """Kinetic and potential energy over a ride on a slope, both terms by the table alone."""
    design = fes_mj.load_design("d1")
    ride = Ride(design, no_moments, replace(NOTHING, slope=0.01), transmission, duration=4.0)
    trace = solved(ride)
    masses, load = ride.table.masses, ride.load
    cells = len(masses.inertia) - 1
    at = trace.crank_angle % (2 * np.pi) * cells / (2 * np.pi)
    inertia, recoil = (np.interp(at, np.arange(cells + 1), curve) for curve in (masses.inertia, masses.recoil))
    kinetic = inertia * trace.crank_speed**2 / 2 - recoil * trace.crank_speed * trace.speed
    kinetic += load.inertia * trace.speed**2 / 2
    rise = GRAVITY * (math.cos(ride.road.angle) * masses.height_rate - math.sin(ride.road.angle) * masses.recoil)
    height = np.concatenate([[0], np.cumsum((rise[1:] + rise[:-1]) / 2)]) * 2 * np.pi / cells
    energy = kinetic + np.interp(at, np.arange(cells + 1), height) + load.climb * trace.distance
    assert np.ptp(energy) < 2e-4 * kinetic[0]
    assert np.ptp(kinetic) > 0.1 * kinetic[0]


@pytest.mark.parametrize("transmission", ["fixed", "freewheel"])
@pytest.mark.parametrize(("slope", "holds"), [(0.0, True), (0.006, True), (-0.006, True), (0.02, False)])
def test_dry_friction_holds_what_it_can(
    transmission: str, slope: float, holds: bool, no_moments: fes_mj.JointMoments
) -> None:
    """A TRT whose legs weigh next to nothing stands on slopes up to the rolling resistance of 0.008, and no farther."""
    design = fes_mj.load_design("trt")
    light = design.with_rider(mass=1e-3)
    road = Road(slope=slope, tricycle_mass=90.0)
    trace = solved(Ride(light, no_moments, road, transmission, launch=0.0, duration=3.0))
    assert not trace.rides
    assert trace.stopped_at == 0
    assert (trace.distance[-1] == 0) == holds


def test_a_wheel_that_rolls_out(no_moments: fes_mj.JointMoments) -> None:
    """Coasting with weightless legs: constant deceleration by dry friction, then rest."""
    design = fes_mj.load_design("trt")
    light = design.with_rider(mass=1e-3)
    ride = Ride(light, no_moments, Road(tricycle_mass=90.0, drag_area=0.0), launch=0.5, duration=20.0)
    trace, load = solved(ride), ride.load
    assert trace.stopped_at == pytest.approx(0.5 * load.inertia / load.rolling, rel=2e-3)
    assert trace.distance[-1] == pytest.approx(0.5**2 * load.inertia / load.rolling / 2, rel=2e-3)


def test_on_and_off_the_freewheel_at_half_the_step() -> None:
    ride = Ride(fes_mj.load_design("d2"), fes_mj.load_moments("p1p2"), duration=6.0)
    trace = solved(ride)
    assert 0.3 < trace.coasting_share < 0.95
    finer = solved(ride, 2)
    assert trace.mean_speed == pytest.approx(finer.mean_speed, rel=1e-4)


DESIGNS = Path(__file__).parent / "designs"


def test_no_engagement_of_a_loose_crank_is_missed() -> None:
    """It jerks ahead within a few degrees, and drives the wheel for two milliseconds."""
    design = fes_mj.load_design(DESIGNS / "loose_crank.toml")
    ride = Ride(design, fes_mj.load_moments("p1p3"), Road(slope=0.0071), launch=0.864, start=1.204, duration=2.0)
    trace, finer = solved(ride), solved(ride, 2)
    assert np.count_nonzero(np.diff(trace.coasting)) == np.count_nonzero(np.diff(finer.coasting)) == 35
    assert speed_difference(trace, finer) < 1e-4


@pytest.mark.parametrize(
    ("margins", "part"),
    [((1.0, -0.125, 1.0), 0.5), ((3.0, -0.75, 0.0), 2 / 3), ((1.0, 0.0, 1.0), 1.0), ((1.0, 2.0, 1.0), 1.0)],
)
def test_a_margin_that_falls_below_zero_within_a_step(margins: tuple[float, float, float], part: float) -> None:
    """Of parabolas, as 9 t^2 - 12 t + 3; two of them are never below zero."""
    assert lowest(*margins) == pytest.approx(part)


@pytest.mark.parametrize(
    ("name", "group", "road", "launch", "speed"),
    [
        ("sharp", "p1p3", Road(slope=0.0133), 5.71, 5.214),
        ("short_rocker", "p1p2", Road(0.0079, 16.7, 4.4, 0.0182, 0.28), 10.4, 7.7964),
    ],
)
def test_near_a_dead_centre_it_is_as_fast_as_another_code_says(
    name: str, group: str, road: Road, launch: float, speed: float
) -> None:
    """Converged values, km/h, of a multibody model that was written without this one, in steps of 0.1 deg."""
    design = fes_mj.load_design(DESIGNS / f"{name}.toml")
    trace = solved(Ride(design, fes_mj.load_moments(group), road, "fixed", launch=launch / 3.6))
    assert trace.mean_speed is not None
    assert 3.6 * trace.mean_speed == pytest.approx(speed, rel=2e-4)


def test_the_table_is_finer_where_the_linkage_is_sharp(smooth_moments: fes_mj.JointMoments) -> None:
    """Steps end at both ends of a cell with a break, and Simpson's rule over each is as exact as promised."""
    sharp, blunt = fes_mj.load_design(DESIGNS / "sharp.toml"), fes_mj.load_design("trt")
    table = leg_table(sharp, smooth_moments)
    cells = len(table.ahead)
    assert cells > len(leg_table(blunt, smooth_moments).ahead) == DRIVE_POINTS
    inertia, rate, cell = table.masses.inertia, table.masses.inertia_rate, 2 * np.pi / cells
    row, missed = 0, 0.0
    while row < cells:
        end = min(round(table.ahead[row] / cell), cells)
        middle = np.interp((row + end) / 2, np.arange(cells + 1), rate)
        simpson = (rate[row] + 4 * middle + rate[end]) * (end - row) * cell / 6
        missed, row = missed + abs(simpson - (inertia[end] - inertia[row])), end
    assert missed < (STEP_TOLERANCE + CELL_TOLERANCE) * inertia.max()


def test_muscles_and_road_balance(smooth_moments: fes_mj.JointMoments) -> None:
    trace = solved(Ride(fes_mj.load_design("r1"), smooth_moments, transmission="fixed", duration=6.0))
    gained = trace.gained_power
    assert trace.muscle_power is not None
    assert trace.road_power is not None
    assert gained is not None
    assert trace.muscle_power == pytest.approx(trace.road_power + gained, rel=1e-3)


def test_a_turn_less_a_rounding_error_is_in_the_last_cell() -> None:
    """Where a crank that rolls back has just passed its zero."""
    row, part = place(-1e-20, DRIVE_POINTS)
    assert (row, part) == (DRIVE_POINTS - 1, pytest.approx(1.0))


def test_the_steady_ripple_is_that_of_a_long_ride(smooth_moments: fes_mj.JointMoments) -> None:
    """Closed form against integration, on a slope where the launch speed is nearly the steady one."""
    ride = Ride(fes_mj.load_design("d1"), smooth_moments, Road(drag_area=0.0), "fixed", duration=20.0)
    steady = replace(ride, road=replace(ride.road, slope=balancing_slope(ride)))
    trace = solved(steady)
    assert trace.cadence is not None
    at_its_speed = replace(steady, launch=trace.cadence * steady.travel)
    assert trace.ripple == pytest.approx(steady_ripple(at_its_speed), rel=0.01)


def test_a_power_that_would_climb_a_wall_has_no_slope(smooth_moments: fes_mj.JointMoments) -> None:
    strong = replace(smooth_moments, knee=100 * smooth_moments.knee, hip=100 * smooth_moments.hip)
    with pytest.raises(fes_mj.InputError, match=r"d1.* W at "):
        balancing_slope(Ride(fes_mj.load_design("d1"), strong))


def test_the_recoil_of_the_frame_more_than_doubles_the_ripple() -> None:
    """D1 at 90 kg, of which all ride on the road; on a frame that is held still, as its swing of energy shows."""
    design, moments = fes_mj.load_design("d1"), fes_mj.load_moments("p1p2")
    ride = Ride(design, moments, Road(tricycle_mass=15.0, rolling_mass=0.0), "fixed")
    held = HeldStill(design, moments, ride.road, "fixed")
    assert steady_ripple(ride) > 2 * steady_ripple(held)
