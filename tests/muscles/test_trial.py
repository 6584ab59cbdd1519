"""Muscles from a user's trial: what a rider who is known gives, and what no muscles can have given."""

from dataclasses import replace

import numpy as np
import pytest

from fes_mj.common.errors import InputError
from fes_mj.moments.files import load_moments, moments_of
from fes_mj.moments.fourier import HARMONICS
from fes_mj.moments.reference_tricycle import ReferenceTricycle
from fes_mj.muscles.identification import STRENGTHS, Candidates
from fes_mj.muscles.posterior import MEMBERS
from fes_mj.muscles.riders import Riders, load_riders
from fes_mj.muscles.trial import (
    ERROR,
    IDENTIFIED,
    LEAST_EXPLAINED,
    ORDERS,
    explained_share,
    fit_muscles,
    measured_moments,
    quantities,
)

TRIAL = load_moments("examples/trial/trial.toml")


def given_by(riders: Riders, row: int = 0, seed: int = 1):
    """The moments that one of the riders gives on the tricycle of the trial, with a residual but no other error."""
    whole = measured_moments(TRIAL, HARMONICS)
    exact = whole._replace(covariance=1e-9 * np.eye(len(whole.values)))
    there = Candidates.of(replace(riders, measured_on=TRIAL.measured_on), exact)
    values = there.simulated(row, np.random.default_rng(seed))
    return replace(moments_of(values, "made up"), covariance=TRIAL.covariance, measured_on=TRIAL.measured_on)


def test_measured_numbers_are_coefficients_of_the_trial():
    measured = measured_moments(TRIAL)
    assert len(measured.values) == 2 * (2 * ORDERS + 1)
    assert measured.weights @ np.concatenate([*TRIAL.coefficients]) == pytest.approx(measured.values)
    assert TRIAL.covariance is not None
    error = np.sqrt(np.diag(measured.covariance) - ERROR**2)
    assert error == pytest.approx(np.sqrt(measured.weights**2 @ np.diag(TRIAL.covariance)), abs=1e-6)
    assert measured.reference is TRIAL.measured_on


def test_the_rider_who_gave_the_moments_explains_them(riders):
    for row in range(3):
        assert explained_share(riders.taken([row]), given_by(riders, row)) > 0.98


def test_strengths_come_back(riders):
    """Of a rider with all else known: what muscles there are is what explains."""
    one = riders.taken([2])
    measured = measured_moments(given_by(riders, 2))
    many = replace(
        one, values={name: np.repeat(value, 400) for name, value in one.values.items()}, likelihood=np.zeros(400)
    )
    seen = Candidates.of(replace(many, measured_on=TRIAL.measured_on), measured)
    found, _ = seen.posterior(measured.values, np.random.default_rng(3).standard_normal((6, 400, 3)))
    for name in STRENGTHS:
        values = found.values[name]
        assert abs(values.mean() - one.values[name][0]) < 4 * values.std() + 0.01


def test_a_fit_knows_its_tricycle_and_explains_the_trial():
    members, share = fit_muscles(TRIAL, 300, 5)
    assert share > 0.85
    assert len(members) == MEMBERS
    assert members.measured_on is TRIAL.measured_on
    by_name = {row.name: row for row in quantities(members)}
    assert by_name["hamstrings_strength"].identified
    assert by_name["hamstrings_strength"].narrowed_to < IDENTIFIED


def test_the_tricycle_comes_back_from_the_file(riders, tmp_path):
    replace(riders, measured_on=TRIAL.measured_on).save(tmp_path / "mine.npz")
    back = load_riders(tmp_path / "mine.npz").measured_on
    assert (back.cadence, back.ranges) == (TRIAL.measured_on.cadence, TRIAL.measured_on.ranges)
    assert back.top_dead_centre == TRIAL.measured_on.top_dead_centre


def test_moments_of_no_muscle_are_refused():
    """Large moments eight times a turn, finer than windows of muscles and a smooth residual."""
    wrong = replace(TRIAL, knee=TRIAL.knee + 15 * np.sin(8 * TRIAL.crank_angle))
    with pytest.raises(InputError, match=rf"^{TRIAL.name}: .* \d+ % .* {100 * LEAST_EXPLAINED:.0f} %"):
        fit_muscles(wrong, 200, 2)


def test_signs_the_wrong_way_round_are_refused():
    with pytest.raises(InputError, match=rf"^{TRIAL.name}: [^%]*signs"):
        fit_muscles(replace(TRIAL, knee=-3 * TRIAL.knee, hip=-3 * TRIAL.hip), 200, 2)


def test_a_single_turn_is_refused():
    with pytest.raises(InputError, match=rf"^{TRIAL.name}: a single turn"):
        measured_moments(replace(TRIAL, covariance=None))


def test_joints_beyond_the_muscles_lengths_are_refused():
    design = TRIAL.measured_on.design.with_linkage(seat_angle=np.radians(10.0))
    tilted = replace(TRIAL, measured_on=ReferenceTricycle(design, TRIAL.measured_on.cadence))
    with pytest.raises(InputError, match="the hip bends from"):
        measured_moments(tilted)
