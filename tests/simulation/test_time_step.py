"""The step is chosen beforehand: what is predicted is what is measured, and what cannot be run is refused."""

import math

import mujoco
import numpy as np
import pytest

import fes_mj
from fes_mj.common.errors import InputError
from fes_mj.common.units import RPM
from fes_mj.crosscheck.turn_case import Case
from fes_mj.linkage.assembly import clearances
from fes_mj.simulation import time_step
from fes_mj.simulation.mjcf import ModelOptions
from fes_mj.simulation.time_step import (
    FEWEST_STEPS,
    LOOSE_STEPS,
    MOST_STEPS,
    loose_steps,
    predicted_errors,
    steps_per_turn,
)
from studies.random_linkages import random_design


def test_the_step_follows_the_sharpness_of_the_motion() -> None:
    d2 = fes_mj.load_design("d2")
    assert steps_per_turn(d2, 10 * RPM) == FEWEST_STEPS
    assert steps_per_turn(d2, 200 * RPM) > FEWEST_STEPS
    sharp = fes_mj.load_design("trt")  # the leg comes within a millimetre of stretching
    reach = sharp.rider.thigh + float(sharp.knee_to_pedal)
    far = abs(sharp.linkage.crank_centre) + sharp.linkage.crank
    stretched = sharp.with_linkage(ground=sharp.linkage.ground * (reach - 1e-3) / far)
    assert steps_per_turn(stretched, 60 * RPM) == FEWEST_STEPS
    closer = sharp.with_linkage(crank=reach - 1.1e-4 - abs(sharp.linkage.crank_centre))
    assert steps_per_turn(closer, 60 * RPM) > 2 * FEWEST_STEPS


def test_a_step_that_is_asked_for_is_a_whole_number_of_a_turn() -> None:
    assert steps_per_turn(fes_mj.load_design("d1"), 10.0, 1e-3) == round(2 * np.pi / 10 / 1e-3)


def test_what_does_not_fit_into_memory_is_refused_with_a_way_out() -> None:
    d1 = fes_mj.load_design("d1")
    most = MOST_STEPS // FEWEST_STEPS
    assert steps_per_turn(d1, 10.0, turns=most) == FEWEST_STEPS
    with pytest.raises(fes_mj.InputError, match=f"{most + 1} x 2,880 .* {most} turns"):
        steps_per_turn(d1, 10.0, turns=most + 1)
    with pytest.raises(fes_mj.InputError, match="longer time step"):
        steps_per_turn(d1, 10.0, 1e-7)


def test_what_moves_too_sharply_is_refused_before_it_runs() -> None:
    edge = random_design(np.random.default_rng(776))  # both dyads 0.2 mm from their dead centres
    assert max(clearance.margin[0] for clearance in clearances(edge)) < 2.1e-4
    with pytest.raises(fes_mj.InputError, match=r"random: .*200 rpm .*slower cadence"):
        steps_per_turn(edge, 200 * RPM)
    assert steps_per_turn(edge, 20 * RPM) < MOST_STEPS


def test_the_near_edge_of_closing_agrees() -> None:
    """A leg that comes within 0.5 mm of stretching at 150 rpm, moments that follow a thorny curve."""
    trt, angle = fes_mj.load_design("trt"), np.radians(np.arange(0, 360, 0.25))
    crank = trt.rider.thigh + float(trt.knee_to_pedal) - abs(trt.linkage.crank_centre) - 5e-4
    edge = trt.with_linkage(crank=crank)
    moments = fes_mj.JointMoments("thorny", angle, 12 * np.cos(angle) + 3 * np.sin(7 * angle), 6 * np.sin(angle))
    case = Case(edge, moments, cadence=150 * RPM)
    assert case.agrees, [check for check in case.checks if not check.ok]


@pytest.mark.parametrize("legs", [1, 2])
@pytest.mark.parametrize("name", ["r1", "d2"])
def test_the_steps_of_a_loose_crank_know_its_fastest_speed(name: str, legs: int) -> None:
    """A turn in MuJoCo, or as far as it swings, is an independent way to the fastest speed."""
    design = fes_mj.load_design(name)
    cadence, steps = design.linkage.cadence, loose_steps(design, design.linkage.cadence, legs)
    model = fes_mj.build_mjcf(design, legs=legs, options=ModelOptions(driven=False, drawn=False)).compile()
    assert model.opt.timestep == pytest.approx(2 * np.pi / cadence / steps)
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    fastest, crank = 0.0, data.joint("crank")
    while data.time < 3 and abs(crank.qpos[0]) < 2 * np.pi:
        mujoco.mj_step(model, data)
        fastest = max(fastest, abs(float(crank.qvel[0])))
    assert LOOSE_STEPS * fastest / cadence == pytest.approx(steps, rel=2e-3)


def test_without_weight_a_loose_crank_is_slower() -> None:
    design = fes_mj.load_design("trt")
    counts = [loose_steps(design, design.linkage.cadence, gravity=gravity) for gravity in (9.81, 4.9, 0.0)]
    assert counts == sorted(counts, reverse=True)
    assert counts[0] > counts[-1]


def test_a_loose_crank_near_a_dead_centre_is_refused() -> None:
    design = fes_mj.load_design("r2")
    with pytest.raises(InputError, match="loose crank"):
        loose_steps(design, design.linkage.cadence, gravity=1e9)


def test_a_glance_that_shows_no_error_decides_as_the_whole_rule_does(monkeypatch: pytest.MonkeyPatch) -> None:
    """Random linkages, and legs that come ever nearer to being stretched."""
    trt = fes_mj.load_design("trt")
    reach = trt.rider.thigh + float(trt.knee_to_pedal) - abs(trt.linkage.crank_centre)
    designs = [random_design(np.random.default_rng(seed)) for seed in range(12)]
    designs += [trt.with_linkage(crank=reach - gap) for gap in np.geomspace(1.05e-4, 3e-3, 12)]

    def steps() -> list[int]:
        time_step._needed_steps.cache_clear()
        return [steps_per_turn(design, 60 * RPM) for design in designs]

    quick = steps()
    monkeypatch.setattr(time_step, "WELL_WITHIN", -1.0)
    assert quick == steps()
    assert 4 < quick.count(FEWEST_STEPS) < 22


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
