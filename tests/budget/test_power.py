"""Power as a function of realisations against the solver and an integration of its own, one realisation at a time."""

from dataclasses import replace

import numpy as np
import pytest

import fes_mj
from fes_mj.budget.power import UncertainPower
from fes_mj.budget.unknowns import DIMENSIONS, EXTRAPOLATION, LAG, MOMENTS, RIDER, SPEED
from fes_mj.common.arrays import FloatArray
from fes_mj.common.errors import AssemblyError
from fes_mj.linkage.joints import JOINTS
from fes_mj.linkage.turning import turning
from fes_mj.linkage.variables import replaced
from fes_mj.moments.drive import POINTS, drive
from fes_mj.moments.files import moments_of
from fes_mj.moments.joint_moments import JointMoments
from fes_mj.moments.torque_velocity import TorqueVelocity, load_torque_velocity
from fes_mj.statics.equilibrium import crank_moment
from fes_mj.statics.turn import quasi_static

COUNT = 40
ROW = np.array([17])
COARSE = 0.06  # W, by 120 instead of 2400 crank angles: measured, 60 realisations of all designs are off by up to 0.052
COARSE_LAG = 0.5  # W, where the command that is filtered jumps between two of them: measured, up to 0.48


def uncertain(name: str, moments: JointMoments) -> UncertainPower:
    return UncertainPower(quasi_static(fes_mj.load_design(name), moments), COUNT)


@pytest.mark.parametrize("relation", [None, "hill"])
def test_nothing_drawn_is_the_mean_power(design: fes_mj.Design, moments: JointMoments, relation: str | None) -> None:
    if relation:
        moments = moments.at_speed(load_torque_velocity(relation))
    power = uncertain(design.name, moments)
    none = power.at({EXTRAPOLATION: ROW})  # within the range of the moments it changes nothing
    assert none.shape == (1, 1)
    assert none[0, 0] == pytest.approx(power.result.power_mean, abs=COARSE)


@pytest.mark.parametrize("name", ["trt", "r1", "d1", "d2"])
def test_one_realisation_of_everything_but_a_lag_is_what_the_solver_says(name: str, moments: JointMoments) -> None:
    power = uncertain(name, moments)
    drawn = power.drawn
    values = {key: float(sample[ROW[0]]) for part in (drawn.dimensions, drawn.legs) for key, sample in part.items()}
    one = drawn.relations.taken(ROW)
    relation = TorqueVelocity(
        "one",
        float(np.ravel(one.curvature)[0]),
        float(np.ravel(one.eccentric_plateau)[0]),
        {joint: float(np.ravel(speed)[0]) for joint, speed in one.max_speed.items()},
    )
    curves = replace(moments_of(drawn.coefficients[ROW[0]], "one"), torque_velocity=relation)
    solved = quasi_static(replaced(power.result.design, values), curves)
    powers = power.at(dict.fromkeys((MOMENTS, DIMENSIONS, SPEED, RIDER), ROW), [SPEED])
    assert powers[0, 0] == pytest.approx(solved.power_mean, abs=COARSE)
    free = quasi_static(solved.design, replace(curves, torque_velocity=None))
    assert powers[1, 0] == pytest.approx(free.power_mean, abs=COARSE)


def answer(command: FloatArray, lag_angle: float) -> FloatArray:
    """Periodic solution of lag_angle dm/da + m = u, u linear between uniform angles: exact step by step, ten turns."""
    step = 2 * np.pi / len(command)
    decay, response, moment = np.exp(-step / lag_angle), np.empty(len(command)), 0.0
    for _ in range(10):
        for i, here in enumerate(command):
            response[i] = moment
            slope = (command[(i + 1) % len(command)] - here) / step
            # the straight line is followed lag_angle behind
            moment = here + slope * (step - lag_angle) + (moment - here + slope * lag_angle) * decay
    return response


@pytest.mark.parametrize("name", ["r1", "d1"])
@pytest.mark.parametrize("relation", [None, "hill"])
def test_a_lag_is_the_answer_to_what_riding_commands(name: str, relation: str | None) -> None:
    """The command of moments.drive, timed ahead as theory says, integrated over crank angle at constant speed."""
    hill = load_torque_velocity(relation) if relation else None
    moments = replace(fes_mj.load_moments(), torque_velocity=hill)
    power = uncertain(name, moments)
    lag, cadence = float(power.drawn.lags[ROW[0], 0]), power.result.cadence
    driven, measured = drive(power.result.design, moments, lag), moments.measured_on.cadence
    ahead = np.atan(cadence * lag) - np.atan(measured * lag)
    angle, total = np.linspace(0, 2 * np.pi, POINTS, endpoint=False), 0.0
    for joint in JOINTS:
        command = np.interp(angle + ahead, angle, driven.command[joint], period=2 * np.pi)
        moment, rate = answer(command, cadence * lag), driven.motion.joint_rate[joint]
        if hill:
            moment = moment * hill.factor(joint, np.sign(moment) * cadence * rate)
        total += cadence * float(np.mean(moment * rate))
    assert 0.02 < lag < 0.1
    assert power.at({LAG: ROW})[0, 0] == pytest.approx(total, abs=COARSE_LAG)
    assert total < power.result.power_mean - 2 * COARSE_LAG  # it costs more than that


def test_a_lag_costs_nothing_in_the_tricycle_of_the_measurement(moments: JointMoments) -> None:
    power = uncertain("trt", moments)
    assert power.at({LAG: np.arange(COUNT)})[0] == pytest.approx(np.full(COUNT, power.result.power_mean), abs=COARSE)


def test_what_does_not_turn_has_no_power() -> None:
    """R2 is 0.6 mm from where it cannot turn; every realisation is asked the way every command asks."""
    power = UncertainPower(quasi_static(fes_mj.load_design("r2"), fes_mj.load_moments()), 1000)
    powers, failed = power.at({DIMENSIONS: np.arange(1000)})[0], []
    for row in range(1000):
        values = {name: float(column[row]) for name, column in power.drawn.dimensions.items()}
        try:
            turning(replaced(power.result.design, values))
        except AssemblyError:
            failed.append(row)
    assert 0 < len(failed) < 50
    assert np.flatnonzero(np.isnan(powers)).tolist() == failed


def test_blocks_do_not_matter(monkeypatch: pytest.MonkeyPatch) -> None:
    power, rows = uncertain("d1", fes_mj.load_moments()), dict.fromkeys((MOMENTS, RIDER, SPEED, LAG), np.arange(COUNT))
    whole = power.at(rows)
    monkeypatch.setattr("fes_mj.budget.power.BLOCK", 7)
    assert power.at(rows) == pytest.approx(whole, rel=1e-12)


@pytest.mark.parametrize("factor", [0.5, 1.0, 1.7])
def test_leg_masses_do_not_change_the_mean_power(design: fes_mj.Design, moments: JointMoments, factor: float) -> None:
    """Exactly: the inverse dynamics with masses over a turn against the statics without."""
    result = quasi_static(design.with_rider(leg_mass_factor=factor), moments)
    massive = crank_moment(result.motion, result.torque, result.cadence)
    assert np.ptp(massive - result.crank_moment) > 1  # N m: they do change the power at every instant
    assert massive.mean() == pytest.approx(result.crank_moment.mean(), abs=1e-9)
