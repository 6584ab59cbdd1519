"""Dynamic against static: the ten runs, two legs, and runs that must not agree."""

from pathlib import Path

import numpy as np
import pytest

import fes_mj
from fes_mj.crosscheck import Case
from fes_mj.errors import UnstableError
from fes_mj.simulation.stepping import FORCE_EVERY


@pytest.mark.parametrize("legs", [1, 2])
def test_the_simulation_agrees_with_its_references(
    design: fes_mj.Design, moments: fes_mj.JointMoments, legs: int
) -> None:
    """Every limit of the issue, stated here again: a limit loosened in the code must not loosen the test."""
    result = Case(design, moments, legs=legs)
    values = {check.name: check.value for check in result.checks}
    assert values["mean_power"] <= 5e-4
    assert values["loop_gap"] <= 1e-5
    assert values["cadence_ripple"] <= 1e-4
    assert values["inverse_dynamics"] <= 0.1
    assert values["massless_statics"] <= 0.1
    assert values["energy_balance"] <= 5e-4
    assert result.agrees
    assert result.simulation.power_mean == pytest.approx(result.static.power_mean, rel=5e-4)


def test_measured_turns_are_whole(smooth_moments: fes_mj.JointMoments) -> None:
    run = fes_mj.simulate(fes_mj.load_design("r1"), smooth_moments, turns=2)
    assert run.crank_angle[-1] - run.crank_angle[0] == pytest.approx(4 * np.pi, rel=1e-3)
    steps = len(run.crank_angle) // 2
    assert run.power[:steps].mean() == pytest.approx(run.power[steps:].mean(), rel=1e-6)


def test_energy_terms_come_back_after_whole_turns(design: fes_mj.Design, moments: fes_mj.JointMoments) -> None:
    energy = fes_mj.simulate(design, moments).energy
    assert abs(energy.kinetic) < 1e-3 * energy.joint_work
    assert abs(energy.potential) < 1e-3 * energy.joint_work
    assert energy.crank_work == pytest.approx(energy.joint_work, rel=1e-3)


def test_constraint_forces_are_the_reactions_of_the_massive_equilibrium(
    design: fes_mj.Design, smooth_moments: fes_mj.JointMoments
) -> None:
    """MuJoCo's constraint force at each cut joint against free-body equilibrium with d'Alembert loads.

    Without the steps at which a joint turns round: there the map jumps, and which side a step falls on is rounding.
    """
    from fes_mj.inverse_dynamics import body_loads
    from fes_mj.kinematics import solve
    from fes_mj.statics import equilibrium

    run = fes_mj.simulate(design, smooth_moments)
    motion = solve(design, run.crank_angle)
    _, reactions = equilibrium(motion, run.torque.along(motion, run.cadence), body_loads(motion, run.cadence))
    turning = np.zeros(run.crank_angle.shape, bool)
    for rate in (motion.joint_rate.knee, motion.joint_rate.hip):
        turning |= np.convolve(np.abs(np.diff(np.sign(rate), append=0)) > 0, np.ones(7), "same") > 0
    assert turning.mean() < 0.02
    for loop, force in run.loop_force.items():
        size = np.abs(reactions[loop])[::FORCE_EVERY]
        assert np.sqrt(np.mean((np.abs(force) - size)[~turning[::FORCE_EVERY]] ** 2)) < 0.01 * size.max(), loop


@pytest.mark.parametrize("rpm", [10, 40, 120, 200])
def test_the_default_step_suits_every_cadence(design: fes_mj.Design, rpm: float) -> None:
    result = Case(design, fes_mj.load_moments("p1p2"), cadence=rpm * np.pi / 30)
    assert result.agrees, [check for check in result.checks if not check.ok]


@pytest.mark.parametrize("knee", [[0.0, 0.0, 0.0, 0.0], [1.0, 0.0, 1.0, 0.0]])
def test_moments_that_deliver_next_to_nothing_agree_too(design: fes_mj.Design, knee: list[float]) -> None:
    quarters = np.radians([0.0, 90.0, 180.0, 270.0])
    moments = fes_mj.JointMoments("idle", quarters, np.array(knee), np.zeros(4))
    result = Case(design, moments)
    assert abs(result.simulation.power_mean - result.static.power_mean) <= 5e-3  # W
    assert result.agrees


def test_a_slack_servo_is_noticed(monkeypatch: pytest.MonkeyPatch, smooth_moments: fes_mj.JointMoments) -> None:
    monkeypatch.setattr("fes_mj.simulation.mjcf.SERVO_GAIN", 20.0)
    result = Case(fes_mj.load_design("d1"), smooth_moments)
    assert not result.agrees
    assert "cadence_ripple" in [check.name for check in result.checks if not check.ok]


def test_soft_loops_are_noticed(monkeypatch: pytest.MonkeyPatch, smooth_moments: fes_mj.JointMoments) -> None:
    monkeypatch.setattr("fes_mj.simulation.mjcf.LOOP_SOLREF", (0.02, 1.0))
    result = Case(fes_mj.load_design("d1"), smooth_moments)
    assert {"mean_power", "loop_gap"} <= {check.name for check in result.checks if not check.ok}


def test_a_run_that_breaks_down_says_so(
    smooth_moments: fes_mj.JointMoments, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    huge = fes_mj.JointMoments("huge", smooth_moments.crank_angle, 1e13 * smooth_moments.knee, smooth_moments.hip)
    with pytest.raises(UnstableError, match=r"d1: the simulation became unstable with a time step of 0\.216 ms"):
        fes_mj.simulate(fes_mj.load_design("d1"), huge)
    assert not list(tmp_path.iterdir())  # MuJoCo's own log stays out of the user's folder
