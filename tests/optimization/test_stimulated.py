"""Muscles in a search: what it maximises and limits against single designs, by other ways."""

import numpy as np
import pytest

import fes_mj
from fes_mj.linkage.kinematics import solve
from fes_mj.linkage.variables import replaced
from fes_mj.muscles.anatomy import anatomy
from fes_mj.muscles.geometry import Flexion
from fes_mj.muscles.power import best_power
from fes_mj.muscles.riders import load_riders
from fes_mj.muscles.rules import BEST
from fes_mj.optimization.optimize import Optimum
from fes_mj.optimization.people import sampled
from fes_mj.optimization.problem import make_problem
from fes_mj.optimization.stimulated import SEARCHED, MuscleDrive
from fes_mj.statics.cycles import cycles
from fes_mj.statics.joint_forces import JointForces, peaks
from fes_mj.statics.muscle_static import MuscleStatic
from tests.optimization.conftest import TABLE

MOMENTS, DRIVE = fes_mj.load_moments("p1p2"), MuscleDrive(load_riders("p1p2"))
TRT = fes_mj.load_design("trt")


def test_few_stand_for_all() -> None:
    """On the design by which they are chosen and on another one: nearer than SEARCHED drawn at random mostly are."""
    assert len(DRIVE.few) == SEARCHED
    assert np.isin(DRIVE.few.likelihood, DRIVE.riders.likelihood).all()
    for name in ("trt", "r1"):
        design = fes_mj.load_design(name)
        every = MuscleStatic.solve(design, DRIVE.riders, design.linkage.cadence, BEST)
        assert best_power(DRIVE.few, design)[0] == pytest.approx(
            every.power_mean, abs=every.power_sd / np.sqrt(SEARCHED)
        )


def test_known_lengths_are_left_where_the_muscles_are_refused() -> None:
    reclined = replaced(TRT, {"seat_angle": np.array([[30.0], [60.0], [75.0]])})
    inside, known = DRIVE.inside(cycles(reclined, TABLE)), anatomy()
    for row in range(3):
        flexion = Flexion.along(
            solve(reclined.single(row), np.linspace(0, 2 * np.pi, 3601)),
            np.radians(DRIVE.riders["hip_offset_deg"]),
        )
        for joint, margin in inside.items():
            angle, (low, high) = np.degrees(getattr(flexion, joint)), getattr(known, f"{joint}_deg")
            assert margin[row] == pytest.approx(min(angle.min() - low, high - angle.max()), abs=0.01)


def test_a_population_has_the_power_of_its_designs_at_their_gear_ratios() -> None:
    two = DRIVE.riders.taken([3, 50])
    problem = make_problem("trt", MOMENTS, muscles=MuscleDrive(two))
    x = np.tile(problem.variables(TRT), (3, 1))
    x[:, -1] *= (1.0, 0.8, 3.0)  # the last is faster than the joints may be
    evaluation = problem.evaluate(x)
    assert evaluation.feasible.tolist() == [True, True, False]
    assert np.isnan(evaluation.power[2, 0])
    for row in range(2):
        design = problem.design(x[row], "own")
        assert evaluation.power[row, 0] == pytest.approx(best_power(two, design)[0], rel=1e-6)
    assert evaluation.power[0, 0] / evaluation.power[1, 0] < 1.2  # it grows less than the gear ratio


def test_pins_bear_the_expected_forces() -> None:
    drive = MuscleDrive(DRIVE.riders.taken([3, 50]))
    turn = MuscleStatic.solve(TRT, drive.few, TRT.linkage.cadence, BEST)
    forces = peaks(JointForces(turn).with_masses)
    assert drive.pin_force(TRT) == pytest.approx(max(forces[joint] for joint in ("pedal", "crank_centre")), rel=1e-9)


def test_a_search_for_muscles_beats_its_start() -> None:
    one = MuscleDrive(DRIVE.riders.most_probable)
    optimum = fes_mj.optimize("trt", MOMENTS, start="trt", budget=400, searches=1, muscles=one)
    assert optimum.feasible
    assert optimum.evaluations == 400
    assert optimum.power > best_power(one.riders, TRT)[0]
    with pytest.raises(fes_mj.InputError, match="caution"):
        make_problem("trt", MOMENTS, caution=1.0, muscles=one)


def test_for_people_each_has_the_power_of_muscles() -> None:
    one, people = MuscleDrive(DRIVE.riders.most_probable), sampled("population", 50, 0)
    problem = make_problem("trt", MOMENTS, muscles=one, people=people)
    optimum = Optimum(problem, "none", "own", problem.variables(TRT), 1)
    expected = [best_power(one.riders, design)[0] for design in problem.riders(optimum.x)]
    assert [rider["power_mean_W"] for rider in optimum.riders] == pytest.approx(expected, rel=1e-5)
