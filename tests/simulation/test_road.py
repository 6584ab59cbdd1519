"""The ride's model in MuJoCo: what it weighs, how it starts, and its loop in machine code."""

import mujoco
import numpy as np
import pytest

import fes_mj
from fes_mj.muscles.drive import Muscles
from fes_mj.muscles.riders import load_riders
from fes_mj.riding.ride import Ride, Road
from fes_mj.riding.stimulated import stimulated_rider
from fes_mj.simulation.road import interpreted_road_loop, ride_on_road
from fes_mj.simulation.road_mjcf import build_road_mjcf

P1P2 = fes_mj.load_moments("p1p2")


@pytest.mark.parametrize("transmission", ["fixed", "freewheel"])
def test_the_keyframe_is_assembled_at_any_start(design: fes_mj.Design, transmission: str) -> None:
    ride = Ride(design, P1P2, transmission=transmission, start=2.0)
    model = build_road_mjcf(ride).compile()
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    mujoco.mj_forward(model, data)
    gaps = [data.sensor(model.sensor(i).name).data for i in range(model.nsensor) if "_gap" in model.sensor(i).name]
    assert max(np.abs(gap).max() for gap in gaps) < 1e-12
    # three rows a loop; the one across the plane and the speeds along it must all vanish as well
    assert np.abs(data.efc_vel[: 3 * len(gaps)]).max() < 1e-9


def test_mass_and_recoil_are_those_of_the_equation_of_motion(design: fes_mj.Design) -> None:
    """Kinetic energy at the keyframe, with the frame moving and without."""
    ride = Ride(design, P1P2, start=0.7)
    model = build_road_mjcf(ride).compile()
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    masses = ride.table.masses
    turn = np.linspace(0, 2 * np.pi, len(masses.inertia))
    inertia, recoil = (np.interp(0.7, turn, curve) for curve in (masses.inertia, masses.recoil))
    crank = ride.launch / ride.travel
    for speed in (0.0, ride.launch):
        data.qvel[model.joint("road").dofadr[0]] = speed
        mujoco.mj_forward(model, data)
        mujoco.mj_energyVel(model, data)
        expected = inertia * crank**2 / 2 - recoil * crank * speed + ride.load.inertia * speed**2 / 2
        assert data.energy[1] == pytest.approx(expected, rel=1e-5)


def test_at_rest_nothing_creeps() -> None:
    """A tricycle held by dry friction on a slope, in MuJoCo's soft constraints."""
    nothing = fes_mj.JointMoments("none", np.array([0.0, 3.0]), np.zeros(2), np.zeros(2))
    ride = Ride(
        fes_mj.load_design("trt"), nothing, Road(slope=0.004, rolling_resistance=0.05), launch=0.0, duration=5.0
    )
    trace = ride_on_road(ride).trace
    assert not trace.rides
    assert abs(trace.distance).max() < 1e-6


@pytest.mark.parametrize("drive", ["moments", "muscles"])
def test_machine_code_rides_the_same_way(drive: str) -> None:
    """To the last bit."""
    pytest.importorskip("numba")
    design = fes_mj.load_design("r2")
    rider = stimulated_rider(Muscles(load_riders("p1p2").taken(slice(0, 8))), design)
    ride = Ride(design, P1P2 if drive == "moments" else rider, duration=0.5)
    fast, slow = ride_on_road(ride), ride_on_road(ride, make_loop=interpreted_road_loop)
    assert np.array_equal(slow.run.sensors, fast.run.sensors)


def test_a_ride_that_ends_while_it_rolls_back_loses_no_energy() -> None:
    """Of the 228 J that move then, of which speeds half a step behind their positions would hide 0.05 J."""
    ride = Ride(fes_mj.load_design("trt"), P1P2, Road(slope=0.15), "fixed", duration=3.0)
    run = ride_on_road(ride)
    assert run.trace.speed[-1] < -2
    assert abs(run.lost) < 1e-3
