"""The time step of a ride: second order, finer where the linkage is sharp or fast, refused with its number."""

from pathlib import Path
from types import SimpleNamespace
from typing import cast

import pytest

import fes_mj
from fes_mj.common.checks import definitions
from fes_mj.riding.differences import work_scale
from fes_mj.riding.ride import Ride, Road
from fes_mj.riding.trace import ride as solved
from fes_mj.simulation.road import RoadRun, ride_on_road
from fes_mj.simulation.road_mjcf import TIMESTEP
from fes_mj.simulation.road_step import FINER, predicted_losses, ride_timestep, tried_timestep
from fes_mj.simulation.time_step import SHARE

P1P2 = fes_mj.load_moments("p1p2")
DOWNHILL = Ride(fes_mj.load_design("d1"), P1P2, Road(slope=-0.05), duration=8.0)


def test_the_prediction_is_what_mujoco_leaves() -> None:
    """Of the gap, which does not depend on moments, within what crank speed varies in a step."""
    trace = solved(DOWNHILL)
    _, gap = predicted_losses(trace, TIMESTEP)
    assert ride_on_road(DOWNHILL, TIMESTEP).loop_gap_max == pytest.approx(gap, rel=0.2)


def test_losses_are_of_second_order() -> None:
    trace = solved(DOWNHILL)
    coarse, fine = predicted_losses(trace, TIMESTEP), predicted_losses(trace, TIMESTEP / 2)
    assert fine == pytest.approx([value / 4 for value in coarse])


def test_a_fast_crank_takes_finer_steps() -> None:
    slow = Ride(fes_mj.load_design("trt"), P1P2, Road(slope=0.0112), "fixed", duration=8.0)
    assert ride_timestep(solved(slow)) == TIMESTEP
    assert ride_timestep(solved(DOWNHILL)) < TIMESTEP


@pytest.mark.parametrize(("lost", "finer"), [(1.0, 1.0), (16.0, 2.0), (-1e9, FINER)])
def test_a_trial_that_loses_more_than_predicted_asks_for_finer_steps(lost: float, finer: float) -> None:
    """Losses in units of what is allowed at the step itself, a quarter of the trial's: of second order."""
    trace = solved(DOWNHILL)
    allowed = SHARE * definitions()["ride_energy"].limit * work_scale(trace)
    trial = SimpleNamespace(trace=trace, timestep=4e-4, lost=lost * allowed)
    assert tried_timestep(trace, cast("RoadRun", trial)) == pytest.approx(2e-4 / finer)


def test_too_many_steps_are_refused_with_their_number() -> None:
    sharp = fes_mj.load_design(Path(__file__).parents[1] / "riding" / "designs" / "sharp.toml")
    # its rocker and coupler pass 0.2 mm from being in line
    longer = sharp.linkage.crank + _clearance(sharp) - 2e-4
    ride = Ride(sharp.with_linkage(crank=longer), P1P2, Road(slope=0.01), "fixed", launch=8.0, duration=5.0)
    with pytest.raises(fes_mj.InputError, match=r"needs [\d,]+ time steps, more than 2,000,000; give a shorter dur"):
        ride_timestep(solved(ride))


def _clearance(design: fes_mj.Design) -> float:
    """Of rocker and coupler from being in line, m."""
    link = design.linkage
    reach = min(
        link.rocker + link.coupler - abs(link.pivot_to_crank),
        abs(link.pivot_to_crank) - abs(link.rocker - link.coupler),
    )
    return reach - link.crank
