from dataclasses import replace

import numpy as np
import pytest

from fes_mj.common.errors import InputError
from fes_mj.linkage.design_file import load_design
from fes_mj.linkage.turning import turning
from fes_mj.moments.files import load_moments
from fes_mj.moments.reference_tricycle import PAPER_TRICYCLE
from fes_mj.muscles.rules import RULES, stimulated, trial_windows

TRT, D1 = load_design("trt"), load_design("d1")


def test_on_the_tricycle_of_the_measurement_all_rules_but_the_best_are_the_measurement(riders):
    cadence = PAPER_TRICYCLE.cadence
    powers = {rule: stimulated(rule, riders, TRT, cadence).power.mean(axis=1) for rule in RULES}
    scale = np.abs(powers["measured"]).max()
    # by angle, moments are read between whole degrees
    assert powers["by-angle"] == pytest.approx(powers["measured"], abs=2e-3 * scale)
    # a joint turns round between two degrees, and corners of windows are met a little better there
    assert powers["stimulation-by-angle"] == pytest.approx(powers["measured"], abs=1e-4 * scale)
    assert powers["best"].mean() > powers["measured"].mean()


@pytest.mark.parametrize("rule", RULES)
def test_fibres_do_what_joints_do(rule, riders):
    result = stimulated(rule, riders, D1, D1.linkage.cadence)
    assert result.power.shape == (len(riders), 360)
    if result.turn:
        assert result.turn.power[:, 0] == pytest.approx(result.power, rel=1e-12, abs=1e-10)
    else:
        assert rule == "by-angle"


def test_measured_windows_begin_at_the_most_bent_knee_of_each_design(riders):
    for design in (TRT, D1):
        top = np.degrees(turning(design).top_dead_centre)
        assert trial_windows(riders, design).on[0, :, 0] == pytest.approx(
            (riders.values["quadriceps_on_deg"] + top) % 360
        )


def test_joints_beyond_the_known_lengths_are_refused(riders):
    upright = D1.with_linkage(seat_angle=np.radians(90.0))
    with pytest.raises(InputError, match=r"d1: the hip bends"):
        stimulated("best", riders, upright, 8.0)


def test_rules_of_the_measurement_know_a_trials_own_tricycle(riders):
    trial = load_moments("examples/trial/trial.toml").measured_on
    own = replace(riders, measured_on=trial)
    powers = {rule: stimulated(rule, own, trial.design, trial.cadence).power.mean(axis=1) for rule in RULES[1:]}
    scale = np.abs(powers["measured"]).max()
    for rule in ("by-angle", "stimulation-by-angle"):
        assert powers[rule] == pytest.approx(powers["measured"], abs=2e-3 * scale)
    elsewhere = stimulated("by-angle", riders, trial.design, trial.cadence).power.mean(axis=1)
    assert np.abs(elsewhere - powers["measured"]).max() > 0.05 * scale
