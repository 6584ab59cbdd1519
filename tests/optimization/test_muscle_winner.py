"""What is said of a design that was found for muscles, against other commands' ways to the same."""

import numpy as np
import pytest

import fes_mj
from fes_mj.muscles.drive import Muscles
from fes_mj.muscles.power import best_turn
from fes_mj.muscles.riders import load_riders
from fes_mj.optimization.muscle_winner import MuscleWinner
from fes_mj.optimization.optimize import Optimum
from fes_mj.optimization.problem import make_problem
from fes_mj.optimization.stimulated import MuscleDrive

RIDERS = load_riders("p1p2").taken([3, 50, 120])
TRT, R1 = fes_mj.load_design("trt"), fes_mj.load_design("r1")


@pytest.fixture(scope="module")
def winner() -> MuscleWinner:
    return MuscleWinner.of(TRT, R1, MuscleDrive(RIDERS))


def test_the_most_probable_rider_is_simulated(winner: MuscleWinner) -> None:
    run = fes_mj.simulate(TRT, Muscles(RIDERS))
    likeliest = int(np.argmax(RIDERS.likelihood))
    assert winner.case.agrees
    assert winner.case.simulation.power_mean == run.power_mean
    assert run.power_mean == pytest.approx(winner.turn.powers[likeliest], rel=1e-3)


def test_the_gain_is_of_all_riders(winner: MuscleWinner) -> None:
    own, other = (best_turn(RIDERS, design)[0].power_mean[:, 0] for design in (TRT, R1))
    expected = ((own - other).mean(), (own - other).std(), np.mean(own > other))
    assert winner.gain == pytest.approx(expected, rel=1e-6)


def test_json_says_whose_power_is_whose(winner: MuscleWinner) -> None:
    problem = make_problem("trt", fes_mj.load_moments("p1p2"), muscles=MuscleDrive(RIDERS))
    said = winner.summary(Optimum(problem, "none", "own", problem.variables(TRT), 1))
    assert said["power_mean_W"] == pytest.approx(winner.turn.powers.mean())
    assert said["simulated_power_mean_W"] == pytest.approx(said["power_mode_W"], rel=1e-3)
    assert (said["agrees"], said["kind"], said["compared_with"]) == (True, "trt", "r1")
    assert abs(said["relative_difference"]) < 5e-4
